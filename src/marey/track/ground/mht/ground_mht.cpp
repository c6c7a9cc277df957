// Multiple-hypothesis tracking on the ground: identities are not decided from one view, but kept open, several answers side by side
// with their probabilities, until later views decide; what is older than the window (N-scan) is decided by the answer that is best
// by then.
//
// Reid 1979; Cox & Hingorani 1996 (Murty's k best, clusters, N-scan, ratio); Beetz et al. use it for football in ASPOGAMO. Motion,
// gates, costs, birth and death are those of gnn (ground_target.h). Deviations from Cox & Hingorani:
//   - false alarm, hidden and gone are not hypotheses of their own but probabilities of each leaf (ground_presence.h), summed
//   exactly;
//   - hypotheses that have come to the same state of the same trees are made one, their probabilities summed: at 25 frames a
//     second two that run side by side give two answers a frame, and 50 hypotheses would otherwise all differ in the last
//     6 frames only, with nothing left of the one doubt that matters, the identities;
//   - an observation that may be of two that touch is trusted less, by all;
//   - the views of one instant branch one after the other; the window is counted in time.
// Cost: as gnn's while none is near another; in a scuffle that times the hypotheses kept (ground_hypotheses.h).
#include "marey/track/ground/mht/ground_mht.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "marey/assign/point_grid.h"
#include "marey/core/error.h"
#include "marey/track/check_frame.h"
#include "marey/track/ground/ground_duplicates.h"
#include "marey/track/ground/ground_presence.h"
#include "marey/track/ground/ground_target.h"
#include "marey/track/ground/ground_visibility.h"
#include "marey/track/ground/mht/ground_history.h"

namespace marey::track::ground::mht {
namespace {

/// One target with one history: what a number in GroundHypotheses stands for.
struct Leaf {
  GroundTarget target;
  GroundHistory::Location location = {};  ///< its record of the last instant
  int matches = assign::kNoIndex;         ///< at this instant
  bool over = false;                      ///< given up; it stays until that is decided
  std::optional<GroundTarget> ahead{};    ///< where it would be a while later, once that was asked
};

class GroundMht final : public GroundTracker {
 public:
  using GroundTracker::step;

  GroundMht(const GroundTrackerOptions& options, std::shared_ptr<const GroundViews> views, const GroundMhtLimits& limits)
      : rules_(options, views->cameras()),
        visibility_(std::move(views)),
        hypotheses_({options.hypotheses, limits.leaves, -std::log(limits.ratio)}),
        limits_(limits) {}

  std::span<const Track<2>> step(Timestamp now, std::span<const CameraObservations> views) override {
    check_time(now, now_);
    for (const CameraObservations& view : views) visibility_.check(view);
    predict_to(now);
    history_.forget_decided();
    history_.begin(now);
    for (const int i : surest_first(views)) take_in(i, views[i]);
    merge_duplicates();
    retire_lost();
    note();
    decide();
    hypotheses_.split([this](int leaf, auto&& visit) { history_.for_each_past_match(leaves_[leaf].location, visit); });
    compact();
    return report();
  }

  std::span<const ObservationMatch> matches() const override { return matches_; }

  std::span<const Track<2>> expected(Timestamp now) override {
    const double dt = now_ ? std::max(0.0, seconds(now - *now_)) : 0.0;
    tracks_.clear();
    for (const int leaf : hypotheses_.best()) {
      if (leaves_[leaf].over || !leaves_[leaf].target.confirmed()) continue;
      GroundTarget ahead = leaves_[leaf].target;
      rules_.predict(ahead, dt);
      tracks_.push_back(rules_.report(ahead));
    }
    return tracks_;
  }

  std::span<const GroundDecision> decided() override { return history_.decided(); }

  std::span<const GroundDecision> decide_all() override {
    history_.forget_decided();
    if (const auto newest = history_.newest()) history_.decide(*newest, positions_of_best());
    return history_.decided();
  }

 private:
  void predict_to(Timestamp now) {
    dt_ = now_ ? seconds(now - *now_) : first_interval;
    for (Leaf& leaf : leaves_) {
      if (leaf.over) continue;
      rules_.predict(leaf.target, dt_);
      leaf.matches = assign::kNoIndex;
      leaf.ahead.reset();
    }
    now_ = now;
  }

  void take_in(int index, const CameraObservations& view) {
    const double late = seconds(view.time - *now_);
    visibility_.set_view(view, rules_.options().evidence.confident);
    find_missed();
    find_shared(view.detected);
    find_pairs(detected_, late);
    find_beginnings(view.detected);
    const auto children = hypotheses_.branch(pairs_, missed_, begins_);
    next_.clear();
    for (int i = 0; i < static_cast<int>(children.size()); ++i) {
      const auto& [parent, observation] = children[i];
      if (parent == assign::kNoIndex) {
        next_.push_back({rules_.start(TrackId{hypotheses_.tree(i)}, *now_, view.detected[observation])});
        next_.back().target.presence = GroundPresence(births(), rules_.options().clutter);
        next_.back().matches = history_.match(index, observation, assign::kNoIndex);
        continue;
      }
      Leaf& leaf = next_.emplace_back(leaves_[parent]);
      if (leaf.over) continue;
      leaf.ahead.reset();
      if (observation == assign::kNoIndex) {
        rules_.miss(leaf.target, visible_[parent]);
      } else {
        const Observation<2>& detected = detected_[observation];
        rules_.correct(leaf.target, detected, rules_.at_instant(leaf.target, detected, late), *now_);
        leaf.matches = history_.match(index, observation, leaf.matches);
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
    for (const Leaf& leaf : leaves_) {
      visible_.push_back(leaf.over ? 0 : visibility_.visible(leaf.target.filter.position()));
      missed_.push_back(std::log1p(-visible_.back() * leaf.target.presence.visible() * rules_.options().detected));
    }
  }

  /// An observation at which two are expected, with no other near it, may be of both: it lies between them, and that is all that
  /// is trusted of it. Where there are boxes, these say which is hidden (ground_visibility.h).
  void find_shared(std::span<const Observation<2>> detected) {
    detected_.assign(detected.begin(), detected.end());
    if (!limits_.distrust_shared) return;
    known_.clear();
    for (const int leaf : hypotheses_.best()) {
      const GroundTarget& target = leaves_[leaf].target;
      if (!leaves_[leaf].over && target.confirmed()) known_.push_back(target.filter.position());
    }
    const auto touches = [](const Vector<2>& a, const Vector<2>& b) { return (a - b).squaredNorm() < touch * touch; };
    for (Observation<2>& one : detected_) {
      if (one.box) continue;
      const auto expected =
          std::count_if(known_.begin(), known_.end(), [&](const auto& location) { return touches(location, one.value); });
      if (expected < 2) continue;
      const auto found =
          std::count_if(detected.begin(), detected.end(), [&](const auto& other) { return touches(other.value, one.value); });
      if (expected > found) one.covariance->diagonal().array() += between * between;
    }
  }

  void find_pairs(std::span<const Observation<2>> detected, double late) {
    points_.clear();
    double widest = 0;
    for (const Observation<2>& one : detected) {
      points_.push_back(one.value);
      widest = std::max(widest, one.covariance->trace());
    }
    grid_.build(points_, 1 + 2 * std::sqrt(widest));
    const double unknown = std::log1p(births() / rules_.options().clutter);  // an observation that nothing known explains
    pairs_.clear();
    for (int i = 0; i < static_cast<int>(leaves_.size()); ++i) {
      const Leaf& leaf = leaves_[i];
      if (leaf.over) continue;
      const double prior = std::log(leaf.target.presence.visible()) - unknown;
      const double radius = rules_.search_radius(leaf.target, widest) + std::abs(late) * rules_.options().max_speed;
      const auto first = static_cast<std::ptrdiff_t>(pairs_.size());
      grid_.for_each_near(leaf.target.filter.position(), radius, [&](int o) {
        if (detected[o].score < rules_.options().evidence.min_score) return;
        const auto ratio = rules_.log_ratio(leaf.target, detected[o], rules_.at_instant(leaf.target, detected[o], late), *now_);
        if (ratio) pairs_.push_back({i, o, *ratio + prior});
      });
      std::sort(pairs_.begin() + first, pairs_.end(),
                [](const assign::GatedPair& a, const assign::GatedPair& b) { return a.column < b.column; });
    }
  }

  /// No target begins with a detector's doubt, nor with its second box around one person.
  void find_beginnings(std::span<const Observation<2>> detected) {
    explained_.assign(detected.size(), 0);
    for (const assign::GatedPair& pair : pairs_) explained_[pair.column] = 1;
    begins_.assign(detected.size(), 0);
    for (std::size_t i = 0; i < detected.size(); ++i) {
      bool second = false;
      for (std::size_t j = 0; j < detected.size() && detected[i].box; ++j) {
        if (j == i || !detected[j].box || (j > i && !explained_[j])) continue;
        second = second || geometry::iou(*detected[i].box, *detected[j].box) > rules_.options().evidence.duplicate_iou;
      }
      begins_[i] = detected[i].score >= rules_.options().evidence.confident && !second;
    }
  }

  /// Cameras that disagree about a place may each have fed a tree of its own: the younger ends, in all hypotheses.
  void merge_duplicates() {
    members_.clear();
    const auto best = hypotheses_.best();
    for (const int i : best) {
      const GroundTarget& target = leaves_[i].target;
      if (!leaves_[i].over) members_.push_back({target.id, target.filter.position(), target.filter.covariance(), target.cameras});
    }
    const auto& merges = duplicates_.find(*now_, members_, rules_.options().disagreement);
    for (const auto& [kept, gone] : merges) {
      const auto with_id = [&](TrackId id) {
        return *std::find_if(best.begin(), best.end(), [&](int i) { return leaves_[i].target.id == id; });
      };
      absorb(leaves_[with_id(kept)], leaves_[with_id(gone)]);
      for (Leaf& leaf : leaves_) leaf.over = leaf.over || leaf.target.id == gone;
    }
  }

  void absorb(Leaf& into, const Leaf& leaf) {
    rules_.absorb(into.target, leaf.target);
    match_list_.clear();
    history_.for_each_match(leaf.matches, [&](int view, int observation) { match_list_.emplace_back(view, observation); });
    for (const auto& [view, observation] : match_list_) into.matches = history_.match(view, observation, into.matches);
  }

  /// A target that never was confirmed leaves nothing behind; others stay, given up, until that is decided.
  void retire_lost() {
    gone_.assign(leaves_.size(), 0);
    for (std::size_t i = 0; i < leaves_.size(); ++i) {
      Leaf& leaf = leaves_[i];
      leaf.over = leaf.over || rules_.lost(leaf.target, *now_);
      gone_[i] = leaf.over && !leaf.target.confirmed();
    }
    hypotheses_.drop(gone_);
  }

  /// Two leaves of one tree that will fare alike: they are at one place now, and a while later still.
  bool alike(Leaf& a, Leaf& b) const {
    if (a.over || b.over) return a.over == b.over;
    if (!near(a.target, b.target)) return false;
    return near(ahead_of(a), ahead_of(b));
  }

  static bool near(const GroundTarget& a, const GroundTarget& b) {
    const double spread = std::min(a.filter.covariance().trace(), b.filter.covariance().trace()) / 2;
    return (a.filter.position() - b.filter.position()).squaredNorm() <= same_sigmas * same_sigmas * spread;
  }

  const GroundTarget& ahead_of(Leaf& leaf) const {
    if (!leaf.ahead) {
      leaf.ahead = leaf.target;
      rules_.predict(*leaf.ahead, a_while);
    }
    return *leaf.ahead;
  }

  void note() {
    for (Leaf& leaf : leaves_) {
      if (!leaf.over) leaf.location = history_.note(leaf.location, rules_.report(leaf.target), leaf.matches);
    }
  }

  void decide() {
    const auto level = history_.newest_until(*now_ - duration_from_seconds(rules_.options().window));
    if (!level) return;
    past_.clear();
    for (const Leaf& leaf : leaves_) past_.push_back(history_.past(leaf.location, *level));
    hypotheses_.decide(past_);
    history_.decide(*level, positions_of_best());
    for (std::size_t i = 0; i < leaves_.size(); ++i) gone_[i] = leaves_[i].over && leaves_[i].location.level <= *level;
    hypotheses_.drop(gone_);
  }

  std::span<const GroundHistory::Location> positions_of_best() {
    locations_.clear();
    for (const int leaf : hypotheses_.best()) locations_.push_back(leaves_[leaf].location);
    return locations_;
  }

  void compact() {
    next_.clear();
    for (const int leaf : hypotheses_.compact()) next_.push_back(std::move(leaves_[leaf]));
    std::swap(leaves_, next_);
  }

  std::span<const Track<2>> report() {
    tracks_.clear();
    matches_.clear();
    for (const int i : hypotheses_.best()) {
      const Leaf& leaf = leaves_[i];
      if (leaf.over) continue;
      tracks_.push_back(rules_.report(leaf.target));
      history_.for_each_match(leaf.matches,
                              [&](int view, int observation) { matches_.push_back({leaf.target.id, view, observation}); });
    }
    return tracks_;
  }

  static constexpr double touch = 0.5;         // m: people nearer than this may be seen as one
  static constexpr double between = 0.25;      // m: how far from the middle of two each of them is then
  static constexpr double first_interval = 1;  // s: a person there at the first instant has come before
  static constexpr double same_sigmas = 0.5;
  static constexpr double a_while = 0.5;  // s

  GroundRules rules_;
  GroundVisibility visibility_;
  GroundDuplicates duplicates_;
  GroundHypotheses hypotheses_;
  GroundHistory history_;
  GroundMhtLimits limits_;
  std::optional<Timestamp> now_;
  double dt_ = 0;
  std::vector<Leaf> leaves_, next_;
  std::vector<Track<2>> tracks_;
  std::vector<ObservationMatch> matches_;
  // What an instant needs, kept so that it is allocated once.
  std::vector<double> missed_, visible_;
  std::vector<Observation<2>> detected_;  // of the view at hand, as far as each is trusted
  std::vector<assign::GatedPair> pairs_;
  std::vector<char> begins_, explained_, gone_;
  std::vector<Vector<2>> points_, known_;
  std::vector<int> past_;
  std::vector<GroundHistory::Location> locations_;
  std::vector<std::pair<int, int>> match_list_;
  std::vector<GroundDuplicates::Member> members_;
  assign::PointGrid<2> grid_;  // of observations
};

}  // namespace

std::unique_ptr<GroundTracker> make_ground_mht(const GroundTrackerOptions& options, std::shared_ptr<const GroundViews> views,
                                               const GroundMhtLimits& limits) {
  return std::make_unique<GroundMht>(options, std::move(views), limits);
}

}  // namespace marey::track::ground::mht
