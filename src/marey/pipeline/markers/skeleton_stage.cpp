#include "marey/pipeline/markers/skeleton_stage.h"

#include <string>
#include <utility>
#include <vector>

#include "marey/pipeline/markers/skeleton_in_space.h"

namespace marey::pipeline::markers {
namespace {

/// What waited for the cameras' end, solved as it comes.
class SolvedInstants final : public corridor::InstantSource {
 public:
  SolvedInstants(std::unique_ptr<corridor::InstantSource> waited, SkeletonInSpace& solved)
      : waited_(std::move(waited)), solved_(solved) {}
  std::optional<Instant> next() override {
    auto instant = waited_->next();
    if (instant) solved_.add_to(*instant);
    return instant;
  }

 private:
  std::unique_ptr<corridor::InstantSource> waited_;
  SkeletonInSpace& solved_;
};

class SkeletonStage final : public corridor::Stage {
 public:
  SkeletonStage(std::unique_ptr<corridor::Stage> stage, std::shared_ptr<const Skeleton> skeleton,
                const solve::skeleton::PoseOptions& options)
      : stage_(std::move(stage)), solved_(std::move(skeleton), stage_->header().rate_hz, options) {}

  RecordingHeader header() const override {
    RecordingHeader header = stage_->header();
    header.bodies = solved_.bodies();
    return header;
  }
  void need_boxes() override { stage_->need_boxes(); }
  std::span<const Instant> step(const FrameSet& frames) override {
    const std::span<const Instant> known = stage_->step(frames);
    instants_.assign(known.begin(), known.end());
    for (Instant& instant : instants_) solved_.add_to(instant);
    return instants_;
  }
  std::vector<std::string> news() override { return stage_->news(); }
  std::unique_ptr<corridor::InstantSource> finish(const Hooks& hooks) override {
    auto waited = stage_->finish(hooks);
    if (waited == nullptr) return nullptr;
    return std::make_unique<SolvedInstants>(std::move(waited), solved_);
  }
  void report(corridor::Summary& summary) const override {
    stage_->report(summary);
    summary.steps.push_back({"skeleton", solved_.times().count(), solved_.times().quantile(0.5), solved_.times().quantile(0.99)});
    corridor::SkeletonFigures& figures = summary.skeleton.emplace();
    if (const auto rms = solved_.rms_m()) figures.rms_mm = 1000 * *rms;
    figures.initialisations = static_cast<std::int64_t>(solved_.starts());
    for (std::string& warning : solved_.warnings()) summary.warnings.push_back(std::move(warning));
  }

 private:
  std::unique_ptr<corridor::Stage> stage_;
  SkeletonInSpace solved_;
  std::vector<Instant> instants_;
};

}  // namespace

std::unique_ptr<corridor::Stage> with_skeleton(std::unique_ptr<corridor::Stage> stage, std::shared_ptr<const Skeleton> skeleton,
                                               const solve::skeleton::PoseOptions& options) {
  return std::make_unique<SkeletonStage>(std::move(stage), std::move(skeleton), options);
}

}  // namespace marey::pipeline::markers
