#include "marey/track/roster/rigid_neighbours.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <Eigen/LU>

#include "marey/geometry/decompositions.h"
#include "marey/geometry/median.h"

namespace marey::track::roster {
namespace {

constexpr std::size_t kMaxMembers = 600;   // 180,000 pairs
constexpr std::size_t kFraction = 2;       // frames in which every pair is learned from once
constexpr int kMemory = 1000;              // samples that a mean is taken over
constexpr int kEnough = 8;                 // samples from which a spread is trusted
constexpr int kEnoughToName = 12;          // samples, and
constexpr double kLongEnoughToName = 0.5;  // s, from which its neighbours identify a marker
constexpr double kOpening = 0.01;          // m, of spread that a distance may yet show after a second, fading with time
constexpr double kMinSpread = 0.001;       // m
constexpr double kStationary = 0.05;       // m; markers whose distance varies by more say nothing of each other
constexpr std::size_t kMinNeighbours = 3;  // by definition: three distances determine a position
constexpr std::size_t kMinToName = 4;      // that identify a marker
constexpr double kMaxAgree = 0.7;          // of the neighbours must agree: the others may be mistaken themselves
constexpr std::size_t kRanked = 14;        // neighbours that are asked whether a place is a marker's; those that are seen count
constexpr std::size_t kRequested = 9;
constexpr int kMinTogetherEver = 12;   // samples of both seen, of numbers that may be one marker's
constexpr double kWellKnown = 1.5;     // s of one of them with a third, from which it is known whether both are on one bone
constexpr double kRigid = 0.02;        // m, of spread that such a distance may have
constexpr std::size_t kThirds = 4;     // on one bone with both, at least
constexpr double kUnobserved = 0.012;  // m, of spread that a distance may yet show after a second, fading with time
constexpr double kAmbiguity = 0.004;   // m, added to every spread: poses that were not seen yet

}  // namespace

std::optional<int> RigidNeighbours::enrol() {
  if (!free_.empty()) {
    const int number = free_.back();
    free_.pop_back();
    return number;
  }
  if (members_.size() >= kMaxMembers) return std::nullopt;
  members_.emplace_back();
  last_positions_.resize(members_.size());
  last_observed_.resize(members_.size(), 0);
  distances_.resize(members_.size() * (members_.size() - 1) / 2);
  return static_cast<int>(members_.size()) - 1;
}

void RigidNeighbours::begin_frame() {
  for (std::size_t i = 0; i < members_.size(); ++i) {
    Member& member = members_[i];
    last_positions_[i] = member.position;
    last_observed_[i] = member.detected;
    member.was_observed = member.detected;
    member.detected = false;
  }
}

void RigidNeighbours::observe_frame(int number, const Vector<3>& position) {
  members_[static_cast<std::size_t>(number)].position = position;
  members_[static_cast<std::size_t>(number)].detected = true;
}

void RigidNeighbours::end_frame(double dt) {
  ++frames_;
  if (dt > 0) sample_s_ = kFraction * dt;
  for (Member& member : members_) {
    if (member.was_observed && !member.detected) keep_positions(member);
  }
  for (std::size_t row = frames_ % kFraction; row < members_.size(); row += kFraction) learn(static_cast<int>(row));
  if (!members_.empty()) rank(static_cast<int>(frames_ % members_.size()));
}

void RigidNeighbours::rank(int number) {
  std::vector<int>& list = members_[static_cast<std::size_t>(number)].steadiest;
  list.clear();
  for (int i = 0; i < static_cast<int>(members_.size()); ++i) {
    if (i == number) continue;
    const Distance& distance = between(number, i);
    if (distance.count < kEnoughToName || observed_together(distance) < kLongEnoughToName) continue;
    if (distance.variance < kStationary * kStationary) list.push_back(i);
  }
  const std::size_t kept = std::min(kRanked, list.size());
  const auto spread = [&](int i) {
    const Distance& distance = between(number, i);
    return distance.variance + unknown(distance, kUnobserved);
  };
  std::partial_sort(list.begin(), list.begin() + static_cast<std::ptrdiff_t>(kept), list.end(), [&](int a, int b) {
    const double p = spread(a), q = spread(b);
    return p != q ? p < q : a < b;
  });
  list.resize(kept);
}

/// Variance, m², by which a distance may yet differ from all that was seen of it: no person takes all poses in a short time.
double RigidNeighbours::unknown(const Distance& distance, double after_a_second) const {
  const double m = after_a_second / observed_together(distance);
  return m * m;
}

std::optional<double> RigidNeighbours::misfit(int number, const Vector<3>& location) const {
  std::array<double, kRequested> off;
  std::size_t requested = 0;
  for (const int i : members_[static_cast<std::size_t>(number)].steadiest) {
    const Member& other = members_[static_cast<std::size_t>(i)];
    if (!other.detected) continue;
    const Distance& distance = between(number, i);
    const double change = (location - other.position).norm() - distance.mean;
    off[requested++] = change * change / (distance.variance + kAmbiguity * kAmbiguity + unknown(distance, kUnobserved));
    if (requested == kRequested) break;
  }
  if (requested < kMinToName) return std::nullopt;
  const auto maximum = off.begin() + static_cast<std::ptrdiff_t>(kMaxAgree * static_cast<double>(requested));
  std::nth_element(off.begin(), maximum, off.begin() + static_cast<std::ptrdiff_t>(requested));
  return *maximum;
}

std::optional<double> RigidNeighbours::difference(int a, int b) const {
  if (between(a, b).count >= kMinTogetherEver) return std::nullopt;
  std::array<std::pair<double, double>, kRequested> thirds;  // spread and misfit, the steadiest first
  std::size_t requested = 0;
  for (int i = 0; i < static_cast<int>(members_.size()); ++i) {
    if (i == a || i == b) continue;
    const Distance &p = between(a, i), &q = between(b, i);
    if (std::min(p.count, q.count) < kEnoughToName || std::max(observed_together(p), observed_together(q)) < kWellKnown) continue;
    const double spread = p.variance + q.variance;
    if (spread > kRigid * kRigid || (requested == kRequested && spread >= thirds.back().first)) continue;
    const double off = p.mean - q.mean;
    if (requested < kRequested) ++requested;
    std::size_t location = requested - 1;
    for (; location > 0 && thirds[location - 1].first > spread; --location) thirds[location] = thirds[location - 1];
    thirds[location] = {spread, off * off / (spread + 2 * kAmbiguity * kAmbiguity)};
  }
  if (requested < kThirds) return std::nullopt;
  const auto less = [](const auto& p, const auto& q) { return p.second < q.second; };
  return geometry::median(std::span(thirds).first(requested), less).second;
}

void RigidNeighbours::merge(int number, int other) {
  for (int i = 0; i < static_cast<int>(members_.size()); ++i) {
    if (i == number || i == other) continue;
    const Distance& from = between(number, i);
    Distance& to = between(other, i);
    const int count = from.count + to.count;
    if (count == 0) continue;
    const float fraction = static_cast<float>(from.count) / static_cast<float>(count), off = from.mean - to.mean;
    to.variance += fraction * (from.variance - to.variance) + fraction * (1 - fraction) * off * off;
    to.mean += fraction * off;
    to.count = std::min(count, kMemory);
  }
  rank(other);
  release(number);
}

void RigidNeighbours::release(int number) {
  for (int i = 0; i < static_cast<int>(members_.size()); ++i) {
    if (i != number) between(number, i) = {};
  }
  members_[static_cast<std::size_t>(number)] = {};
  last_observed_[static_cast<std::size_t>(number)] = 0;
  for (Member& member : members_) {
    std::erase(member.steadiest, number);
    if (static_cast<std::size_t>(number) < member.known.size()) member.known[static_cast<std::size_t>(number)] = 0;
  }
  free_.push_back(number);
}

void RigidNeighbours::disown(int number) {
  Member& member = members_[static_cast<std::size_t>(number)];
  member.detected = member.was_observed = false;
  member.locations.clear();
  member.known.clear();
}

void RigidNeighbours::learn(int row) {
  const Member& one = members_[static_cast<std::size_t>(row)];
  if (!one.detected) return;
  for (int i = 0; i < row; ++i) {
    const Member& other = members_[static_cast<std::size_t>(i)];
    if (!other.detected) continue;
    Distance& distance = between(row, i);
    const double here = (one.position - other.position).norm();
    const double off = here - distance.mean;
    distance.count = std::min(distance.count + 1, kMemory);
    const double fraction = 1.0 / distance.count;
    distance.mean += static_cast<float>(fraction * off);
    distance.variance = static_cast<float>((1 - fraction) * (distance.variance + fraction * off * off));
  }
}

/// The frame before this one was the last that saw it.
void RigidNeighbours::keep_positions(Member& member) const {
  member.locations = last_positions_;
  member.known = last_observed_;
}

std::optional<RigidNeighbours::Location> RigidNeighbours::position_of(int number) const {
  const Member& hidden = members_[static_cast<std::size_t>(number)];
  if (hidden.locations.empty()) return std::nullopt;
  Vector<3> from = Vector<3>::Zero(), to = Vector<3>::Zero();
  Matrix<3> time_step = Matrix<3>::Zero();
  double total = 0, spread = 0;
  std::size_t neighbours = 0;
  // Sums about the first neighbour's places, so that no digits are lost.
  Vector<3> from_origin = Vector<3>::Zero(), to_origin = Vector<3>::Zero();
  for (int i = 0; i < static_cast<int>(hidden.locations.size()); ++i) {
    const Member& other = members_[static_cast<std::size_t>(i)];
    if (i == number || !other.detected || !hidden.known[static_cast<std::size_t>(i)]) continue;
    const Distance& distance = between(number, i);
    if (distance.count < kEnough) continue;
    const double variance = distance.variance + kMinSpread * kMinSpread + unknown(distance, kOpening);
    if (variance > kStationary * kStationary) continue;
    if (neighbours++ == 0) from_origin = hidden.locations[static_cast<std::size_t>(i)], to_origin = other.position;
    const double weight = 1e-12 / (variance * variance);
    const Vector<3> p = hidden.locations[static_cast<std::size_t>(i)] - from_origin, q = other.position - to_origin;
    from += weight * p;
    to += weight * q;
    time_step += weight * q * p.transpose();
    total += weight;
    spread += weight * variance;
  }
  if (neighbours < kMinNeighbours) return std::nullopt;
  from /= total;
  to /= total;
  time_step -= total * to * from.transpose();
  const geometry::SingularValues3 svd = geometry::singular_values(time_step);
  Matrix<3> flip = Matrix<3>::Identity();
  flip(2, 2) = (svd.U * svd.V.transpose()).determinant() < 0 ? -1 : 1;
  const Matrix<3> rotation = svd.U * flip * svd.V.transpose();
  const Vector<3> last = hidden.locations[static_cast<std::size_t>(number)] - from_origin;
  return Location{rotation * (last - from) + to + to_origin, spread / total};
}

}  // namespace marey::track::roster
