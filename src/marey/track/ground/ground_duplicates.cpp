#include "marey/track/ground/ground_duplicates.h"

#include <algorithm>
#include <bit>
#include <numeric>

#include <Eigen/LU>

namespace marey::track::ground {
namespace {

constexpr double farthest = 2.0;     // m; what lies farther apart is never one person
constexpr double gate = 9.2;         // chi-square of two degrees, 99 %
constexpr double long_enough = 0.5;  // s together without being distinguished

}  // namespace

bool GroundDuplicates::together(const Member& a, const Member& b, double disagreement) const {
  const Vector<2> apart = a.position - b.position;
  if (apart.squaredNorm() > farthest * farthest) return false;
  Matrix<2> S = a.covariance + b.covariance;
  S.diagonal().array() += 2 * disagreement * disagreement;
  return apart.dot(S.inverse() * apart) < gate;
}

const std::vector<std::pair<TrackId, TrackId>>& GroundDuplicates::find(Timestamp now, std::span<const Member> members,
                                                                       double disagreement) {
  merges_.clear();
  by_x_.resize(members.size());
  std::iota(by_x_.begin(), by_x_.end(), 0);
  std::sort(by_x_.begin(), by_x_.end(),
            [&](int a, int b) { return std::pair(members[a].position.x(), a) < std::pair(members[b].position.x(), b); });
  for (std::size_t i = 0; i < by_x_.size(); ++i) {
    for (std::size_t j = i + 1; j < by_x_.size(); ++j) {
      const Member& a = members[std::min(by_x_[i], by_x_[j])];
      const Member& b = members[std::max(by_x_[i], by_x_[j])];
      if (std::abs(a.position.x() - b.position.x()) > farthest) break;
      if (!together(a, b, disagreement)) continue;
      const auto [entry, fresh] = pairs_.try_emplace({a.id, b.id});
      Pair& pair = entry->second;
      if (fresh || (a.cameras & b.cameras) != 0) pair = {.since = now, .latest = now};
      pair.latest = now;
      pair.first |= a.cameras;
      pair.second |= b.cameras;
    }
  }
  std::erase_if(pairs_, [&](const auto& entry) { return entry.second.latest != now; });
  std::vector<TrackId> gone;
  for (const auto& [ids, pair] : pairs_) {
    if (seconds(now - pair.since) < long_enough || pair.first == 0 || pair.second == 0) continue;
    if (std::popcount(pair.first | pair.second) < 2) continue;
    if (std::find(gone.begin(), gone.end(), ids.first) != gone.end()) continue;
    if (std::find(gone.begin(), gone.end(), ids.second) != gone.end()) continue;
    merges_.push_back(ids);
    gone.push_back(ids.second);
  }
  return merges_;
}

}  // namespace marey::track::ground
