#include "marey/track/ground/ground_gnn.h"

#include "marey/assign/gated_assignment.h"
#include "marey/track/ground/tracker_base.h"

namespace marey::track::ground {
namespace {

class GroundGnn final : public GroundTrackerBase {
 public:
  using GroundTrackerBase::GroundTrackerBase;

 private:
  void associate(std::span<GroundTarget> targets, std::span<const Observation<2>> detected, double late,
                 std::span<const GroundPair> pairs) override {
    gains_.clear();
    for (const GroundPair& pair : pairs) gains_.push_back({pair.target, pair.observation, gain_of(targets, pair)});
    const auto given = assigner_.assign(static_cast<int>(targets.size()), static_cast<int>(detected.size()), gains_);
    for (int i = 0; i < static_cast<int>(targets.size()); ++i) {
      if (given[i] == assign::kNoIndex) continue;
      const Observation<2>& one = detected[given[i]];
      rules().correct(targets[i], one, rules().at_instant(targets[i], one, late), now());
      match(i, given[i]);
    }
  }

  std::vector<assign::GatedPair> gains_;
  assign::GatedAssigner assigner_;
};

}  // namespace

std::unique_ptr<GroundTracker> make_ground_gnn(const GroundTrackerOptions& options, std::shared_ptr<const GroundViews> views) {
  return std::make_unique<GroundGnn>(options, std::move(views));
}

}  // namespace marey::track::ground
