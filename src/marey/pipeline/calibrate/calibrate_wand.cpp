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

constexpr double kCountEvery = 2;  // s of waving that are looked through at a time

/// Counts what cameras see of the wand while it is waved.
class WavedWand {
 public:
  WavedWand(const CalibrateWandOptions& options, const Rig& rig)
      : options_(options),
        lenses_known_(knows_lenses(rig)),
        coverage_(options.wand, rig.cameras.size(), lenses_known_),
        counted_(rig.cameras.size()) {}

  /// Whether that will do.
  bool look(const LiveLook& now) {
    if (now.seconds - counted_s_ >= kCountEvery) {
      counted_s_ = now.seconds;
      count(now.blobs, now.feeds);
    }
    using marey::calibrate::wand::WandCoverage;
    seen_ = {.seconds = now.seconds, .cameras = {}, .shared = {}, .now = seen_now(now), .enough = coverage_.is_enough()};
    for (std::size_t c = 0; c < now.feeds.size(); ++c) {
      const auto& parts = coverage_.parts(c);
      CameraHealth health = now.feeds[c].health({}, now.policy);
      health.rate_hz = now.feeds[c].info().rate_hz;
      seen_.cameras.push_back(
          {std::move(health), coverage_.coverage(c), coverage_.views(c), coverage_.is_covered(c), {parts.begin(), parts.end()}});
      for (std::size_t other = c + 1; other < now.feeds.size(); ++other) {
        const std::int64_t views = coverage_.shared(c, other);
        seen_.shared.push_back({c, other, views, views >= WandCoverage::kEnoughShared});
      }
    }
    const bool go_on = !options_.waving || options_.waving(seen_);
    return seen_.enough || !go_on;
  }

  std::vector<std::string> warnings() const {
    std::vector<std::string> sentences;
    for (const WandSeen::Camera& camera : seen_.cameras) {
      if (!camera.covered)
        sentences.push_back(fmt::format("camera \"{}\" saw the wand in {:.0f} % of its picture; {:.0f} % are wanted",
                                        camera.health.name, 100 * camera.coverage,
                                        100 * marey::calibrate::wand::WandCoverage::wanted(lenses_known_)));
    }
    return sentences;
  }

 private:
  Instant seen_now(const LiveLook& now) {
    Instant instant;
    instant.index = looks_++;
    instant.time = timestamp_from_seconds(now.seconds);
    for (std::size_t c = 0; c < now.newest.size(); ++c) {
      const CameraFrame& given = now.newest[c];
      if (!given.detections) continue;
      const CameraId camera{static_cast<int>(c)};
      if (!given.frame.picture.empty()) instant.frames.push_back(given.frame);
      marey::calibrate::wand::BlobFrame frame;
      for (const Detection& blob : *given.detections) frame.blobs.push_back(blob.centre);
      const auto found =
          marey::calibrate::wand::find_marks({&frame, 1}, options_.wand, now.feeds[c].camera().lens, now.feeds[c].info().size);
      for (const Vector<2>& blob : frame.blobs) {
        SeenPoint& seen = instant.seen.emplace_back();
        seen.camera = camera;
        seen.pixel = blob;
        for (std::size_t m = 0; !found.empty() && m < options_.wand.markers(); ++m) {
          if (found.front().marks[m] == blob) seen.track = TrackId{static_cast<int>(m) + 1};
        }
      }
    }
    return instant;
  }

  void count(const CameraBlobs& blobs, std::span<const corridor::Feed> feeds) {
    std::vector<marey::calibrate::wand::WandCoverage::Seen> fresh;
    double rate_hz = kUsualRate;
    for (std::size_t c = 0; c < feeds.size(); ++c) {
      const cv::Size size = feeds[c].info().size;
      fresh.push_back({std::span(blobs.seen[c]).subspan(counted_[c]), feeds[c].camera().lens, size});
      counted_[c] = blobs.seen[c].size();
      rate_hz = std::max(rate_hz, feeds[c].info().rate_hz.value_or(0));
    }
    coverage_.add(fresh, 0.5 / rate_hz);
  }

  const CalibrateWandOptions& options_;
  bool lenses_known_;
  marey::calibrate::wand::WandCoverage coverage_;
  std::vector<std::size_t> counted_;
  double counted_s_ = 0;
  std::int64_t looks_ = 0;
  WandSeen seen_;
};

CameraBlobs wave_wand(Rig& rig, const CalibrateWandOptions& options, const Hooks& hooks) {
  WavedWand wand(options, rig);
  CameraBlobs blobs = see_live_blobs(rig,
                                     {.markers = options.markers,
                                      .desk = options.desk,
                                      .for_s = options.wave_s,
                                      .will_do = [&](const LiveLook& now) { return wand.look(now); }},
                                     hooks);
  blobs.warnings = wand.warnings();
  if (options.waved) options.waved();
  return blobs;
}

}  // namespace

WandCalibration calibrate_wand(const Rig& rig, const CalibrateWandOptions& options, const Hooks& hooks) {
  const StopScope scope(hooks.stop);
  marey::calibrate::wand::WandInput input{.rig = rig, .wand = options.wand, .seen = {}};
  const bool live = options.observations.empty() && has_live_cameras(rig);
  CameraBlobs blobs =
      live ? wave_wand(input.rig, options, hooks) : blobs_of(input.rig, options.observations, options.markers, hooks);
  input.seen = std::move(blobs.seen);
  marey::calibrate::wand::WandOptions how = options.how;
  how.find_offsets = blobs.timed && !options.synced;
  WandCalibration calibrated{marey::calibrate::wand::calibrate_wand(input, how, hooks), std::move(blobs.warnings)};
  if (live && options.desk != nullptr) options.desk->enter(calibrated.found.rig);
  return calibrated;
}

}  // namespace marey::pipeline::calibrate
