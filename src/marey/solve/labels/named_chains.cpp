#include "marey/solve/labels/named_chains.h"

#include <algorithm>
#include <cmath>

namespace marey::solve::labels {
namespace {

constexpr std::int32_t kMaxSamples = 80;  // at a chain's distances, evenly spread over its life

}  // namespace

NamedChains::NamedChains(std::vector<Tracklet> tracklets, const std::vector<int>& chain_of, std::size_t instants, std::size_t names)
    : tracklets_(std::move(tracklets)), chain_of_(chain_of), points_(instants), names_(names) {
  for (int t = 0; t < std::ssize(tracklets_); ++t) {
    const Tracklet& tracklet = tracklets_[static_cast<std::size_t>(t)];
    const int chain = chain_of_[static_cast<std::size_t>(t)];
    if (chain >= std::ssize(chains_)) chains_.resize(static_cast<std::size_t>(chain) + 1);
    chains_[static_cast<std::size_t>(chain)].tracklets.push_back(t);
    chains_[static_cast<std::size_t>(chain)].points += tracklet.length();
    auto instant = points_.begin() + tracklet.first;
    for (const Vector<3>& location : tracklet.locations) (instant++)->push_back({chain, t, location});
  }
}

void NamedChains::gather() {
  holders_.assign(points_.size() * names_, {});
  for (std::size_t instant = 0; instant < points_.size(); ++instant) {
    for (const Point& point : points_[instant]) {
      const Chain& chain = chains_[static_cast<std::size_t>(point.chain)];
      if (chain.name == assign::kNoIndex) continue;
      Holder& holder = holders_[instant * names_ + static_cast<std::size_t>(chain.name)];
      if (holder.chain != assign::kNoIndex && chains_[static_cast<std::size_t>(holder.chain)].points >= chain.points) continue;
      holder = {point.chain, point.location};
    }
  }
}

void NamedChains::add_fits(const Tracklet& tracklet, int self, std::int32_t step, const DistanceModel& model,
                           std::size_t neighbours, Fits& sums, int& count) const {
  std::vector<double> distance(names_);
  for (std::int32_t i = 0; i < tracklet.length(); i += step) {
    const auto instant = static_cast<std::size_t>(tracklet.first) + static_cast<std::size_t>(i);
    const Vector<3>& location = tracklet.locations[static_cast<std::size_t>(i)];
    for (std::size_t name = 0; name < names_; ++name) {
      const Holder& other = holder(instant, name);
      distance[name] =
          other.chain == assign::kNoIndex || other.chain == self ? -1 : (other.location - location).norm();  // −1: not there
    }
    for (std::size_t name = 0; name < names_; ++name) {
      std::size_t requested = 0;
      for (const std::size_t other : model.partners(name)) {
        if (distance[other] < 0) continue;
        sums[name] += model.ratio(name, other, distance[other]);
        if (++requested == neighbours) break;
      }
    }
    ++count;
  }
}

NamedChains::Fits NamedChains::fits_of_chain(int chain, const DistanceModel& model, std::size_t neighbours) const {
  const Chain& its = chains_[static_cast<std::size_t>(chain)];
  Fits fits(names_, 0);
  int count = 0;
  const std::int32_t step = std::max(1, its.points / kMaxSamples);
  for (const int t : its.tracklets) add_fits(tracklets_[static_cast<std::size_t>(t)], chain, step, model, neighbours, fits, count);
  for (double& fit : fits) fit /= std::max(count, 1);
  return fits;
}

NamedChains::Fits NamedChains::fits_of_tracklet(int tracklet, const DistanceModel& model, std::size_t neighbours) const {
  const Tracklet& its = tracklets_[static_cast<std::size_t>(tracklet)];
  Fits fits(names_, 0);
  int count = 0;
  add_fits(its, chain_of_[static_cast<std::size_t>(tracklet)], std::max(1, its.length() / kMaxSamples), model, neighbours, fits,
           count);
  for (double& fit : fits) fit /= std::max(count, 1);
  return fits;
}

std::vector<DistanceObserved> NamedChains::named_distances() const {
  std::vector<DistanceObserved> detected(names_ * (names_ - 1) / 2);
  const std::size_t step = std::max<std::size_t>(1, points_.size() / 400);
  for (std::size_t instant = 0; instant < points_.size(); instant += step) {
    for (std::size_t a = 1; a < names_; ++a) {
      if (holder(instant, a).chain == assign::kNoIndex) continue;
      for (std::size_t b = 0; b < a; ++b) {
        if (holder(instant, b).chain == assign::kNoIndex) continue;
        const double distance = (holder(instant, a).location - holder(instant, b).location).norm();
        DistanceObserved& pair = detected[LearnedMarkers::index_of(a, b)];
        pair.mean += distance;
        pair.variance += distance * distance;
        ++pair.count;
      }
    }
  }
  for (DistanceObserved& pair : detected) {
    if (pair.count == 0) continue;
    pair.mean /= pair.count;
    pair.variance = std::max(pair.variance / pair.count - pair.mean * pair.mean, 0.0);
  }
  return detected;
}

std::vector<DistanceObserved> NamedChains::distances_at(std::size_t instant, std::int32_t shortest, std::vector<int>& chains,
                                                        std::vector<Vector<3>>& locations) const {
  chains.clear();
  locations.clear();
  std::int32_t first = static_cast<std::int32_t>(points_.size()), last = 0;
  for (const Point& point : points_[instant]) {
    const Chain& chain = chains_[static_cast<std::size_t>(point.chain)];
    if (chain.points < shortest) continue;
    chains.push_back(point.chain);
    locations.push_back(point.location);
    first = std::min(first, tracklets_[static_cast<std::size_t>(chain.tracklets.front())].first);
    last = std::max(last, tracklets_[static_cast<std::size_t>(chain.tracklets.back())].last);
  }
  std::vector<DistanceObserved> detected(chains.size() * (chains.size() - 1) / 2);
  std::vector<int> slot(chains_.size(), assign::kNoIndex);
  for (int i = 0; i < std::ssize(chains); ++i) slot[static_cast<std::size_t>(chains[static_cast<std::size_t>(i)])] = i;
  const std::int32_t step = std::max(1, (last - first) / 120);
  for (std::int32_t at = first; at <= last; at += step) {
    const auto& points = points_[static_cast<std::size_t>(at)];
    for (std::size_t p = 0; p < points.size(); ++p) {
      const int i = slot[static_cast<std::size_t>(points[p].chain)];
      if (i == assign::kNoIndex) continue;
      for (std::size_t q = 0; q < p; ++q) {
        const int j = slot[static_cast<std::size_t>(points[q].chain)];
        if (j == assign::kNoIndex || j == i) continue;
        const double distance = (points[p].location - points[q].location).norm();
        DistanceObserved& pair = detected[LearnedMarkers::index_of(static_cast<std::size_t>(i), static_cast<std::size_t>(j))];
        pair.mean += distance;
        pair.variance += distance * distance;
        ++pair.count;
      }
    }
  }
  for (std::size_t i = 1; i < chains.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      DistanceObserved& pair = detected[LearnedMarkers::index_of(i, j)];
      if (pair.count == 0) {  // together at this instant alone
        pair = {(locations[i] - locations[j]).norm(), 0, 1};
        continue;
      }
      pair.mean /= pair.count;
      pair.variance = std::max(pair.variance / pair.count - pair.mean * pair.mean, 0.0);
    }
  }
  return detected;
}

void NamedChains::cut_off(int tracklet) {
  Chain& from = chains_[static_cast<std::size_t>(chain_of_[static_cast<std::size_t>(tracklet)])];
  const Tracklet& its = tracklets_[static_cast<std::size_t>(tracklet)];
  std::erase(from.tracklets, tracklet);
  from.points -= its.length();
  const int chain = static_cast<int>(chains_.size());
  chain_of_[static_cast<std::size_t>(tracklet)] = chain;
  for (std::int32_t i = its.first; i <= its.last; ++i) {
    for (Point& point : points_[static_cast<std::size_t>(i)]) {
      if (point.tracklet == tracklet) point.chain = chain;
    }
  }
  chains_.push_back({.tracklets = {tracklet}, .points = its.length(), .name = assign::kNoIndex});
}

bool NamedChains::overlap(int chain, int other) const {
  for (const int t : chains_[static_cast<std::size_t>(chain)].tracklets) {
    const Tracklet& a = tracklets_[static_cast<std::size_t>(t)];
    for (const int u : chains_[static_cast<std::size_t>(other)].tracklets) {
      const Tracklet& b = tracklets_[static_cast<std::size_t>(u)];
      if (a.first <= b.last && b.first <= a.last) return true;
    }
  }
  return false;
}

}  // namespace marey::solve::labels
