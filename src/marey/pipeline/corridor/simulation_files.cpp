// Simulations as files: what a scene of `simulate` shows goes through the writers of videos, observations, tracks and rigs. Nothing
// is simulated here.
#include "marey/pipeline/corridor/simulation_files.h"

#include <cmath>
#include <filesystem>
#include <iterator>
#include <memory>
#include <optional>
#include <vector>

#include <fmt/format.h>

#include "marey/core/error.h"
#include "marey/draw/canvas.h"
#include "marey/draw/movie_writer.h"
#include "marey/files/whole_file.h"
#include "marey/format/rig/rig_file.h"
#include "marey/pipeline/corridor/video_file.h"

namespace marey::pipeline::corridor {
namespace {

namespace fs = std::filesystem;

void write_text(const fs::path& path, std::string_view text) {
  WholeFile file(path.string());
  file.write(text);
  file.finish();
}

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

/// World: as the video's (simulate/background_image.h), whose ground is at z = 0.
Rig people_rig(const marey::simulate::people::PeopleVideo& video) {
  const marey::simulate::LevelCamera& level = video.camera();
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

  void write(int frame, double time, const marey::simulate::people::TrueFigure& person, cv::Size size) {
    const Box image{0, 0, static_cast<double>(size.width), static_cast<double>(size.height)};
    const Box box = geometry::intersection(person.whole.box(), image);
    if (box.empty()) return;
    boxes_.write(fmt::format("{},{},{:.2f},{:.2f},{:.2f},{:.2f},1,1,{:.3f}\n", frame + 1, person.id, box.left + 1, box.top + 1,
                             box.width, box.height, person.visible_fraction));
    positions_.write(fmt::format("{},{:.6f},{},{},{:.4f},{:.4f},{:.3f},{:.3f},{:.3f}\n", frame, time, person.id, person.team,
                                 person.ground.x(), person.ground.y(), person.foot.x(), person.foot.y(), person.visible_fraction));
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

}  // namespace

void video_markers(const marey::simulate::markers::MarkerScene& scene, const std::string& path, const Hooks& hooks) {
  VideoFile video(marey::simulate::markers::make_source(scene), path);
  for (std::int64_t done = 1; video.write_next(); ++done) hooks.advance({"frames", done, std::ssize(scene.frames)});
  video.finish();
}

void write_markers(const marey::simulate::markers::MarkerScene& scene, const std::string& folder, const Hooks& hooks) {
  WholeFile truth((fs::path(folder) / "truth.csv").string());
  truth.write("frame,time,label,x,y,visible\n");
  for (std::size_t i = 0; i < scene.frames.size(); ++i) {
    for (const marey::simulate::markers::MarkerTruth& marker : scene.frames[i]) {
      truth.write(fmt::format("{},{:.6f},M{},{:.4f},{:.4f},{}\n", i, static_cast<double>(i) / scene.options.rate_hz,
                              marker.marker + 1, marker.position.x(), marker.position.y(), marker.visible ? 1 : 0));
    }
  }
  video_markers(scene, (fs::path(folder) / "video.mp4").string(), hooks);
  truth.finish();
}

void video_people(const marey::simulate::people::PeopleVideo& video, const std::string& folder, const Hooks& hooks) {
  const fs::path location = folder;
  const marey::simulate::people::PeopleVideoOptions& options = video.options();
  draw::MovieWriter movie((location / "video.mp4").string(), options.size, options.rate_hz, draw::MovieWriter::Quality::to_measure);
  PeopleTruth truth(location);
  for (int i = 0; i < video.frames(); ++i) {
    const double time = i / options.rate_hz;
    const marey::simulate::people::RenderedFrame frame = video.render(i);
    movie.write(frame.image, timestamp_from_seconds(time));
    for (const marey::simulate::people::TrueFigure& person : frame.people) truth.write(i, time, person, options.size);
    hooks.advance({"frames", i + 1, video.frames()});
  }
  movie.finish();
  truth.finish();
  write_text(location / "rig.toml", format::rig::rig_text(people_rig(video)));
}

}  // namespace marey::pipeline::corridor
