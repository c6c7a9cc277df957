#include "marey/track/rigid_neighbours.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/LU>

#include "marey/geometry/decompositions.h"

namespace marey::track {
namespace {

constexpr std::size_t kMostMembers = 600;  // 180,000 pairs
constexpr std::size_t kShare = 2;          // frames in which every pair is learned from once
constexpr int kMemory = 1000;              // samples that a mean is taken over
constexpr int kEnough = 8;                 // samples from which a spread is believed
constexpr int kEnoughToName = 12;          // samples from which its neighbours identify a marker
constexpr double kOpening = 0.02;          // m, of spread that a distance may yet show, fading with the samples
constexpr double kLeastSpread = 0.001;     // m
constexpr double kSteady = 0.05;           // m; markers whose distance varies by more say nothing of each other
constexpr std::size_t kFewest = 3;         // neighbours
constexpr std::size_t kRanked = 14;        // neighbours that are asked whether a place is a marker's; those that are seen count
constexpr std::size_t kAsked = 9;
constexpr int kHardlyEver = 60;      // samples of both seen, of names that may be one marker's
constexpr int kWellKnown = 400;      // samples of each with a third
constexpr int kEnoughAgree = 6;      // thirds
constexpr double kShareAgree = 0.9;  // of the thirds that find both as far away, within
constexpr double kAlike = 0.01;      // m, and the spreads' mean
constexpr double kUnseen = 0.06;     // m, of spread that a distance may yet show, fading with the samples
constexpr double kDoubt = 0.004;     // m, added to every spread: poses that were not seen yet

}  // namespace

std::optional<int> RigidNeighbours::enrol() {
  if (members_.size() >= kMostMembers) return std::nullopt;
  members_.emplace_back();
  last_positions_.resize(members_.size());
  last_seen_.resize(members_.size(), 0);
  distances_.resize(members_.size() * (members_.size() - 1) / 2);
  return static_cast<int>(members_.size()) - 1;
}

void RigidNeighbours::begin_frame() {
  for (std::size_t i = 0; i < members_.size(); ++i) {
    Member& member = members_[i];
    last_positions_[i] = member.position;
    last_seen_[i] = member.seen;
    member.was_seen = member.seen;
    member.seen = false;
  }
}

void RigidNeighbours::see(int number, const Vector<3>& position) {
  members_[static_cast<std::size_t>(number)].position = position;
  members_[static_cast<std::size_t>(number)].seen = true;
}

void RigidNeighbours::end_frame() {
  ++frames_;
  for (Member& member : members_) {
    if (member.was_seen && !member.seen) keep_places(member);
  }
  for (std::size_t row = frames_ % kShare; row < members_.size(); row += kShare) learn(static_cast<int>(row));
  if (!members_.empty()) rank(static_cast<int>(frames_ % members_.size()));
}

void RigidNeighbours::rank(int number) {
  std::vector<int>& list = members_[static_cast<std::size_t>(number)].steadiest;
  list.clear();
  for (int i = 0; i < static_cast<int>(members_.size()); ++i) {
    if (i == number) continue;
    const Distance& distance = between(number, i);
    if (distance.count >= kEnoughToName && distance.variance < kSteady * kSteady) list.push_back(i);
  }
  const std::size_t kept = std::min(kRanked, list.size());
  std::partial_sort(list.begin(), list.begin() + static_cast<std::ptrdiff_t>(kept), list.end(), [&](int a, int b) {
    const float p = between(number, a).variance, q = between(number, b).variance;
    return p != q ? p < q : a < b;
  });
  list.resize(kept);
}

std::optional<double> RigidNeighbours::misfit(int number, const Vector<3>& place) const {
  std::array<double, kAsked> off;
  std::size_t asked = 0;
  for (const int i : members_[static_cast<std::size_t>(number)].steadiest) {
    const Member& other = members_[static_cast<std::size_t>(i)];
    if (!other.seen) continue;
    const Distance& distance = between(number, i);
    const double change = (place - other.position).norm() - distance.mean;
    off[asked++] = change * change / (distance.variance + kDoubt * kDoubt + kUnseen * kUnseen / distance.count);
    if (asked == kAsked) break;
  }
  if (asked < kFewest) return std::nullopt;
  const auto middle = off.begin() + static_cast<std::ptrdiff_t>(asked / 2);
  std::nth_element(off.begin(), middle, off.begin() + static_cast<std::ptrdiff_t>(asked));
  return *middle;
}

bool RigidNeighbours::same(int a, int b) const {
  if (between(a, b).count >= kHardlyEver) return false;
  int asked = 0, agree = 0;
  for (int i = 0; i < static_cast<int>(members_.size()); ++i) {
    if (i == a || i == b) continue;
    const Distance &p = between(a, i), &q = between(b, i);
    if (p.count < kWellKnown || q.count < kWellKnown) continue;
    ++asked;
    agree += std::abs(p.mean - q.mean) < kAlike + 0.5 * (std::sqrt(p.variance) + std::sqrt(q.variance));
  }
  return asked >= kEnoughAgree && agree >= kShareAgree * asked;
}

void RigidNeighbours::disown(int number) {
  Member& member = members_[static_cast<std::size_t>(number)];
  member.seen = member.was_seen = false;
  member.places.clear();
  member.known.clear();
}

void RigidNeighbours::learn(int row) {
  const Member& one = members_[static_cast<std::size_t>(row)];
  if (!one.seen) return;
  for (int i = 0; i < row; ++i) {
    const Member& other = members_[static_cast<std::size_t>(i)];
    if (!other.seen) continue;
    Distance& distance = between(row, i);
    const double here = (one.position - other.position).norm();
    const double off = here - distance.mean;
    distance.count = std::min(distance.count + 1, kMemory);
    const double share = 1.0 / distance.count;
    distance.mean += static_cast<float>(share * off);
    distance.variance = static_cast<float>((1 - share) * (distance.variance + share * off * off));
  }
}

/// The frame before this one was the last that saw it.
void RigidNeighbours::keep_places(Member& member) const {
  member.places = last_positions_;
  member.known = last_seen_;
}

std::optional<RigidNeighbours::Place> RigidNeighbours::place_of(int number) const {
  const Member& hidden = members_[static_cast<std::size_t>(number)];
  if (hidden.places.empty()) return std::nullopt;
  Vector<3> from = Vector<3>::Zero(), to = Vector<3>::Zero();
  Matrix<3> moment = Matrix<3>::Zero();
  double total = 0, spread = 0;
  std::size_t neighbours = 0;
  // Sums about the first neighbour's places, so that no digits are lost.
  Vector<3> from_origin = Vector<3>::Zero(), to_origin = Vector<3>::Zero();
  for (int i = 0; i < static_cast<int>(hidden.places.size()); ++i) {
    const Member& other = members_[static_cast<std::size_t>(i)];
    if (i == number || !other.seen || !hidden.known[static_cast<std::size_t>(i)]) continue;
    const Distance& distance = between(number, i);
    if (distance.count < kEnough) continue;
    const double variance = distance.variance + kLeastSpread * kLeastSpread + kOpening * kOpening / distance.count;
    if (variance > kSteady * kSteady) continue;
    if (neighbours++ == 0) from_origin = hidden.places[static_cast<std::size_t>(i)], to_origin = other.position;
    const double weight = 1e-12 / (variance * variance);
    const Vector<3> p = hidden.places[static_cast<std::size_t>(i)] - from_origin, q = other.position - to_origin;
    from += weight * p;
    to += weight * q;
    moment += weight * q * p.transpose();
    total += weight;
    spread += weight * variance;
  }
  if (neighbours < kFewest) return std::nullopt;
  from /= total;
  to /= total;
  moment -= total * to * from.transpose();
  const geometry::SingularValues3 svd = geometry::singular_values(moment);
  Matrix<3> flip = Matrix<3>::Identity();
  flip(2, 2) = (svd.U * svd.V.transpose()).determinant() < 0 ? -1 : 1;
  const Matrix<3> rotation = svd.U * flip * svd.V.transpose();
  const Vector<3> last = hidden.places[static_cast<std::size_t>(number)] - from_origin;
  return Place{rotation * (last - from) + to + to_origin, spread / total};
}

}  // namespace marey::track
