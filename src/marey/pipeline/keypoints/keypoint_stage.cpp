#include "marey/pipeline/keypoints/keypoint_stage.h"

#include <functional>
#include <utility>
#include <vector>

#include "marey/core/error.h"
#include "marey/detect/keypoints/blazepose.h"

namespace marey::pipeline::keypoints {
namespace {

/// The instants that waited for the cameras' end, with keypoints out of the images, which are read once more.
class InspectedAt final : public corridor::InstantSource {
 public:
  InspectedAt(std::unique_ptr<corridor::InstantSource> waited, BodyKeypoints& keypoints,
              const std::function<corridor::Feed()>& open_again, std::int64_t count, const Hooks& hooks)
      : waited_(std::move(waited)), keypoints_(keypoints), count_(count), hooks_(hooks) {
    if (open_again) feed_.emplace(open_again());
  }

  std::optional<Instant> next() override {
    while (!ended_) {
      if (auto known = keypoints_.next()) return known;
      auto instant = waited_->next();
      ended_ = !instant || hooks_.report({"keypoints", ++done_, count_}) == Continue::no;
      if (!ended_) {
        Image image = image_of(*instant);
        keypoints_.add(std::move(*instant), image);
      }
    }
    return keypoints_.next(true);
  }

 private:
  Image image_of(const Instant& instant) {
    if (!instant.frames.empty()) return instant.frames.front().image;
    if (!feed_) return {};
    while (!now_ || now_->frame.index < instant.index) {
      now_ = feed_->next();
      if (!now_) return {};
    }
    return now_->frame.index == instant.index ? now_->frame.image : Image();
  }

  std::unique_ptr<corridor::InstantSource> waited_;
  BodyKeypoints& keypoints_;
  std::optional<corridor::Feed> feed_;
  std::optional<CameraFrame> now_;
  std::int64_t count_, done_ = 0;
  const Hooks& hooks_;
  bool ended_ = false;
};

class KeypointStage final : public corridor::Stage {
 public:
  KeypointStage(std::unique_ptr<corridor::Stage> stage, const corridor::Feed& feed, const KeypointOptions& options, bool live)
      : stage_(std::move(stage)), keypoints_(options, live) {
    if (!live) open_again_ = feed.opener();
  }

  RecordingHeader header() const override {
    RecordingHeader header = stage_->header();
    header.keypoints = detect::keypoints::blazepose();
    return header;
  }
  void need_boxes() override { stage_->need_boxes(); }
  void need_foregrounds(std::function<void(corridor::FrameForeground)> give) override { stage_->need_foregrounds(std::move(give)); }
  std::vector<std::string> news() override { return stage_->news(); }

  std::span<const Instant> step(const FrameSet& frames) override {
    ++frames_;
    due_.clear();
    for (const Instant& known : stage_->step(frames)) {
      Image image;
      if (!known.frames.empty()) {
        image = known.frames.front().image;
      } else if (frames.cameras.front() && known.index == frames.index) {
        image = frames.cameras.front()->frame.image;
      }
      keypoints_.add(known, image);
      while (auto due = keypoints_.next()) due_.push_back(std::move(*due));
    }
    return due_;
  }

  std::unique_ptr<corridor::InstantSource> finish(const Hooks& hooks) override {
    auto waited = stage_->finish(hooks);
    if (waited == nullptr) return nullptr;
    return std::make_unique<InspectedAt>(std::move(waited), keypoints_, open_again_, frames_, hooks);
  }

  void report(corridor::Summary& summary) const override {
    stage_->report(summary);
    summary.dropped.no_person = keypoints_.excluded();
    summary.steps.push_back(
        {"keypoints", keypoints_.times().count(), keypoints_.times().quantile(0.5), keypoints_.times().quantile(0.99)});
  }

 private:
  std::unique_ptr<corridor::Stage> stage_;
  BodyKeypoints keypoints_;
  std::function<corridor::Feed()> open_again_;
  std::vector<Instant> due_;
  std::int64_t frames_ = 0;
};

}  // namespace

std::unique_ptr<corridor::Stage> with_keypoints(std::unique_ptr<corridor::Stage> stage, const corridor::Feed& feed,
                                                const KeypointOptions& options, bool live) {
  if (!feed.has_images()) throw Error("{}: keypoints are searched for in images, and it brings none", feed.info().name);
  if (!live && !feed.can_rewind())
    throw Error("{}: keypoints are searched for where people were tracked, so it is read twice, and that cannot be: use --live",
                feed.info().name);
  return std::make_unique<KeypointStage>(std::move(stage), feed, options, live);
}

}  // namespace marey::pipeline::keypoints
