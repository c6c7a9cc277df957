#include "marey/track/ground/ground_gnn.h"

#include "marey/assign/gated_assignment.h"
#include "marey/track/ground/ground_follower.h"

namespace marey::track::ground {
namespace {

template <typename F>
class GroundGnn final : public GroundFollower<F> {
 public:
  using GroundFollower<F>::GroundFollower;

 private:
  void associate(std::span<GroundTarget<F>> targets, std::span<const Observation<2>> seen, double late,
                 std::span<const GroundPair<F>> pairs) override {
    gains_.clear();
    for (const GroundPair<F>& pair : pairs) gains_.push_back({pair.target, pair.observation, this->gain_of(targets, pair)});
    const auto given = assigner_.assign(static_cast<int>(targets.size()), static_cast<int>(seen.size()), gains_);
    for (int i = 0; i < static_cast<int>(targets.size()); ++i) {
      if (given[i] == assign::GatedAssigner::nobody) continue;
      const Observation<2>& one = seen[given[i]];
      this->rules().correct(targets[i], one, this->rules().at_instant(targets[i], one, late), this->now());
      this->claim(i, given[i]);
    }
  }

  std::vector<assign::GatedPair> gains_;
  assign::GatedAssigner assigner_;
};

}  // namespace

std::unique_ptr<GroundTracker> make_ground_gnn(const GroundTrackerOptions& options, std::vector<GroundView> views) {
  return filter::with_filter<2>(
      options.filter, [&]<typename F>(const typename F::Options& filter) -> std::unique_ptr<GroundTracker> {
        return std::make_unique<GroundGnn<F>>(options, filter, std::move(views));
      });
}

}  // namespace marey::track::ground
