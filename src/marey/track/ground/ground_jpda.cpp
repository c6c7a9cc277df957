// Joint probabilistic data association (Fortmann, Bar-Shalom & Scheffe, "Sonar tracking of multiple targets using joint
// probabilistic data association", IEEE J. Oceanic Engineering 8 (1983)): in a view every target is corrected by the mean of the
// observations in its gate, weighed by their probabilities (assign/association_marginals.h), by as much as it is probable that one
// of them is its own.
//
// A filter here can only be corrected by one measurement z with covariance R. With β the probability that any is its own, z their
// weighted mean and S the innovation's covariance, R' = S / β − P makes the gain β K and leaves (1 − β) P + β P⁺: the mean and
// covariance of the paper but for the spread of the observations about their mean, which goes into S before. Two targets that
// stay closer than their observations resolve are drawn together, as is known of the method (coalescence, Blom & Bloem 2000); it
// is not worked against: where identities matter there, mht is the choice.
// Which target an observation is matched with is the assignment of greatest total probability.
#include "marey/track/ground/ground_jpda.h"

#include "marey/assign/association_marginals.h"
#include "marey/assign/gated_assignment.h"
#include "marey/track/ground/tracker_base.h"

namespace marey::track::ground {
namespace {

class GroundJpda final : public GroundTrackerBase {
 public:
  using GroundTrackerBase::GroundTrackerBase;

 private:
  void associate(std::span<GroundTarget> targets, std::span<const Observation<2>> detected, double late,
                 std::span<const GroundPair> pairs) override {
    gains_.clear();
    for (const GroundPair& pair : pairs) gains_.push_back({pair.target, pair.observation, gain_of(targets, pair)});
    const int rows = static_cast<int>(targets.size()), columns = static_cast<int>(detected.size());
    const auto probable = marginals_.find(rows, columns, gains_);
    for (std::size_t from = 0; from < gains_.size();) {
      std::size_t to = from;
      while (to < gains_.size() && gains_[to].row == gains_[from].row) ++to;
      GroundTarget& target = targets[gains_[from].row];
      correct(target, detected, late, std::span(gains_).subspan(from, to - from), probable.subspan(from, to - from));
      from = to;
    }
    match_probable(targets, detected, probable);
  }

  void correct(GroundTarget& target, std::span<const Observation<2>> detected, double late,
               std::span<const assign::GatedPair> pairs, std::span<const double> probable) {
    double any = 0;
    Vector<2> mean = Vector<2>::Zero();
    locations_.clear();
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      locations_.push_back(rules().at_instant(target, detected[pairs[i].column], late));
      any += probable[i];
      mean += probable[i] * locations_.back().value;
    }
    if (any < kMinProbability) return;
    mean /= any;
    Matrix<2> R = Matrix<2>::Zero();
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      const Vector<2> off = locations_[i].value - mean;
      R += probable[i] / any * (locations_[i].covariance + off * off.transpose());
    }
    const double fraction = std::min(any, 1.0);  // rounding
    const Matrix<2> S = target.filter.innovation_covariance(R);
    target.filter.correct(mean, R + (1 / fraction - 1) * S);
  }

  void match_probable(std::span<GroundTarget> targets, std::span<const Observation<2>> detected, std::span<const double> probable) {
    explained_.assign(detected.size(), 0);
    for (std::size_t i = 0; i < gains_.size(); ++i) {
      explained_[gains_[i].column] += probable[i];
      gains_[i].gain = probable[i] >= kMinMatch ? probable[i] : 0;
    }
    const auto given = assigner_.assign(static_cast<int>(targets.size()), static_cast<int>(detected.size()), gains_);
    for (int i = 0; i < static_cast<int>(targets.size()); ++i) {
      if (given[i] == assign::kNoIndex) continue;
      rules().take(targets[i], detected[given[i]], now());
      match(i, given[i]);
    }
    // What belongs to known targets, though it is open to which, is no newcomer.
    for (int o = 0; o < static_cast<int>(detected.size()); ++o) {
      if (explained_[o] > 0.5) explain(o);
    }
  }

  static constexpr double kMinProbability = 1e-6;  // numerical: less probable observations change nothing
  static constexpr double kMinMatch = 0.2;         // of the targets it may be of, the most probable must be this much

  std::vector<assign::GatedPair> gains_;
  std::vector<GroundPosition> locations_;
  std::vector<double> explained_;  // of each observation: the probability that it is a known target's
  assign::AssociationMarginals marginals_;
  assign::GatedAssigner assigner_;
};

}  // namespace

std::unique_ptr<GroundTracker> make_ground_jpda(const GroundTrackerOptions& options, std::shared_ptr<const GroundViews> views) {
  return std::make_unique<GroundJpda>(options, std::move(views));
}

}  // namespace marey::track::ground
