#include "marey/pipeline/markers/set_stage.h"

#include <string>
#include <utility>
#include <vector>

namespace marey::pipeline::markers {
namespace {

/// What waited for the cameras' end, named as it comes.
class NamedInstants final : public corridor::InstantSource {
 public:
  NamedInstants(std::unique_ptr<corridor::InstantSource> waited, LiveLabelling& named)
      : waited_(std::move(waited)), named_(named) {}
  std::optional<Instant> next() override {
    auto instant = waited_->next();
    if (instant) named_.add_to(*instant);
    return instant;
  }

 private:
  std::unique_ptr<corridor::InstantSource> waited_;
  LiveLabelling& named_;
};

class SetStage final : public corridor::Stage {
 public:
  SetStage(std::unique_ptr<corridor::Stage> stage, std::shared_ptr<const LearnedMarkers> set, const SetInSpaceOptions& options)
      : stage_(std::move(stage)), named_(std::move(set), stage_->header().rate_hz, options) {}

  RecordingHeader header() const override { return stage_->header(); }
  void need_boxes() override { stage_->need_boxes(); }
  std::span<const Instant> step(const FrameSet& frames) override {
    const std::span<const Instant> known = stage_->step(frames);
    instants_.assign(known.begin(), known.end());
    for (Instant& instant : instants_) named_.add_to(instant);
    return instants_;
  }
  std::vector<std::string> news() override {
    std::vector<std::string> all = stage_->news();
    for (std::string& message_text : named_.news()) all.push_back(std::move(message_text));
    return all;
  }
  std::unique_ptr<corridor::InstantSource> finish(const Hooks& hooks) override {
    auto waited = stage_->finish(hooks);
    if (waited == nullptr) return nullptr;
    return std::make_unique<NamedInstants>(std::move(waited), named_);
  }
  void report(corridor::Summary& summary) const override {
    stage_->report(summary);
    summary.steps.push_back({"names", named_.times().count(), named_.times().quantile(0.5), named_.times().quantile(0.99)});
    summary.marker_set = {static_cast<std::int64_t>(named_.points()), static_cast<std::int64_t>(named_.named()),
                          named_.searched_s(), named_.found_at_s()};
    for (std::string& warning : named_.warnings()) summary.warnings.push_back(std::move(warning));
  }

 private:
  std::unique_ptr<corridor::Stage> stage_;
  LiveLabelling named_;
  std::vector<Instant> instants_;
};

}  // namespace

std::unique_ptr<corridor::Stage> with_set(std::unique_ptr<corridor::Stage> stage, std::shared_ptr<const LearnedMarkers> set,
                                          const SetInSpaceOptions& options) {
  return std::make_unique<SetStage>(std::move(stage), std::move(set), options);
}

}  // namespace marey::pipeline::markers
