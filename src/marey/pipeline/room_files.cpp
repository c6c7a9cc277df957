#include "marey/pipeline/room_files.h"

#include <algorithm>
#include <filesystem>
#include <memory>
#include <vector>

#include <fmt/format.h>

#include "marey/draw/canvas.h"
#include "marey/draw/movie_writer.h"
#include "marey/format/observations.h"
#include "marey/format/rig/rig_file.h"
#include "marey/format/whole_file.h"
#include "marey/simulate/markers/discs.h"

namespace marey::pipeline {
namespace {

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

void append_truth(std::string& text, const simulate::room::RoomScene& scene, const simulate::room::RoomFrame& frame) {
  std::vector<int> cameras(frame.points.size(), 0);
  for (int camera = 0; camera < scene.options().cameras; ++camera) {
    const std::vector<bool> visible = scene.visible(camera, frame.time_s, frame.points);
    for (std::size_t i = 0; i < visible.size(); ++i) cameras[i] += visible[i] ? 1 : 0;
  }
  for (std::size_t i = 0; i < frame.points.size(); ++i) {
    const Vector<3>& p = frame.points[i];
    fmt::format_to(std::back_inserter(text), "{},{:.6f},{},{:.6f},{:.6f},{:.6f},{}\n", frame.index, frame.time_s, scene.labels()[i],
                   p.x(), p.y(), p.z(), cameras[i]);
  }
}

/// One film a camera. Blobs are drawn at their exact places: the pixels bring the noise.
class Films {
 public:
  Films(const simulate::room::RoomScene& scene, const std::filesystem::path& folder, const RoomFilesOptions& options)
      : scene_(exact(scene.options())), options_(options) {
    for (const RigCamera& camera : scene_.rig().cameras) {
      movies_.push_back(std::make_unique<draw::MovieWriter>((folder / (camera.name + ".mp4")).string(), *camera.size,
                                                            scene_.options().rate_hz, draw::MovieWriter::Quality::to_measure));
    }
  }

  void write(std::int64_t index) {
    const simulate::room::RoomFrame frame = scene_.frame(index);
    for (std::size_t camera = 0; camera < movies_.size(); ++camera) {
      movies_[camera]->write(draw::Canvas(Picture(render(frame, camera))).take(), timestamp_from_seconds(frame.time_s));
    }
  }

  void finish() {
    for (const auto& movie : movies_) movie->finish();
  }

 private:
  static simulate::room::RoomOptions exact(simulate::room::RoomOptions options) {
    options.noise_px = 0;
    options.merge_px = 0;  // discs that touch are one by themselves
    return options;
  }

  cv::Mat render(const simulate::room::RoomFrame& frame, std::size_t camera) const {
    constexpr float kGround = 22;  // grey level
    const RigCamera& eye = scene_.rig_at(frame.time_s).cameras[camera];
    const Vector<3> centre = eye.camera()->centre();
    std::vector<simulate::markers::Disc> discs;
    for (const simulate::room::RoomBlob& blob : frame.seen[camera]) {
      const double away = blob.marker ? (frame.points[static_cast<std::size_t>(*blob.marker)] - centre).norm() : 4.0;
      discs.push_back({blob.pixel, std::max(0.6, options_.marker_radius * geometry::focal_of(*eye.lens).x() / away)});
    }
    cv::Mat image(*eye.size, CV_32FC1, cv::Scalar(kGround));
    simulate::markers::draw_discs(image, discs);
    const auto seed = scene_.options().seed * 1000003u + static_cast<std::uint64_t>(frame.index) * 64 + camera;
    return simulate::markers::expose(image, options_.picture_noise, seed);
  }

  simulate::room::RoomScene scene_;
  RoomFilesOptions options_;
  std::vector<std::unique_ptr<draw::MovieWriter>> movies_;
};

Rig with_sources(Rig rig, bool videos) {
  for (RigCamera& camera : rig.cameras) camera.source = videos ? camera.name + ".mp4" : "";
  return rig;
}

void write_labels(const simulate::room::RoomScene& scene, const std::filesystem::path& folder) {
  format::WholeFile file((folder / "labels.csv").string());
  file.write("label,x,y,z\n");
  const std::vector<Vector<3>> points = scene.points(0);
  for (std::size_t i = 0; i < points.size(); ++i) {
    file.write(fmt::format("{},{:.6f},{:.6f},{:.6f}\n", scene.labels()[i], points[i].x(), points[i].y(), points[i].z()));
  }
  file.finish();
}

void write_rigs(const simulate::room::RoomScene& scene, const std::filesystem::path& folder, bool videos) {
  const auto write = [&](const Rig& rig, const char* name) {
    format::WholeFile file((folder / name).string());
    file.write(format::rig::rig_text(rig));
    file.finish();
  };
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

void write_room(const simulate::room::RoomScene& scene, const std::string& folder, const RoomFilesOptions& options,
                const std::function<void(std::int64_t, std::int64_t)>& progress) {
  const std::filesystem::path place = folder;
  write_rigs(scene, place, options.videos);
  write_labels(scene, place);
  format::ObservationWriter observations((place / "observations.csv").string(), scene.rig(), false);
  format::ObservationWriter blobs((place / "blobs.csv").string(), scene.rig(), true);
  format::WholeFile truth((place / "truth.csv").string());
  truth.write("frame,time,label,x,y,z,cameras\n");
  std::optional<Films> films;
  if (options.videos) films.emplace(scene, place, options);
  std::string text;
  for (std::int64_t i = 0; i < scene.options().frames; ++i) {
    const simulate::room::RoomFrame frame = scene.frame(i);
    const format::SeenFrame seen = seen_of(frame, scene.labels());
    observations.write(seen);
    blobs.write(seen);
    text.clear();
    append_truth(text, scene, frame);
    truth.write(text);
    if (films) films->write(i);
    if (progress) progress(i + 1, scene.options().frames);
  }
  observations.finish();
  blobs.finish();
  truth.finish();
  if (films) films->finish();
}

}  // namespace marey::pipeline
