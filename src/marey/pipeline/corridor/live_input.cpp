#include <utility>

#include <fmt/format.h>

#include "marey/core/error.h"
#include "marey/pipeline/corridor/feed_input.h"
#include "marey/source/feed_health.h"
#include "marey/source/rates.h"

namespace marey::pipeline::corridor {
namespace {

class LiveInput final : public FeedInput {
 public:
  LiveInput(std::unique_ptr<LiveSource> source, SourceInfo info, const RigCamera& camera)
      : source_(std::move(source)), info_(std::move(info)), region_(camera.region), rig_rate_hz_(camera.rate_hz) {}

  const SourceInfo& info() const override { return info_; }
  std::vector<std::string> warnings() const override { return source_->warnings(); }
  bool has_images() const override { return true; }
  bool is_live() const override { return true; }

  std::vector<CameraFrame> arrived(const source::LivePolicy& policy) override {
    std::vector<CameraFrame> frames;
    for (CameraFrame& given : source_->arrived()) {
      Image& image = given.frame.image;
      if (region_ && !image.empty()) {
        if ((*region_ & cv::Rect({}, image.size())) != *region_) continue;
        image = image.part(*region_);
      }
      frames.push_back(std::move(given));
    }
    if (!frames.empty()) health_.observed_frame(policy.time->now(), policy);
    return frames;
  }

  /// A camera that reports itself that it is gone is stalled at once.
  std::optional<FeedState> live_state(Timestamp begin, const source::LivePolicy& policy) const override {
    if (source_->ended()) return FeedState::ended;
    const FeedState state = health_.at(policy.time->now(), begin, policy);
    const bool gives = state == FeedState::live || state == FeedState::back;
    return gives && !source_->connected() ? FeedState::stalled : state;
  }

  bool has_ended() const override { return source_->ended(); }
  bool is_connected() const override { return source_->connected(); }
  CameraHealth health() const override { return source_->health(); }

  std::string rate_warning() const override {
    if (!rig_rate_hz_) return {};
    const auto own = source_->info().rate_hz;
    if (!own || !source::differ(*own, *rig_rate_hz_)) return {};
    return fmt::format(
        "the rig says rate = {0:g}, the camera {1:g} frames per second: {2}; set rate = {1:g} in the "
        "rig, or remove it",
        *rig_rate_hz_, *own, *own < *rig_rate_hz_ ? "instants between its frames have none" : "frames are dropped");
  }

 private:
  std::unique_ptr<LiveSource> source_;
  SourceInfo info_;
  std::optional<cv::Rect> region_;
  std::optional<double> rig_rate_hz_;
  source::FeedHealth health_;
};

}  // namespace

std::unique_ptr<FeedInput> live_input(RigCamera& camera, std::unique_ptr<LiveSource> source) {
  SourceInfo info = source->info();
  const std::optional<cv::Size> size_in_rig = camera.size;
  if (info.size.empty() && camera.size && !camera.region) source->take_only(*camera.size);
  if (camera.region && !info.size.empty()) check_region(*camera.region, info.size, info.name);
  if (camera.region) info.size = camera.region->size();
  if (!info.size.empty()) fit_to_size(camera, info.size);
  if (info.size.empty() && size_in_rig) info.size = *size_in_rig;
  if (camera.rate_hz) info.rate_hz = camera.rate_hz;
  return std::make_unique<LiveInput>(std::move(source), std::move(info), camera);
}

}  // namespace marey::pipeline::corridor
