// Simulations as files: what a scene of `simulate` shows goes through the writers of films, observations, tracks and rigs. Nothing
// is simulated here.
#include "marey/pipeline/simulation_files.h"

#include <cmath>
#include <filesystem>
#include <iterator>
#include <memory>
#include <optional>
#include <vector>

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include "marey/core/error.h"
#include "marey/core/whole_file.h"
#include "marey/draw/canvas.h"
#include "marey/draw/movie_writer.h"
#include "marey/format/observations.h"
#include "marey/format/rig/rig_file.h"
#include "marey/format/skeleton/skeleton_file.h"

namespace marey::pipeline {
namespace {

namespace fs = std::filesystem;

void write_text(const fs::path& path, std::string_view text) {
  WholeFile file(path.string());
  file.write(text);
  file.finish();
}

/// A source's frames as a film.
class Film {
 public:
  Film(std::unique_ptr<Source> source, const fs::path& path)
      : source_(std::move(source)),
        movie_(path.string(), source_->info().size, source_->info().rate_hz, draw::MovieWriter::Quality::to_measure) {}

  /// False at the end.
  bool write_next() {
    const auto frame = source_->next();
    if (frame) movie_.write(draw::Canvas(frame->picture).take(), frame->time);
    return frame.has_value();
  }
  void finish() { movie_.finish(); }

 private:
  std::unique_ptr<Source> source_;
  draw::MovieWriter movie_;
};

/// COCO's uncompressed run lengths of a mask: columns from the left, each from the top; background first, foreground next, and so
/// on.
std::string run_lengths(const cv::Mat& mask) {
  std::string text = "[";
  bool inside = false;
  int length = 0;
  const auto end_run = [&] {
    fmt::format_to(std::back_inserter(text), "{}{}", text.size() > 1 ? "," : "", length);
    length = 0;
    inside = !inside;
  };
  for (int x = 0; x < mask.cols; ++x) {
    for (int y = 0; y < mask.rows; ++y) {
      if ((mask.at<unsigned char>(y, x) != 0) != inside) end_run();
      ++length;
    }
  }
  end_run();
  return text + "]";
}

/// World: as the film's (simulate/ground_picture.h), whose ground is at z = 0.
Rig people_rig(const simulate::people::PeopleFilm& film) {
  const simulate::LevelCamera& level = film.camera();
  const double c = std::cos(level.pitch), s = std::sin(level.pitch);
  geometry::BrownLens lens;
  lens.focal.setConstant(level.focal);
  lens.principal = {(level.size.width - 1) / 2.0, (level.size.height - 1) / 2.0};
  Rigid3 pose;
  pose.rotation << 1, 0, 0, 0, -s, -c, 0, c, -s;
  pose.translation = {0, 0, level.distance};
  Rig rig;
  RigCamera& camera = rig.cameras.emplace_back();
  camera.name = "camera";
  camera.source = "video.mp4";
  camera.size = level.size;
  camera.lens = lens;
  camera.camera_from_world = pose;
  rig.calibration = Rig::Calibration{
      .method = "simulated: the exact truth", .mean_px = {}, .rms_px = {}, .inliers = {}, .observations = {}, .grade = {}};
  return rig;
}

class PeopleTruth {
 public:
  explicit PeopleTruth(const fs::path& folder)
      : boxes_((folder / "truth.txt").string()),
        positions_((folder / "positions.csv").string()),
        silhouettes_((folder / "silhouettes.jsonl").string()) {
    positions_.write("frame,time,id,team,x,y,foot_x,foot_y,visible\n");
  }

  void write(int frame, double time, const simulate::people::TrueFigure& person, cv::Size size) {
    const Box picture{0, 0, static_cast<double>(size.width), static_cast<double>(size.height)};
    const Box box = geometry::intersection(person.whole.box(), picture);
    if (box.empty()) return;
    boxes_.write(fmt::format("{},{},{:.2f},{:.2f},{:.2f},{:.2f},1,1,{:.3f}\n", frame + 1, person.id, box.left + 1, box.top + 1,
                             box.width, box.height, person.visible_share));
    positions_.write(fmt::format("{},{:.6f},{},{},{:.4f},{:.4f},{:.3f},{:.3f},{:.3f}\n", frame, time, person.id, person.team,
                                 person.ground.x(), person.ground.y(), person.foot.x(), person.foot.y(), person.visible_share));
    silhouettes_.write(fmt::format(R"({{"frame":{},"id":{},"size":[{},{}],"whole":{},"visible":{}}})", frame, person.id,
                                   size.height, size.width, run_lengths(person.whole.pixel_mask(size)),
                                   run_lengths(person.visible.pixel_mask(size))) +
                       "\n");
  }

  void finish() {
    boxes_.finish();
    positions_.finish();
    silhouettes_.finish();
  }

 private:
  WholeFile boxes_, positions_, silhouettes_;
};

format::SeenFrame seen_of(const simulate::room::RoomFrame& frame, const std::vector<std::string>& labels) {
  format::SeenFrame seen;
  seen.frame = frame.index;
  for (int camera = 0; camera < std::ssize(frame.seen); ++camera) {
    for (const simulate::room::RoomBlob& blob : frame.seen[static_cast<std::size_t>(camera)]) {
      seen.points.push_back({CameraId{camera}, blob.pixel, blob.marker ? labels[static_cast<std::size_t>(*blob.marker)] : ""});
    }
  }
  return seen;
}

std::string truth_rows(const simulate::room::RoomScene& scene, const simulate::room::RoomFrame& frame) {
  const std::vector<int> cameras = simulate::room::cameras_that_see(scene, frame);
  std::string text;
  for (std::size_t i = 0; i < frame.points.size(); ++i) {
    const Vector<3>& p = frame.points[i];
    fmt::format_to(std::back_inserter(text), "{},{:.6f},{},{:.6f},{:.6f},{:.6f},{}\n", frame.index, frame.time_s, scene.labels()[i],
                   p.x(), p.y(), p.z(), cameras[i]);
  }
  return text;
}

Rig with_sources(Rig rig, bool videos) {
  for (RigCamera& camera : rig.cameras) camera.source = videos ? camera.name + ".mp4" : "";
  return rig;
}

void write_labels(const simulate::room::RoomScene& scene, const fs::path& folder) {
  std::string text = "label,x,y,z\n";
  const std::vector<Vector<3>> points = scene.points(0);
  for (std::size_t i = 0; i < points.size(); ++i) {
    fmt::format_to(std::back_inserter(text), "{},{:.6f},{:.6f},{:.6f}\n", scene.labels()[i], points[i].x(), points[i].y(),
                   points[i].z());
  }
  write_text(folder / "labels.csv", text);
}

void write_room_rigs(const simulate::room::RoomScene& scene, const fs::path& folder, bool videos) {
  const auto write = [&](const Rig& rig, const char* name) { write_text(folder / name, format::rig::rig_text(rig)); };
  Rig truth = with_sources(scene.rig(), videos);
  truth.calibration = Rig::Calibration{
      .method = "simulated: the exact truth", .mean_px = {}, .rms_px = {}, .inliers = {}, .observations = {}, .grade = {}};
  write(truth, "rig.toml");
  if (const auto& bump = scene.options().bump) write(with_sources(scene.rig_at(bump->time_s), videos), "rig_after.toml");
  Rig start = with_sources(scene.rig(), videos);
  for (RigCamera& camera : start.cameras) {
    camera.camera_from_world.reset();
    camera.offset_s = 0;
  }
  write(start, "start.toml");
}

}  // namespace

void film_markers(const simulate::markers::MarkerScene& scene, const std::string& path, const Hooks& hooks) {
  Film film(simulate::markers::make_source(scene), path);
  for (std::int64_t done = 1; film.write_next(); ++done) hooks.advance({"frames", done, std::ssize(scene.frames)});
  film.finish();
}

void write_markers(const simulate::markers::MarkerScene& scene, const std::string& folder, const Hooks& hooks) {
  WholeFile truth((fs::path(folder) / "truth.csv").string());
  truth.write("frame,time,label,x,y,visible\n");
  for (std::size_t i = 0; i < scene.frames.size(); ++i) {
    for (const simulate::markers::MarkerTruth& marker : scene.frames[i]) {
      truth.write(fmt::format("{},{:.6f},M{},{:.4f},{:.4f},{}\n", i, static_cast<double>(i) / scene.options.rate_hz,
                              marker.marker + 1, marker.position.x(), marker.position.y(), marker.visible ? 1 : 0));
    }
  }
  film_markers(scene, (fs::path(folder) / "video.mp4").string(), hooks);
  truth.finish();
}

void film_people(const simulate::people::PeopleFilm& film, const std::string& folder, const Hooks& hooks) {
  const fs::path place = folder;
  const simulate::people::PeopleFilmOptions& options = film.options();
  draw::MovieWriter movie((place / "video.mp4").string(), options.size, options.rate_hz, draw::MovieWriter::Quality::to_measure);
  PeopleTruth truth(place);
  for (int i = 0; i < film.frames(); ++i) {
    const double time = i / options.rate_hz;
    const simulate::people::RenderedFrame frame = film.render(i);
    movie.write(frame.picture, timestamp_from_seconds(time));
    for (const simulate::people::TrueFigure& person : frame.people) truth.write(i, time, person, options.size);
    hooks.advance({"frames", i + 1, film.frames()});
  }
  movie.finish();
  truth.finish();
  write_text(place / "rig.toml", format::rig::rig_text(people_rig(film)));
}

void write_room(const simulate::room::RoomScene& scene, const std::string& folder, const RoomFilesOptions& options,
                const Hooks& hooks) {
  const fs::path place = folder;
  format::ObservationWriter observations((place / "observations.csv").string(), scene.rig(), false);
  format::ObservationWriter blobs((place / "blobs.csv").string(), scene.rig(), true);
  WholeFile truth((place / "truth.csv").string());
  truth.write("frame,time,label,x,y,z,cameras\n");
  std::vector<std::unique_ptr<Film>> films;
  for (std::size_t i = 0; options.videos && i < scene.rig().cameras.size(); ++i) {
    films.push_back(std::make_unique<Film>(simulate::room::film_room(scene.options(), i, options.film),
                                           place / (scene.rig().cameras[i].name + ".mp4")));
  }
  for (std::int64_t i = 0; i < scene.options().frames; ++i) {
    const simulate::room::RoomFrame frame = scene.frame(i);
    const format::SeenFrame seen = seen_of(frame, scene.labels());
    observations.write(seen);
    blobs.write(seen);
    truth.write(truth_rows(scene, frame));
    tbb::parallel_for(std::size_t{0}, films.size(), [&](std::size_t camera) { films[camera]->write_next(); });
    hooks.advance({"frames", i + 1, scene.options().frames});
  }
  observations.finish();
  blobs.finish();
  truth.finish();
  for (const auto& film : films) film->finish();
  write_room_rigs(scene, place, options.videos);
  write_labels(scene, place);
  if (const auto skeleton = scene.skeleton()) write_text(place / "skeleton.toml", format::skeleton::to_toml(*skeleton));
}

}  // namespace marey::pipeline
