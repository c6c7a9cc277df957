#include "marey/solve/labels/label_follower.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "marey/assign/no_index.h"
#include "marey/geometry/layout.h"
#include "marey/solve/labels/four_points.h"

namespace marey::solve::labels {
namespace {

using assign::kNoIndex;

constexpr std::size_t kNoneOfThem = std::numeric_limits<std::size_t>::max();
constexpr double kNever = -1e6;           // nats: no name for this track
constexpr std::size_t kFewestAsked = 3;   // neighbours, below which nothing is said
constexpr double kMostLack = 8;           // nats that one distance is off by, at most
constexpr double kSteady = 0.008;         // m: what varies less is rigid, and has a side
constexpr double kSteadyLearned = 0.012;  // m, of what is learned on the way where a moving subject taught
constexpr double kWrongSide = 6;          // nats
constexpr std::size_t kMostSides = 6;
constexpr std::size_t kSideNeighboursAsked = 6;
constexpr double kLeastHeight = 0.012;                      // m
constexpr double kLostFloor = -6, kLostMost = 0.15;         // nats; m, of the expected place's deviation
constexpr double kLostDeviation = 0.01, kLostDrift = 0.05;  // m, m/s
constexpr double kMostFrames = 60;                          // that a mean remembers
constexpr double kLearnEveryS = 0.02;
constexpr int kRemembered = 1500, kOften = 50;    // instants
constexpr double kOffLearned = 4;                 // deviations: what is further off was named wrongly
constexpr double kVaried = 0.25, kVaries = 0.01;  // of all distances that vary by more, m: the subject moved its joints
constexpr double kForgottenS = 10;                // a track that is gone for so long
constexpr double kTrustedShare = 0.5;             // of the names that are there; with fewer in no doubt, all count

}  // namespace

LabelFollower::LabelFollower(const LearnedMarkers& learned, double scale, std::span<const DistanceSeen> seen,
                             const LabelFollowOptions& options)
    : learned_(&learned),
      options_(options),
      first_(learned, scale, options.distances),
      model_(first_),
      seen_(seen.begin(), seen.end()),
      sides_(learned.size()),
      places_(learned.size()),
      before_(learned.size()),
      trusted_(learned.size(), 0),
      names_open_(learned.size(), 0),
      lost_(learned.size()) {
  seen_.resize(learned.distances.size());
  for (std::size_t name = 0; name < learned.size(); ++name) refine(name);
}

void LabelFollower::take(const std::map<TrackId, int>& found) {
  std::vector<char> taken(names(), 0);
  for (const auto& [track, name] : found) {
    if (name != kNoIndex) taken[static_cast<std::size_t>(name)] = 1;
  }
  for (auto& [track, known] : known_) {
    if (known.name != kNoIndex && taken[static_cast<std::size_t>(known.name)]) known.name = kNoIndex;
  }
  for (const auto& [track, name] : found) {
    if (name == kNoIndex) continue;
    Known& known = known_[track];
    known.name = name;
    known.doubted.reset();
    known.frames = 0;
    known.sums.clear();
  }
}

std::map<TrackId, int> LabelFollower::borne() const {
  std::map<TrackId, int> names;
  for (const auto& [track, known] : known_) {
    if (known.name != kNoIndex) names[track] = known.name;
  }
  return names;
}

std::span<const int> LabelFollower::step(Timestamp now, std::span<const TrackedPoint> points) {
  find_points(now, points);
  note_lost();
  find_doubts(now, points);
  if (!open_.empty()) {
    expect_lost(now);
    weigh(points);
    share_out(now);
  }
  given_.assign(points.size(), kNoIndex);
  places_.assign(names(), std::nullopt);
  held_ = 0;
  for (std::size_t p = 0; p < points.size(); ++p) {
    given_[p] = of_point_[p]->name;
    if (given_[p] == kNoIndex) continue;
    places_[static_cast<std::size_t>(given_[p])] = points[p].place;
    ++held_;
  }
  learn(now);
  before_ = places_;
  before_at_ = now;
  return given_;
}

/// Whose track each point is; names by hand hold.
void LabelFollower::find_points(Timestamp now, std::span<const TrackedPoint> points) {
  of_point_.clear();
  for (const TrackedPoint& point : points) {
    Known& known = known_[point.track];
    of_point_.push_back(&known);
    known.seen = now;
    if (point.fixed != kNoIndex) {
      for (auto& [track, other] : known_) {
        if (other.name == point.fixed && track != point.track) other.name = kNoIndex;
      }
      known.name = point.fixed;
    }
  }
  std::erase_if(known_, [&](const auto& each) { return seconds(now - each.second.seen) > kForgottenS; });
  places_.assign(names(), std::nullopt);
  for (std::size_t p = 0; p < points.size(); ++p) {
    if (of_point_[p]->name == kNoIndex) continue;
    const auto name = static_cast<std::size_t>(of_point_[p]->name);
    places_[name] = points[p].place;
  }
}

/// Names that were there in the frame before, and are not now: with where their neighbours were.
void LabelFollower::note_lost() {
  for (std::size_t name = 0; name < names(); ++name) {
    if (places_[name]) lost_[name].reset();
    if (places_[name] || !before_[name]) continue;
    Lost lost;
    lost.at = before_at_;
    lost.place = *before_[name];
    for (const std::size_t other : model_.partners(name)) {
      if (!before_[other]) continue;
      lost.others[lost.count] = other;
      lost.their_places[lost.count] = *before_[other];
      if (++lost.count == lost.others.size()) break;
    }
    lost_[name] = lost;
  }
}

/// How far the distances to the neighbours are off, in all; per neighbour that was asked.
double LabelFollower::lack(std::size_t name, const Vector<3>& place) const {
  double sum = 0;
  std::size_t asked = 0;
  for (const std::size_t other : model_.partners(name)) {
    if (!places_[other]) continue;
    const double off = ((*places_[other] - place).norm() - model_.mean(name, other)) / model_.deviation(name, other);
    sum += std::min(off * off / 2, kMostLack);
    if (++asked == options_.neighbours) break;
  }
  if (asked < kFewestAsked) return 0;
  return (sum + side_cost(name, place, name)) / static_cast<double>(asked);
}

/// What is open: tracks without a name, and those in doubt. Who is in doubt says nothing of others.
void LabelFollower::find_doubts(Timestamp now, std::span<const TrackedPoint> points) {
  open_.clear();
  std::size_t there = 0, sure = 0;
  for (std::size_t name = 0; name < names(); ++name) names_open_[name] = !places_[name], trusted_[name] = 0;
  for (std::size_t p = 0; p < points.size(); ++p) {
    Known& known = *of_point_[p];
    if (known.name == kNoIndex) {
      if (known.sums.empty()) known.start(names());
      known.doubted.reset();
      open_.push_back(p);
      continue;
    }
    ++there;
    const auto name = static_cast<std::size_t>(known.name);
    const bool doubted = points[p].fixed == kNoIndex && lack(name, points[p].place) > options_.doubt;
    if (!doubted) {
      known.doubted.reset();
      known.sums.clear();
      trusted_[name] = 1;
      ++sure;
      continue;
    }
    if (!known.doubted) known.doubted = now, known.start(names());
    names_open_[name] = 1;
    open_.push_back(p);
  }
  if (static_cast<double>(sure) < kTrustedShare * static_cast<double>(there)) {
    for (std::size_t name = 0; name < names(); ++name) trusted_[name] = places_[name].has_value();
  }
}

void LabelFollower::expect_lost(Timestamp now) {
  for (std::size_t name = 0; name < names(); ++name) {
    if (!lost_[name]) continue;
    Lost& lost = *lost_[name];
    std::vector<Vector<3>> from, to;
    double deviation = 0;
    for (std::size_t i = 0; i < lost.count; ++i) {
      if (!trusted_[lost.others[i]] || (from.size() >= kFewestAsked && model_.deviation(name, lost.others[i]) > 2 * kSteady))
        continue;
      from.push_back(lost.their_places[i]);
      to.push_back(*places_[lost.others[i]]);
      deviation += model_.deviation(name, lost.others[i]);
    }
    lost.expected.reset();
    if (from.size() < kFewestAsked) continue;
    lost.expected = geometry::rigid_fit(from, to) * lost.place;
    lost.deviation = std::min(
        std::hypot(deviation / static_cast<double>(from.size()), kLostDeviation) + kLostDrift * seconds(now - lost.at), kLostMost);
  }
}

/// By how much the likelier a point there bears the name that was lost than any point of a cubic metre.
double LabelFollower::lost_gain(std::size_t name, const Vector<3>& place) const {
  if (!lost_[name] || !lost_[name]->expected) return 0;
  const double deviation = lost_[name]->deviation, squares = (place - *lost_[name]->expected).squaredNorm();
  const double top = -1.5 * std::log(2 * std::numbers::pi * deviation * deviation);
  return std::max(top - squares / (2 * deviation * deviation), kLostFloor);
}

double LabelFollower::side_cost(std::size_t name, const Vector<3>& place, std::size_t self) const {
  double cost = 0;
  for (const Side& side : sides_[name]) {
    const auto is_there = [&](std::size_t other) { return other != self && places_[other] && (self == name || trusted_[other]); };
    if (!std::all_of(side.others.begin(), side.others.end(), is_there)) continue;
    const double height = signed_height({place, *places_[side.others[0]], *places_[side.others[1]], *places_[side.others[2]]});
    if (height * side.height < 0 && std::abs(height) > 0.5 * std::abs(side.height) &&
        std::abs(height) < 2.5 * std::abs(side.height))
      cost += kWrongSide;
  }
  return std::min(cost, 3 * kWrongSide);
}

/// `self`: the name that the point bears, whose place is its own.
double LabelFollower::fit(std::size_t name, const Vector<3>& place, std::size_t self) const {
  double sum = 0;
  std::size_t asked = 0;
  for (const std::size_t other : model_.partners(name)) {
    if (!trusted_[other] || other == self) continue;
    sum += model_.ratio(name, other, DistanceSeen{(*places_[other] - place).norm(), 0, 1});
    if (++asked == options_.neighbours) break;
  }
  if (asked < kFewestAsked) return kNever;
  return sum - side_cost(name, place, self) + lost_gain(name, place);
}

void LabelFollower::weigh(std::span<const TrackedPoint> points) {
  weights_.resize(std::max(weights_.size(), open_.size()));
  for (std::size_t i = 0; i < open_.size(); ++i) {
    Known& known = *of_point_[open_[i]];
    const std::size_t self = known.name == kNoIndex ? kNoneOfThem : static_cast<std::size_t>(known.name);
    std::vector<double>& its = weights_[i];
    its.assign(names(), kNever);
    if (known.frames >= kMostFrames) {
      known.frames /= 2;
      for (double& sum : known.sums) sum /= 2;
    }
    ++known.frames;
    for (std::size_t name = 0; name < names(); ++name) {
      if (!names_open_[name]) {
        known.sums[name] = kNever;  // it was another's while this one was there already
        continue;
      }
      const double now = fit(name, points[open_[i]].place, self);
      known.sums[name] = known.sums[name] <= kNever ? now * known.frames : known.sums[name] + now;
      its[name] = known.sums[name] / known.frames;
    }
  }
}

/// By how much the open track's name is better than what else could be.
double LabelFollower::margin(std::size_t open, std::size_t name) const {
  const double own = weights_[open][name];
  double least = own;
  for (std::size_t j = 0; j < open_.size(); ++j) {
    if (j == open) continue;
    const int its = shared_[j];
    if (its == kNoIndex) {
      least = std::min(least, own - weights_[j][name]);
    } else {  // they could exchange
      const auto other = static_cast<std::size_t>(its);
      least = std::min(least, own - weights_[open][other] + weights_[j][other] - std::max(weights_[j][name], 0.0));
    }
  }
  for (std::size_t other = 0; other < names(); ++other) {
    if (other == name || !names_open_[other]) continue;
    const bool is_shared = std::find(shared_.begin(), shared_.end(), static_cast<int>(other)) != shared_.end();
    if (!is_shared) least = std::min(least, own - weights_[open][other]);
  }
  return least;
}

void LabelFollower::share_out(Timestamp now) {
  pairs_.clear();
  for (std::size_t i = 0; i < open_.size(); ++i) {
    for (std::size_t name = 0; name < names(); ++name) {
      if (weights_[i][name] > options_.least_fit / 2)
        pairs_.push_back({static_cast<int>(i), static_cast<int>(name), weights_[i][name]});
    }
  }
  const auto shared = assigner_.assign(static_cast<int>(open_.size()), static_cast<int>(names()), pairs_);
  shared_.assign(shared.begin(), shared.end());
  std::vector<int> decided(open_.size(), kNoIndex);
  for (std::size_t i = 0; i < open_.size(); ++i) {
    if (shared_[i] == kNoIndex) continue;
    const auto name = static_cast<std::size_t>(shared_[i]);
    const double wanted = options_.least_margin * (1 + options_.first_margin / of_point_[open_[i]]->frames);
    if (weights_[i][name] >= options_.least_fit && margin(i, name) >= wanted) decided[i] = shared_[i];
  }
  for (std::size_t i = 0; i < open_.size(); ++i) {  // who is open no more first, so that no name is borne twice
    Known& known = *of_point_[open_[i]];
    if (known.name == kNoIndex || decided[i] == known.name) continue;
    const bool to_other = std::find(decided.begin(), decided.end(), known.name) != decided.end();
    const bool unfit = known.doubted && seconds(now - *known.doubted) >= options_.taken_after_s &&
                       weights_[i][static_cast<std::size_t>(known.name)] < options_.least_fit;
    if (to_other || unfit || decided[i] != kNoIndex) known.name = kNoIndex;
  }
  for (std::size_t i = 0; i < open_.size(); ++i) {
    if (decided[i] != kNoIndex) give(open_[i], decided[i]);
  }
}

void LabelFollower::give(std::size_t point, int name) {
  Known& bearer = *of_point_[point];
  if (bearer.name == name) return;
  for (auto& [track, known] : known_) {  // who bore it before is not there
    if (known.name == name) known.name = kNoIndex;
  }
  bearer.name = name;
  bearer.doubted.reset();
  bearer.frames = 0;
  bearer.sums.clear();
}

/// Distances of names in no doubt; of one name a frame the model is brought up to them.
void LabelFollower::learn(Timestamp now) {
  refine(refined_);
  refined_ = (refined_ + 1) % names();
  if (learned_at_ && seconds(now - *learned_at_) < kLearnEveryS) return;
  learned_at_ = now;
  for (std::size_t a = 1; a < names(); ++a) {
    if (!places_[a] || !trusted_[a]) continue;
    for (std::size_t b = 0; b < a; ++b) {
      if (!places_[b] || !trusted_[b]) continue;
      const double distance = (*places_[a] - *places_[b]).norm();
      DistanceSeen& pair = seen_[LearnedMarkers::index_of(a, b)];
      pair.count = std::min(pair.count + 1, kRemembered);
      const double share = 1.0 / pair.count, off = distance - pair.mean;
      pair.mean += share * off;
      pair.variance += share * ((1 - share) * off * off - pair.variance);
    }
  }
}

bool LabelFollower::posture_varied() const {
  std::size_t known = 0, varied = 0;
  for (const DistanceSeen& pair : seen_) {
    if (pair.count < kOften) continue;
    ++known;
    varied += pair.variance > kVaries * kVaries;
  }
  return static_cast<double>(varied) > kVaried * static_cast<double>(known);
}

void LabelFollower::refine(std::size_t name) {
  const bool varied = learned_->moves || posture_varied();
  for (std::size_t other = 0; other < names() && varied; ++other) {
    if (other == name) continue;
    const DistanceSeen& pair = seen_[LearnedMarkers::index_of(name, other)];
    if (pair.count < kOften || std::abs(pair.mean - first_.mean(name, other)) > kOffLearned * first_.deviation(name, other))
      continue;
    if (learned_->moves && first_.deviation(name, other) > kSteadyLearned) continue;  // it may vary more than it did here
    DistanceSeen widened = pair;
    if (pair.variance > kVaries * kVaries) widened.variance *= 4;
    model_.adopt(name, other, widened);
  }
  model_.rank_partners(name);
  find_sides(name);
}

void LabelFollower::find_sides(std::size_t name) {
  sides_[name].clear();
  const auto& places = learned_->places;
  const auto has_place = [&](std::size_t each) { return !places[each].isZero(0); };
  if (!has_place(name)) return;
  std::array<std::size_t, kSideNeighboursAsked> near{};
  std::size_t count = 0;
  for (const std::size_t other : model_.partners(name)) {
    if (count == near.size() || model_.deviation(name, other) > kSteady) break;
    if (has_place(other)) near[count++] = other;
  }
  for (std::size_t i = 2; i < count; ++i) {
    for (std::size_t j = 1; j < i; ++j) {
      for (std::size_t k = 0; k < j; ++k) {
        if (model_.deviation(near[i], near[j]) > kSteady || model_.deviation(near[i], near[k]) > kSteady ||
            model_.deviation(near[j], near[k]) > kSteady)
          continue;
        const double height = signed_height({places[name], places[near[i]], places[near[j]], places[near[k]]});
        if (std::abs(height) < kLeastHeight || sides_[name].size() == kMostSides) continue;
        sides_[name].push_back({{near[i], near[j], near[k]}, height});
      }
    }
  }
}

}  // namespace marey::solve::labels
