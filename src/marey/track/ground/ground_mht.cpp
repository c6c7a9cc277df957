// Multiple-hypothesis tracking on the ground: who is whom is not decided from one look, but kept open, several answers side by side
// with their probabilities, until later looks decide; what is older than the window (N-scan) is decided by the answer that is best
// by then.
//
// Reid 1979; Cox & Hingorani 1996 (Murty's k best, clusters, N-scan, ratio); Beetz et al. use it for football in ASPOGAMO. Motion,
// gates, costs, birth and death are those of gnn (ground_target.h). Deviations from Cox & Hingorani:
//   - false alarm, hidden and gone are no hypotheses of their own but probabilities of each leaf (ground_presence.h), summed
//   exactly;
//   - hypotheses that have come to the same state of the same trees are made one, their probabilities summed: at 25 frames a
//     second two who run side by side give two answers a frame, and 50 hypotheses would otherwise all differ in the last
//     6 frames only, with nothing left of the one doubt that matters, who is who;
//   - an observation that may be of two who touch is believed less, by all;
//   - the looks of one instant branch one after the other; the window is counted in time.
// Cost: as gnn's while nobody is near another; in a scuffle that times the hypotheses kept (ground_hypotheses.h).
#include "marey/track/ground/ground_mht.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "marey/assign/point_grid.h"
#include "marey/core/error.h"
#include "marey/track/check_frame.h"
#include "marey/track/ground/ground_duplicates.h"
#include "marey/track/ground/ground_history.h"
#include "marey/track/ground/ground_presence.h"
#include "marey/track/ground/ground_sight.h"
#include "marey/track/ground/ground_target.h"

namespace marey::track::ground {
namespace {

/// One target with one history: what a number in GroundHypotheses stands for.
template <typename F>
struct Leaf {
  GroundTarget<F> target;
  GroundHistory::Place place = {};                 ///< its record of the last instant
  int claims = GroundHistory::nobody;              ///< at this instant
  bool over = false;                               ///< given up; it stays until that is decided
  std::optional<GroundTarget<F>> ahead{};  ///< where it would be a while later, once somebody asked
};

template <typename F>
class GroundMht final : public GroundTracker {
 public:
  GroundMht(const GroundTrackerOptions& options, const typename F::Options& filter, std::vector<GroundView> views,
            const GroundMhtLimits& limits)
      : rules_(options, filter, static_cast<int>(views.size())),
        sight_(std::move(views)),
        hypotheses_({options.hypotheses, limits.leaves, -std::log(limits.ratio)}),
        limits_(limits) {}

  std::span<const Track<2>> step(Timestamp now, std::span<const CameraObservations> looks) override {
    check_time(now, now_);
    for (const CameraObservations& look : looks) sight_.check(look);
    predict_to(now);
    history_.forget_told();
    history_.begin(now);
    for (int i = 0; i < static_cast<int>(looks.size()); ++i) take_in(i, looks[i]);
    merge_duplicates();
    retire_lost();
    note();
    decide();
    hypotheses_.split([this](int leaf, auto&& tell) { history_.for_each_past_claim(leaves_[leaf].place, tell); });
    compact();
    return report();
  }

  std::span<const ObservationMatch> claims() const override { return claims_; }

  std::span<const Track<2>> expected(Timestamp now) override {
    const double dt = now_ ? std::max(0.0, seconds(now - *now_)) : 0.0;
    tracks_.clear();
    for (const int leaf : hypotheses_.best()) {
      if (leaves_[leaf].over || !leaves_[leaf].target.confirmed) continue;
      GroundTarget<F> ahead = leaves_[leaf].target;
      rules_.predict(ahead, dt);
      tracks_.push_back(rules_.report(ahead));
    }
    return tracks_;
  }

  std::span<const GroundDecision> decided() override { return history_.told(); }

  std::span<const GroundDecision> decide_all() override {
    history_.forget_told();
    if (const auto newest = history_.newest()) history_.decide(*newest, places_of_best());
    return history_.told();
  }

 private:
  void predict_to(Timestamp now) {
    dt_ = now_ ? seconds(now - *now_) : first_interval;
    for (Leaf<F>& leaf : leaves_) {
      if (leaf.over) continue;
      rules_.predict(leaf.target, dt_);
      leaf.claims = GroundHistory::nobody;
      leaf.ahead.reset();
    }
    now_ = now;
  }

  void take_in(int index, const CameraObservations& look) {
    const double late = seconds(look.time - *now_);
    sight_.look(look.camera, look.seen, rules_.options().confident);
    find_missed();
    find_shared(look.seen);
    find_pairs(seen_, late);
    find_beginnings(look.seen);
    const auto children = hypotheses_.branch(pairs_, missed_, begins_);
    next_.clear();
    for (int i = 0; i < static_cast<int>(children.size()); ++i) {
      const auto& [parent, observation] = children[i];
      if (parent == GroundHypotheses::nobody) {
        next_.push_back({rules_.start(TrackId{hypotheses_.tree(i)}, *now_, look.seen[observation])});
        next_.back().target.presence = GroundPresence(births(), rules_.options().clutter);
        next_.back().claims = history_.claim(index, observation, GroundHistory::nobody);
        continue;
      }
      Leaf<F>& leaf = next_.emplace_back(leaves_[parent]);
      if (leaf.over) continue;
      leaf.ahead.reset();
      if (observation == GroundHypotheses::nobody) {
        rules_.miss(leaf.target, visible_[parent]);
      } else {
        const Observation<2>& seen = seen_[observation];
        rules_.correct(leaf.target, seen, rules_.at_instant(leaf.target, seen, late), *now_);
        leaf.claims = history_.claim(index, observation, leaf.claims);
      }
    }
    std::swap(leaves_, next_);
    if (limits_.fold) hypotheses_.fold([this](int a, int b) { return alike(leaves_[a], leaves_[b]); });
  }

  /// How many people appear per m² from one instant to the next.
  double births() const { return rules_.options().births * dt_; }

  void find_missed() {
    missed_.clear();
    visible_.clear();
    for (const Leaf<F>& leaf : leaves_) {
      visible_.push_back(leaf.over ? 0 : sight_.visible(leaf.target.filter.position()));
      missed_.push_back(std::log1p(-visible_.back() * leaf.target.presence.visible() * rules_.options().detected));
    }
  }

  /// An observation at which two are expected, with no other near it, may be of both: it lies between them, and that is all that
  /// is believed of it. Where there are boxes, these tell who is hidden (ground_sight.h).
  void find_shared(std::span<const Observation<2>> seen) {
    seen_.assign(seen.begin(), seen.end());
    if (!limits_.doubt) return;
    known_.clear();
    for (const int leaf : hypotheses_.best()) {
      const GroundTarget<F>& target = leaves_[leaf].target;
      if (!leaves_[leaf].over && target.confirmed) known_.push_back(target.filter.position());
    }
    const auto touches = [](const Vector<2>& a, const Vector<2>& b) { return (a - b).squaredNorm() < touch * touch; };
    for (Observation<2>& one : seen_) {
      if (one.box) continue;
      const auto expected =
          std::count_if(known_.begin(), known_.end(), [&](const auto& place) { return touches(place, one.value); });
      if (expected < 2) continue;
      const auto found =
          std::count_if(seen.begin(), seen.end(), [&](const auto& other) { return touches(other.value, one.value); });
      if (expected > found) one.covariance.diagonal().array() += between * between;
    }
  }

  void find_pairs(std::span<const Observation<2>> seen, double late) {
    points_.clear();
    double widest = 0;
    for (const Observation<2>& one : seen) {
      points_.push_back(one.value);
      widest = std::max(widest, one.covariance.trace());
    }
    grid_.build(points_, 1 + 2 * std::sqrt(widest));
    const double unknown = std::log1p(births() / rules_.options().clutter);  // an observation that nothing known explains
    pairs_.clear();
    for (int i = 0; i < static_cast<int>(leaves_.size()); ++i) {
      const Leaf<F>& leaf = leaves_[i];
      if (leaf.over) continue;
      const double prior = std::log(leaf.target.presence.visible()) - unknown;
      const double radius = rules_.search_radius(leaf.target, widest) + std::abs(late) * rules_.options().max_speed;
      const auto first = static_cast<std::ptrdiff_t>(pairs_.size());
      grid_.for_each_near(leaf.target.filter.position(), radius, [&](int o) {
        if (seen[o].score < rules_.options().weak) return;
        const auto ratio = rules_.log_ratio(leaf.target, seen[o], rules_.at_instant(leaf.target, seen[o], late), *now_);
        if (ratio) pairs_.push_back({i, o, *ratio + prior});
      });
      std::sort(pairs_.begin() + first, pairs_.end(),
                [](const assign::GatedPair& a, const assign::GatedPair& b) { return a.column < b.column; });
    }
  }

  /// Nobody begins with a detector's doubt, nor with its second box around one person.
  void find_beginnings(std::span<const Observation<2>> seen) {
    explained_.assign(seen.size(), 0);
    for (const assign::GatedPair& pair : pairs_) explained_[pair.column] = 1;
    begins_.assign(seen.size(), 0);
    for (std::size_t i = 0; i < seen.size(); ++i) {
      bool second = false;
      for (std::size_t j = 0; j < seen.size() && seen[i].box; ++j) {
        if (j == i || !seen[j].box || (j > i && !explained_[j])) continue;
        second = second || geometry::iou(*seen[i].box, *seen[j].box) > duplicate_iou;
      }
      begins_[i] = seen[i].score >= rules_.options().confident && !second;
    }
  }

  /// Cameras that disagree about a place may each have fed a tree of its own: the younger ends, in all hypotheses.
  void merge_duplicates() {
    members_.clear();
    const auto best = hypotheses_.best();
    for (const int i : best) {
      const GroundTarget<F>& target = leaves_[i].target;
      if (!leaves_[i].over) members_.push_back({target.id, target.filter.position(), target.filter.covariance(), target.cameras});
    }
    const auto& merges = duplicates_.find(*now_, members_, rules_.options().disagreement);
    for (const auto& [kept, gone] : merges) {
      const auto with_id = [&](TrackId id) {
        return *std::find_if(best.begin(), best.end(), [&](int i) { return leaves_[i].target.id == id; });
      };
      absorb(leaves_[with_id(kept)], leaves_[with_id(gone)]);
      for (Leaf<F>& leaf : leaves_) leaf.over = leaf.over || leaf.target.id == gone;
    }
  }

  void absorb(Leaf<F>& into, const Leaf<F>& leaf) {
    rules_.absorb(into.target, leaf.target);
    claim_list_.clear();
    history_.for_each_claim(leaf.claims, [&](int look, int observation) { claim_list_.emplace_back(look, observation); });
    for (const auto& [look, observation] : claim_list_) into.claims = history_.claim(look, observation, into.claims);
  }

  /// Who never was confirmed leaves nothing behind; others stay, given up, until that is decided.
  void retire_lost() {
    gone_.assign(leaves_.size(), 0);
    for (std::size_t i = 0; i < leaves_.size(); ++i) {
      Leaf<F>& leaf = leaves_[i];
      leaf.over = leaf.over || rules_.lost(leaf.target, *now_);
      gone_[i] = leaf.over && !leaf.target.confirmed;
    }
    hypotheses_.drop(gone_);
  }

  /// Two leaves of one tree that will fare alike: they are at one place now, and a while later still.
  bool alike(Leaf<F>& a, Leaf<F>& b) const {
    if (a.over || b.over) return a.over == b.over;
    if (!near(a.target, b.target)) return false;
    return near(ahead_of(a), ahead_of(b));
  }

  static bool near(const GroundTarget<F>& a, const GroundTarget<F>& b) {
    const double spread = std::min(a.filter.covariance().trace(), b.filter.covariance().trace()) / 2;
    return (a.filter.position() - b.filter.position()).squaredNorm() <= same_sigmas * same_sigmas * spread;
  }

  const GroundTarget<F>& ahead_of(Leaf<F>& leaf) const {
    if (!leaf.ahead) {
      leaf.ahead = leaf.target;
      rules_.predict(*leaf.ahead, a_while);
    }
    return *leaf.ahead;
  }

  void note() {
    for (Leaf<F>& leaf : leaves_) {
      if (!leaf.over) leaf.place = history_.note(leaf.place, rules_.report(leaf.target), leaf.claims);
    }
  }

  void decide() {
    const auto level = history_.newest_until(*now_ - duration_from_seconds(rules_.options().window));
    if (!level) return;
    past_.clear();
    for (const Leaf<F>& leaf : leaves_) past_.push_back(history_.past(leaf.place, *level));
    hypotheses_.decide(past_);
    history_.decide(*level, places_of_best());
    for (std::size_t i = 0; i < leaves_.size(); ++i) gone_[i] = leaves_[i].over && leaves_[i].place.level <= *level;
    hypotheses_.drop(gone_);
  }

  std::span<const GroundHistory::Place> places_of_best() {
    places_.clear();
    for (const int leaf : hypotheses_.best()) places_.push_back(leaves_[leaf].place);
    return places_;
  }

  void compact() {
    next_.clear();
    for (const int leaf : hypotheses_.compact()) next_.push_back(std::move(leaves_[leaf]));
    std::swap(leaves_, next_);
  }

  std::span<const Track<2>> report() {
    tracks_.clear();
    claims_.clear();
    for (const int i : hypotheses_.best()) {
      const Leaf<F>& leaf = leaves_[i];
      if (leaf.over) continue;
      tracks_.push_back(rules_.report(leaf.target));
      history_.for_each_claim(leaf.claims,
                              [&](int look, int observation) { claims_.push_back({leaf.target.id, look, observation}); });
    }
    return tracks_;
  }

  static constexpr double duplicate_iou = 0.75;
  static constexpr double touch = 0.5;         // m: people nearer than this may be seen as one
  static constexpr double between = 0.25;      // m: how far from the middle of two each of them is then
  static constexpr double first_interval = 1;  // s: who stands there at the first instant has come before
  static constexpr double same_sigmas = 0.5;
  static constexpr double a_while = 0.5;  // s

  GroundRules<F> rules_;
  GroundSight sight_;
  GroundDuplicates duplicates_;
  GroundHypotheses hypotheses_;
  GroundHistory history_;
  GroundMhtLimits limits_;
  std::optional<Timestamp> now_;
  double dt_ = 0;
  std::vector<Leaf<F>> leaves_, next_;
  std::vector<Track<2>> tracks_;
  std::vector<ObservationMatch> claims_;
  // What an instant needs, kept so that it is allocated once.
  std::vector<double> missed_, visible_;
  std::vector<Observation<2>> seen_;  // of the look at hand, as far as each is believed
  std::vector<assign::GatedPair> pairs_;
  std::vector<char> begins_, explained_, gone_;
  std::vector<Vector<2>> points_, known_;
  std::vector<int> past_;
  std::vector<GroundHistory::Place> places_;
  std::vector<std::pair<int, int>> claim_list_;
  std::vector<GroundDuplicates::Member> members_;
  assign::PointGrid<2> grid_;  // of observations
};

}  // namespace

std::unique_ptr<GroundTracker> make_ground_mht(const GroundTrackerOptions& options, std::vector<GroundView> views,
                                               const GroundMhtLimits& limits) {
  return filter::with_filter<2>(
      options.filter, [&]<typename F>(const typename F::Options& filter) -> std::unique_ptr<GroundTracker> {
        return std::make_unique<GroundMht<F>>(options, filter, std::move(views), limits);
      });
}

}  // namespace marey::track::ground
