#include "marey/pipeline/calibrate/calibrate_wand.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "marey/calibrate/wand/wand_coverage.h"
#include "marey/pipeline/calibrate/camera_blobs.h"
#include "marey/pipeline/calibrate/live_blobs.h"

namespace marey::pipeline::calibrate {

bool knows_lenses(const Rig& rig) {
  return std::all_of(rig.cameras.begin(), rig.cameras.end(), [](const RigCamera& camera) { return camera.lens.has_value(); });
}

namespace {

constexpr double kCountEvery = 2;  // s of waving that are searched at a time

/// Counts what cameras see of the wand while it is waved.
class WavedWand {
 public:
  WavedWand(const CalibrateWandOptions& options, const Rig& rig)
      : options_(options), coverage_(options.wand, rig.cameras.size(), knows_lenses(rig)), counted_(rig.cameras.size()) {}

  /// Whether that will do.
  bool inspect(const BlobPreview& now) {
    if (now.seconds - counted_s_ >= kCountEvery) {
      counted_s_ = now.seconds;
      count(now.blobs, now.feeds);
    }
    detected_ = observed_so_far(coverage_.images(), now.feeds, now.policy);
    detected_.seconds = now.seconds;
    detected_.now = observed_now(now);
    const bool go_on = !options_.waving || options_.waving(detected_);
    return detected_.enough || !go_on;
  }

  std::vector<std::string> warnings() const {
    std::vector<std::string> sentences;
    for (const LiveObserved::Camera& camera : detected_.cameras) {
      if (!camera.covered)
        sentences.push_back(fmt::format("camera \"{}\" saw the wand in {:.0f} % of its image; {:.0f} % are wanted",
                                        camera.health.name, 100 * camera.coverage, 100 * coverage_.images().criteria().fraction));
    }
    return sentences;
  }

 private:
  Instant observed_now(const BlobPreview& now) {
    Instant instant;
    instant.index = appearances_++;
    instant.time = timestamp_from_seconds(now.seconds);
    for (std::size_t c = 0; c < now.newest.size(); ++c) {
      const CameraFrame& given = now.newest[c];
      if (!given.detections) continue;
      const CameraId camera{static_cast<int>(c)};
      if (!given.frame.image.empty()) instant.frames.push_back(given.frame);
      marey::calibrate::wand::BlobFrame frame;
      for (const Detection& blob : *given.detections) frame.blobs.push_back(blob.centre);
      const auto found =
          marey::calibrate::wand::find_marks({&frame, 1}, options_.wand, now.feeds[c].camera().lens, now.feeds[c].info().size);
      for (const Vector<2>& blob : frame.blobs) {
        ImageObservation& detected = instant.detected.emplace_back();
        detected.camera = camera;
        detected.pixel = blob;
        for (std::size_t m = 0; !found.empty() && m < options_.wand.markers(); ++m) {
          if (found.front().marks[m] == blob) detected.track = TrackId{static_cast<int>(m) + 1};
        }
      }
    }
    return instant;
  }

  void count(const CameraBlobs& blobs, std::span<const corridor::Feed> feeds) {
    std::vector<marey::calibrate::wand::WandCoverage::Detected> fresh;
    double rate_hz = kDefaultRate;
    for (std::size_t c = 0; c < feeds.size(); ++c) {
      const cv::Size size = feeds[c].info().size;
      fresh.push_back({std::span(blobs.detected[c]).subspan(counted_[c]), feeds[c].camera().lens, size});
      counted_[c] = blobs.detected[c].size();
      rate_hz = std::max(rate_hz, feeds[c].info().rate_hz.value_or(0));
    }
    coverage_.add(fresh, 0.5 / rate_hz);
  }

  const CalibrateWandOptions& options_;
  marey::calibrate::wand::WandCoverage coverage_;
  std::vector<std::size_t> counted_;
  double counted_s_ = 0;
  std::int64_t appearances_ = 0;
  LiveObserved detected_;
};

CameraBlobs wave_wand(Rig& rig, const CalibrateWandOptions& options, const Hooks& hooks) {
  WavedWand wand(options, rig);
  CameraBlobs blobs = observe_live_blobs(rig,
                                         {.markers = options.markers,
                                          .camera_settings = options.camera_settings,
                                          .for_s = options.wave_s,
                                          .will_do = [&](const BlobPreview& now) { return wand.inspect(now); }},
                                         hooks);
  blobs.warnings = wand.warnings();
  if (options.waved) options.waved();
  return blobs;
}

}  // namespace

WandCalibration calibrate_wand(const Rig& rig, const CalibrateWandOptions& options, const Hooks& hooks) {
  const StopScope scope(hooks.stop);
  marey::calibrate::wand::WandInput input{.rig = rig, .wand = options.wand, .detected = {}};
  const bool live = options.observations.empty() && has_live_cameras(rig);
  CameraBlobs blobs =
      live ? wave_wand(input.rig, options, hooks) : blobs_of(input.rig, options.observations, options.markers, hooks);
  input.detected = std::move(blobs.detected);
  marey::calibrate::wand::WandOptions how = options.how;
  how.find_offsets = blobs.timed && !options.synced;
  WandCalibration calibrated{marey::calibrate::wand::calibrate_wand(input, how, hooks), std::move(blobs.warnings)};
  if (live && options.camera_settings != nullptr) options.camera_settings->enter(calibrated.found.rig);
  return calibrated;
}

}  // namespace marey::pipeline::calibrate
