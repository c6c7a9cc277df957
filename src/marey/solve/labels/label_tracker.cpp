#include "marey/solve/labels/label_tracker.h"

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

constexpr std::size_t kNoneOfThem = std::numeric_limits<std::size_t>::max();  // by definition
constexpr double kNever = -1e6;                                               // nats: no name for this track
constexpr std::size_t kMinRequested = 3;                                      // neighbours, below which nothing is said
constexpr double kMaxLack = 8;                                                // nats that one distance is off by, at most
constexpr double kStationary = 0.008;                                         // m: what varies less is rigid, and has a side
constexpr double kStationaryLearned = 0.012;  // m, of the distances learned meanwhile if a moving subject taught
constexpr double kWrongSide = 6;              // nats
constexpr std::size_t kMaxSides = 6;
constexpr std::size_t kSideNeighboursRequested = 6;
constexpr double kMinHeight = 0.012;                        // m
constexpr double kLostFloor = -6, kMaxLost = 0.15;          // nats; m, of the expected place's deviation
constexpr double kLostDeviation = 0.01, kLostDrift = 0.05;  // m, m/s
constexpr double kMaxFrames = 60;                           // that a mean remembers
constexpr double kLearnEveryS = 0.02;
constexpr int kRemembered = 1500, kOften = 50;    // instants
constexpr double kOffLearned = 4;                 // deviations: what is further off was named wrongly
constexpr double kVaried = 0.25, kVaries = 0.01;  // of all distances that vary by more, m: the subject moved its joints
constexpr double kForgottenS = 10;                // a track that is gone for this long
constexpr double kTrustedFraction = 0.5;          // of the names that are there; with fewer in no doubt, all count

}  // namespace

LabelTracker::LabelTracker(const LearnedMarkers& learned, double scale, std::span<const DistanceObserved> detected,
                           const LabelTrackerOptions& options)
    : learned_(&learned),
      options_(options),
      first_(learned, scale, options.distances),
      model_(first_),
      detected_(detected.begin(), detected.end()),
      sides_(learned.size()),
      locations_(learned.size()),
      before_(learned.size()),
      trusted_(learned.size(), 0),
      names_open_(learned.size(), 0),
      lost_(learned.size()) {
  detected_.resize(learned.distances.size());
  for (std::size_t name = 0; name < learned.size(); ++name) refine(name);
}

void LabelTracker::take(const std::map<TrackId, int>& found) {
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
    known.flagged.reset();
    known.frames = 0;
    known.sums.clear();
  }
}

std::map<TrackId, int> LabelTracker::borne() const {
  std::map<TrackId, int> names;
  for (const auto& [track, known] : known_) {
    if (known.name != kNoIndex) names[track] = known.name;
  }
  return names;
}

std::span<const int> LabelTracker::step(Timestamp now, std::span<const TrackedPoint> points) {
  find_points(now, points);
  note_lost();
  find_uncertain_names(now, points);
  if (!open_.empty()) {
    expect_lost(now);
    weigh(points);
    distribute(now);
  }
  given_.assign(points.size(), kNoIndex);
  locations_.assign(names(), std::nullopt);
  held_ = 0;
  for (std::size_t p = 0; p < points.size(); ++p) {
    given_[p] = of_point_[p]->name;
    if (given_[p] == kNoIndex) continue;
    locations_[static_cast<std::size_t>(given_[p])] = points[p].location;
    ++held_;
  }
  learn(now);
  before_ = locations_;
  before_at_ = now;
  return given_;
}

/// Whose track each point is; names by hand hold.
void LabelTracker::find_points(Timestamp now, std::span<const TrackedPoint> points) {
  of_point_.clear();
  for (const TrackedPoint& point : points) {
    Known& known = known_[point.track];
    of_point_.push_back(&known);
    known.detected = now;
    if (point.fixed != kNoIndex) {
      for (auto& [track, other] : known_) {
        if (other.name == point.fixed && track != point.track) other.name = kNoIndex;
      }
      known.name = point.fixed;
    }
  }
  std::erase_if(known_, [&](const auto& each) { return seconds(now - each.second.detected) > kForgottenS; });
  locations_.assign(names(), std::nullopt);
  for (std::size_t p = 0; p < points.size(); ++p) {
    if (of_point_[p]->name == kNoIndex) continue;
    const auto name = static_cast<std::size_t>(of_point_[p]->name);
    locations_[name] = points[p].location;
  }
}

/// Names that were there in the frame before, and are not now: with where their neighbours were.
void LabelTracker::note_lost() {
  for (std::size_t name = 0; name < names(); ++name) {
    if (locations_[name]) lost_[name].reset();
    if (locations_[name] || !before_[name]) continue;
    Lost lost;
    lost.at = before_at_;
    lost.location = *before_[name];
    for (const std::size_t other : model_.partners(name)) {
      if (!before_[other]) continue;
      lost.others[lost.count] = other;
      lost.their_positions[lost.count] = *before_[other];
      if (++lost.count == lost.others.size()) break;
    }
    lost_[name] = lost;
  }
}

/// How far the distances to the neighbours are off, in all; per neighbour that was asked.
double LabelTracker::lack(std::size_t name, const Vector<3>& location) const {
  double sum = 0;
  std::size_t requested = 0;
  for (const std::size_t other : model_.partners(name)) {
    if (!locations_[other]) continue;
    const double off = ((*locations_[other] - location).norm() - model_.mean(name, other)) / model_.deviation(name, other);
    sum += std::min(off * off / 2, kMaxLack);
    if (++requested == options_.neighbours) break;
  }
  if (requested < kMinRequested) return 0;
  return (sum + side_cost(name, location, name)) / static_cast<double>(requested);
}

/// What is open: tracks without a name, and those uncertain. An uncertain track is not evidence of others.
void LabelTracker::find_uncertain_names(Timestamp now, std::span<const TrackedPoint> points) {
  open_.clear();
  std::size_t there = 0, sure = 0;
  for (std::size_t name = 0; name < names(); ++name) names_open_[name] = !locations_[name], trusted_[name] = 0;
  for (std::size_t p = 0; p < points.size(); ++p) {
    Known& known = *of_point_[p];
    if (known.name == kNoIndex) {
      if (known.sums.empty()) known.start(names());
      known.flagged.reset();
      open_.push_back(p);
      continue;
    }
    ++there;
    const auto name = static_cast<std::size_t>(known.name);
    const bool flagged = points[p].fixed == kNoIndex && lack(name, points[p].location) > options_.max_lack;
    if (!flagged) {
      known.flagged.reset();
      known.sums.clear();
      trusted_[name] = 1;
      ++sure;
      continue;
    }
    if (!known.flagged) known.flagged = now, known.start(names());
    names_open_[name] = 1;
    open_.push_back(p);
  }
  if (static_cast<double>(sure) < kTrustedFraction * static_cast<double>(there)) {
    for (std::size_t name = 0; name < names(); ++name) trusted_[name] = locations_[name].has_value();
  }
}

void LabelTracker::expect_lost(Timestamp now) {
  for (std::size_t name = 0; name < names(); ++name) {
    if (!lost_[name]) continue;
    Lost& lost = *lost_[name];
    std::vector<Vector<3>> from, to;
    double deviation = 0;
    for (std::size_t i = 0; i < lost.count; ++i) {
      if (!trusted_[lost.others[i]] || (from.size() >= kMinRequested && model_.deviation(name, lost.others[i]) > 2 * kStationary))
        continue;
      from.push_back(lost.their_positions[i]);
      to.push_back(*locations_[lost.others[i]]);
      deviation += model_.deviation(name, lost.others[i]);
    }
    lost.expected.reset();
    if (from.size() < kMinRequested) continue;
    lost.expected = geometry::rigid_fit(from, to) * lost.location;
    lost.deviation = std::min(
        std::hypot(deviation / static_cast<double>(from.size()), kLostDeviation) + kLostDrift * seconds(now - lost.at), kMaxLost);
  }
}

/// By how much the likelier a point there has the name that was lost than any point of a cubic metre.
double LabelTracker::lost_gain(std::size_t name, const Vector<3>& location) const {
  if (!lost_[name] || !lost_[name]->expected) return 0;
  const double deviation = lost_[name]->deviation, squares = (location - *lost_[name]->expected).squaredNorm();
  const double top = -1.5 * std::log(2 * std::numbers::pi * deviation * deviation);
  return std::max(top - squares / (2 * deviation * deviation), kLostFloor);
}

double LabelTracker::side_cost(std::size_t name, const Vector<3>& location, std::size_t self) const {
  double cost = 0;
  for (const Side& side : sides_[name]) {
    const auto is_there = [&](std::size_t other) {
      return other != self && locations_[other] && (self == name || trusted_[other]);
    };
    if (!std::all_of(side.others.begin(), side.others.end(), is_there)) continue;
    const double height =
        signed_height({location, *locations_[side.others[0]], *locations_[side.others[1]], *locations_[side.others[2]]});
    if (height * side.height < 0 && std::abs(height) > 0.5 * std::abs(side.height) &&
        std::abs(height) < 2.5 * std::abs(side.height))
      cost += kWrongSide;
  }
  return std::min(cost, 3 * kWrongSide);
}

/// `self`: the name that the point has, whose place is its own.
double LabelTracker::fit(std::size_t name, const Vector<3>& location, std::size_t self) const {
  double sum = 0;
  std::size_t requested = 0;
  for (const std::size_t other : model_.partners(name)) {
    if (!trusted_[other] || other == self) continue;
    sum += model_.ratio(name, other, DistanceObserved{(*locations_[other] - location).norm(), 0, 1});
    if (++requested == options_.neighbours) break;
  }
  if (requested < kMinRequested) return kNever;
  return sum - side_cost(name, location, self) + lost_gain(name, location);
}

void LabelTracker::weigh(std::span<const TrackedPoint> points) {
  weights_.resize(std::max(weights_.size(), open_.size()));
  for (std::size_t i = 0; i < open_.size(); ++i) {
    Known& known = *of_point_[open_[i]];
    const std::size_t self = known.name == kNoIndex ? kNoneOfThem : static_cast<std::size_t>(known.name);
    std::vector<double>& its = weights_[i];
    its.assign(names(), kNever);
    if (known.frames >= kMaxFrames) {
      known.frames /= 2;
      for (double& sum : known.sums) sum /= 2;
    }
    ++known.frames;
    for (std::size_t name = 0; name < names(); ++name) {
      if (!names_open_[name]) {
        known.sums[name] = kNever;  // it was another's while this one was there already
        continue;
      }
      const double now = fit(name, points[open_[i]].location, self);
      known.sums[name] = known.sums[name] <= kNever ? now * known.frames : known.sums[name] + now;
      its[name] = known.sums[name] / known.frames;
    }
  }
}

/// By how much the open track's name is better than what else could be.
double LabelTracker::margin(std::size_t open, std::size_t name) const {
  const double own = weights_[open][name];
  double minimum = own;
  for (std::size_t j = 0; j < open_.size(); ++j) {
    if (j == open) continue;
    const int its = shared_[j];
    if (its == kNoIndex) {
      minimum = std::min(minimum, own - weights_[j][name]);
    } else {  // they could exchange
      const auto other = static_cast<std::size_t>(its);
      minimum = std::min(minimum, own - weights_[open][other] + weights_[j][other] - std::max(weights_[j][name], 0.0));
    }
  }
  for (std::size_t other = 0; other < names(); ++other) {
    if (other == name || !names_open_[other]) continue;
    const bool is_shared = std::find(shared_.begin(), shared_.end(), static_cast<int>(other)) != shared_.end();
    if (!is_shared) minimum = std::min(minimum, own - weights_[open][other]);
  }
  return minimum;
}

void LabelTracker::distribute(Timestamp now) {
  pairs_.clear();
  for (std::size_t i = 0; i < open_.size(); ++i) {
    for (std::size_t name = 0; name < names(); ++name) {
      if (weights_[i][name] > options_.min_fit / 2)
        pairs_.push_back({static_cast<int>(i), static_cast<int>(name), weights_[i][name]});
    }
  }
  const auto shared = assigner_.assign(static_cast<int>(open_.size()), static_cast<int>(names()), pairs_);
  shared_.assign(shared.begin(), shared.end());
  std::vector<int> decided(open_.size(), kNoIndex);
  for (std::size_t i = 0; i < open_.size(); ++i) {
    if (shared_[i] == kNoIndex) continue;
    const auto name = static_cast<std::size_t>(shared_[i]);
    const double required = options_.min_margin * (1 + options_.first_margin / of_point_[open_[i]]->frames);
    if (weights_[i][name] >= options_.min_fit && margin(i, name) >= required) decided[i] = shared_[i];
  }
  for (std::size_t i = 0; i < open_.size(); ++i) {  // who is open no more first, so that no name is borne twice
    Known& known = *of_point_[open_[i]];
    if (known.name == kNoIndex || decided[i] == known.name) continue;
    const bool to_other = std::find(decided.begin(), decided.end(), known.name) != decided.end();
    const bool unfit = known.flagged && seconds(now - *known.flagged) >= options_.taken_after_s &&
                       weights_[i][static_cast<std::size_t>(known.name)] < options_.min_fit;
    if (to_other || unfit || decided[i] != kNoIndex) known.name = kNoIndex;
  }
  for (std::size_t i = 0; i < open_.size(); ++i) {
    if (decided[i] != kNoIndex) give(open_[i], decided[i]);
  }
}

void LabelTracker::give(std::size_t point, int name) {
  Known& bearer = *of_point_[point];
  if (bearer.name == name) return;
  for (auto& [track, known] : known_) {  // the track that had it before is not there
    if (known.name == name) known.name = kNoIndex;
  }
  bearer.name = name;
  bearer.flagged.reset();
  bearer.frames = 0;
  bearer.sums.clear();
}

/// Distances of names in no doubt; of one name a frame the model is brought up to them.
void LabelTracker::learn(Timestamp now) {
  refine(refined_);
  refined_ = (refined_ + 1) % names();
  if (learned_at_ && seconds(now - *learned_at_) < kLearnEveryS) return;
  learned_at_ = now;
  for (std::size_t a = 1; a < names(); ++a) {
    if (!locations_[a] || !trusted_[a]) continue;
    for (std::size_t b = 0; b < a; ++b) {
      if (!locations_[b] || !trusted_[b]) continue;
      const double distance = (*locations_[a] - *locations_[b]).norm();
      DistanceObserved& pair = detected_[LearnedMarkers::index_of(a, b)];
      pair.count = std::min(pair.count + 1, kRemembered);
      const double fraction = 1.0 / pair.count, off = distance - pair.mean;
      pair.mean += fraction * off;
      pair.variance += fraction * ((1 - fraction) * off * off - pair.variance);
    }
  }
}

bool LabelTracker::posture_varied() const {
  std::size_t known = 0, varied = 0;
  for (const DistanceObserved& pair : detected_) {
    if (pair.count < kOften) continue;
    ++known;
    varied += pair.variance > kVaries * kVaries;
  }
  return static_cast<double>(varied) > kVaried * static_cast<double>(known);
}

void LabelTracker::refine(std::size_t name) {
  const bool varied = learned_->moves || posture_varied();
  for (std::size_t other = 0; other < names() && varied; ++other) {
    if (other == name) continue;
    const DistanceObserved& pair = detected_[LearnedMarkers::index_of(name, other)];
    if (pair.count < kOften || std::abs(pair.mean - first_.mean(name, other)) > kOffLearned * first_.deviation(name, other))
      continue;
    if (learned_->moves && first_.deviation(name, other) > kStationaryLearned) continue;  // it may vary more than it did here
    DistanceObserved widened = pair;
    if (pair.variance > kVaries * kVaries) widened.variance *= 4;
    model_.adopt(name, other, widened);
  }
  model_.rank_partners(name);
  find_sides(name);
}

void LabelTracker::find_sides(std::size_t name) {
  sides_[name].clear();
  const auto& locations = learned_->locations;
  const auto has_position = [&](std::size_t each) { return !locations[each].isZero(0); };
  if (!has_position(name)) return;
  std::array<std::size_t, kSideNeighboursRequested> near{};
  std::size_t count = 0;
  for (const std::size_t other : model_.partners(name)) {
    if (count == near.size() || model_.deviation(name, other) > kStationary) break;
    if (has_position(other)) near[count++] = other;
  }
  for (std::size_t i = 2; i < count; ++i) {
    for (std::size_t j = 1; j < i; ++j) {
      for (std::size_t k = 0; k < j; ++k) {
        if (model_.deviation(near[i], near[j]) > kStationary || model_.deviation(near[i], near[k]) > kStationary ||
            model_.deviation(near[j], near[k]) > kStationary)
          continue;
        const double height = signed_height({locations[name], locations[near[i]], locations[near[j]], locations[near[k]]});
        if (std::abs(height) < kMinHeight || sides_[name].size() == kMaxSides) continue;
        sides_[name].push_back({{near[i], near[j], near[k]}, height});
      }
    }
  }
}

}  // namespace marey::solve::labels
