#include "marey/pipeline/camera_blobs.h"

#include <cmath>
#include <mutex>

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include "marey/core/error.h"
#include "marey/format/observations.h"
#include "marey/format/rig_sources.h"
#include "marey/source/open_source.h"

namespace marey {
namespace {

/// The camera's part of a frame.
Frame cut_out(const Frame& frame, const std::optional<cv::Rect>& region) {
  if (!region) return frame;
  Frame part = frame;
  part.picture = Picture(frame.picture.luma()(*region));
  return part;
}

void settle_size(RigCamera& camera, cv::Size picture) {
  if (camera.region && (*camera.region & cv::Rect({}, picture)) != *camera.region) {
    throw Error("camera \"{}\": its region {}x{} at ({}, {}) is not within the pictures of {}x{} px of {}", camera.name,
                camera.region->width, camera.region->height, camera.region->x, camera.region->y, picture.width, picture.height,
                camera.source);
  }
  fit_to_size(camera, camera.region ? camera.region->size() : picture);
}

/// Container times are rounded; frames come at a steady rate.
double steady_time(const Frame& frame, const SourceInfo& info) {
  const double time = seconds(frame.time);
  if (!info.rate_hz) return time;
  const double steady = std::round(time * *info.rate_hz) / *info.rate_hz;
  return std::abs(steady - time) * *info.rate_hz < 0.25 ? steady : time;
}

std::vector<BlobFrame> blobs_of(RigCamera& camera, const MarkerOptions& options, const std::function<void()>& frame_done,
                                std::vector<std::string>& warnings) {
  if (camera.source.empty()) {
    throw Error("camera \"{}\" has no source: give {}=VIDEO, or --observations", camera.name, camera.name);
  }
  const auto source = open_source(camera.source, camera.rate_hz);
  settle_size(camera, source->info().size);
  MarkerDetector detector(options);
  std::vector<BlobFrame> frames;
  while (const auto frame = source->next()) {
    BlobFrame blobs{steady_time(*frame, source->info()), {}};
    for (const Detection& detection : detector.detect(cut_out(*frame, camera.region), {}).detections) {
      blobs.blobs.push_back(detection.centre);
    }
    frames.push_back(std::move(blobs));
    frame_done();
  }
  for (const std::string& sentence : source->warnings()) warnings.push_back(fmt::format("{}: {}", camera.name, sentence));
  for (const std::string& sentence : marey::warnings(detector.counts()))
    warnings.push_back(fmt::format("{}: {}", camera.name, sentence));
  return frames;
}

}  // namespace

CameraBlobs read_blobs(const std::string& observations, const Rig& rig) {
  CameraBlobs blobs;
  blobs.seen.resize(rig.cameras.size());
  std::optional<double> any_rate;
  for (const RigCamera& camera : rig.cameras) {
    if (!any_rate) any_rate = camera.rate_hz;
  }
  blobs.timed = any_rate.has_value();
  for (const SeenFrame& frame : read_observations(observations, rig)) {
    for (const SeenPoint& point : frame.points) {
      const auto c = static_cast<std::size_t>(point.camera);
      const double time = static_cast<double>(frame.frame) / rig.cameras[c].rate_hz.value_or(any_rate.value_or(1));
      auto& frames = blobs.seen[c];
      if (frames.empty() || frames.back().time_s != time) frames.push_back({time, {}});
      frames.back().blobs.push_back(point.pixel);
    }
  }
  return blobs;
}

CameraBlobs find_blobs(Rig& rig, const MarkerOptions& options, const BlobProgress& progress) {
  CameraBlobs blobs;
  blobs.seen.resize(rig.cameras.size());
  std::vector<std::vector<std::string>> warnings(rig.cameras.size());
  std::mutex telling;
  std::int64_t done = 0;
  const auto frame_done = [&] {
    const std::lock_guard lock(telling);
    ++done;
    if (progress) progress(done);
  };
  tbb::parallel_for(std::size_t{0}, rig.cameras.size(),
                    [&](std::size_t c) { blobs.seen[c] = blobs_of(rig.cameras[c], options, frame_done, warnings[c]); });
  for (const auto& own : warnings) blobs.warnings.insert(blobs.warnings.end(), own.begin(), own.end());
  return blobs;
}

}  // namespace marey
