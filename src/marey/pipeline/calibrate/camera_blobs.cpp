#include "marey/pipeline/calibrate/camera_blobs.h"

#include <functional>
#include <mutex>
#include <optional>

#include <tbb/parallel_for.h>

#include "marey/core/error.h"
#include "marey/format/observations.h"
#include "marey/pipeline/calibrate/live_blobs.h"
#include "marey/pipeline/corridor/feed.h"

namespace marey::pipeline::calibrate {
namespace {

std::vector<marey::calibrate::wand::BlobFrame> all_of(corridor::Feed& feed, double offset_s,
                                                      const std::function<void()>& frame_done) {
  std::vector<marey::calibrate::wand::BlobFrame> frames;
  while (const auto detected = feed.next()) {
    marey::calibrate::wand::BlobFrame& blobs =
        frames.emplace_back(marey::calibrate::wand::BlobFrame{seconds(detected->frame.time) - offset_s, {}});
    for (const Detection& blob : *detected->detections) blobs.blobs.push_back(blob.centre);
    frame_done();
  }
  return frames;
}

}  // namespace

CameraBlobs read_blobs(const std::string& observations, const Rig& rig) {
  CameraBlobs blobs;
  blobs.detected.resize(rig.cameras.size());
  std::optional<double> any_rate;
  for (const RigCamera& camera : rig.cameras) {
    if (!any_rate) any_rate = camera.rate_hz;
  }
  blobs.timed = any_rate.has_value();
  for (const format::ObservedFrame& frame : format::read_observations(observations, rig)) {
    for (const format::ImageObservation& point : frame.points) {
      const auto c = static_cast<std::size_t>(point.camera);
      const RigCamera& camera = rig.cameras[c];
      const double time = frame.time ? seconds(*frame.time) - camera.offset_s.value_or(0)
                                     : static_cast<double>(frame.frame) / camera.rate_hz.value_or(any_rate.value_or(1));
      blobs.timed |= frame.time.has_value();
      auto& frames = blobs.detected[c];
      if (frames.empty() || frames.back().time_s != time) frames.push_back({time, {}});
      frames.back().blobs.push_back(point.pixel);
    }
  }
  return blobs;
}

CameraBlobs find_blobs(Rig& rig, const detect::markers::MarkerOptions& options, const Hooks& hooks) {
  for (const RigCamera& camera : rig.cameras) {
    if (camera.source.empty())
      throw Error("camera \"{}\" has no source: give {}=VIDEO, or --observations", camera.name, camera.name);
  }
  if (has_live_cameras(rig)) return observe_live_blobs(rig, {.markers = options}, hooks);
  auto feeds = corridor::open_feeds(rig, {.steady_times = true, .ahead = 4});
  for (std::size_t c = 0; c < feeds.size(); ++c) {
    feeds[c].find(std::make_unique<detect::markers::MarkerDetector>(corridor::markers_of(feeds[c].camera(), options)));
    rig.cameras[c] = feeds[c].camera();
  }
  CameraBlobs blobs;
  blobs.detected.resize(feeds.size());
  std::mutex reporting;
  std::int64_t done = 0;
  const auto frame_done = [&] {
    const std::lock_guard lock(reporting);
    hooks.advance({"searching for markers", ++done, std::nullopt});
  };
  tbb::parallel_for(std::size_t{0}, feeds.size(),
                    [&](std::size_t c) { blobs.detected[c] = all_of(feeds[c], rig.cameras[c].offset_s.value_or(0), frame_done); });
  if (hooks.stop.stop_requested()) throw Stopped();
  for (std::size_t c = 0; c < feeds.size(); ++c) {
    for (std::string& message_text : feeds[c].warnings()) blobs.warnings.push_back(std::move(message_text));
  }
  return blobs;
}

CameraBlobs blobs_of(Rig& rig, const std::string& observations, const detect::markers::MarkerOptions& options, const Hooks& hooks) {
  return observations.empty() ? find_blobs(rig, options, hooks) : read_blobs(observations, rig);
}

}  // namespace marey::pipeline::calibrate
