#include "marey/pipeline/calibrate/live_blobs.h"

#include <algorithm>
#include <memory>
#include <utility>

#include <tbb/parallel_for.h>

#include "marey/core/error.h"
#include "marey/files/source_name.h"
#include "marey/pipeline/calibrate/live_observed.h"
#include "marey/pipeline/live/live_feeds.h"

namespace marey::pipeline::calibrate {
namespace {

constexpr double kNothingAfter = 10;  // s without a frame of any camera

/// What has result from one camera since the last call.
void take_blobs(corridor::Feed& feed, const source::LivePolicy& policy, double offset_s,
                std::vector<marey::calibrate::wand::BlobFrame>& frames, CameraFrame& newest) {
  for (CameraFrame& given : feed.arrived(policy)) {
    auto& blobs = frames.emplace_back(marey::calibrate::wand::BlobFrame{seconds(given.frame.time) - offset_s, {}});
    for (const Detection& blob : *given.detections) blobs.blobs.push_back(blob.centre);
    newest = std::move(given);
  }
}

}  // namespace

bool has_live_cameras(const Rig& rig) {
  return std::any_of(rig.cameras.begin(), rig.cameras.end(),
                     [](const RigCamera& camera) { return !scheme_of(camera.source).empty(); });
}

CameraBlobs observe_live_blobs(Rig& rig, const LiveBlobsOptions& options, const Hooks& hooks) {
  const StopScope scope(hooks.stop);
  const source::LivePolicy policy{.time = source::steady_time()};
  live::CameraSettings as_rig_says(rig, options.markers.threshold);
  live::CameraSettings& camera_settings = options.camera_settings != nullptr ? *options.camera_settings : as_rig_says;
  std::vector<corridor::Feed> feeds = live::open_live_feeds(rig, policy, options.patience_s, &camera_settings);
  for (std::size_t c = 0; c < feeds.size(); ++c) {
    feeds[c].find(std::make_unique<corridor::TunedMarkers>(options.markers, camera_settings.tuning(c)));
    feeds[c].tune(camera_settings.tuning(c));
  }
  CameraBlobs blobs;
  blobs.detected.resize(feeds.size());
  std::vector<CameraFrame> newest(feeds.size());
  const double begin = seconds(policy.time->now());
  std::optional<double> first;
  double inspected = begin;
  while (true) {
    tbb::parallel_for(std::size_t{0}, feeds.size(), [&](std::size_t c) {
      take_blobs(feeds[c], policy, rig.cameras[c].offset_s.value_or(0), blobs.detected[c], newest[c]);
    });
    const double now = seconds(policy.time->now());
    std::int64_t frames = 0;
    for (const auto& detected : blobs.detected) frames += std::ssize(detected);
    hooks.advance({"searching for markers", frames, std::nullopt});
    if (frames > 0 && !first) first = now;
    if (!first && now - begin > kNothingAfter) throw Error("{}", why_nothing_came(feeds));
    if (first && now - *first >= options.for_s) break;
    if (options.will_do && now - inspected >= kInspectEvery) {
      inspected = now;
      if (options.will_do({blobs, feeds, newest, policy, first ? now - *first : 0})) break;
    }
    if (std::all_of(feeds.begin(), feeds.end(), [](const corridor::Feed& feed) { return feed.has_ended(); })) break;
    policy.time->wait();
  }
  if (!first) throw Error("{}", why_nothing_came(feeds));
  enter_cameras(rig, feeds);
  return blobs;
}

}  // namespace marey::pipeline::calibrate
