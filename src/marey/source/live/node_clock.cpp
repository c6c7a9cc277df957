#include "marey/source/live/node_clock.h"

#include <limits>

namespace marey::source::live {
namespace {

constexpr std::size_t kRoundTrips = 16;
constexpr double kDrift = 50e-6;  // s/s that two hosts' clocks go apart

}  // namespace

void NodeClock::learn(Timestamp requested, Timestamp reported, Timestamp came) {
  const Duration half = (came - requested) / 2;
  last_.push_back({came, requested + half - reported, seconds(half)});
  if (last_.size() > kRoundTrips) last_.pop_front();
  best_ = best(came);
}

std::optional<NodeClock::RoundTrip> NodeClock::best(Timestamp now) const {
  std::optional<RoundTrip> best;
  double minimum = std::numeric_limits<double>::infinity();
  for (const RoundTrip& each : last_) {
    const double off = each.half_s + kDrift * seconds(now - each.came);
    if (off > minimum) continue;
    minimum = off;
    best = each;
  }
  return best;
}

std::optional<Timestamp> NodeClock::here(Timestamp there) const {
  return best_ ? std::optional(there + best_->ahead) : std::nullopt;
}

double NodeClock::uncertainty(Timestamp now) const {
  return best_ ? best_->half_s + kDrift * seconds(now - best_->came) : std::numeric_limits<double>::infinity();
}

}  // namespace marey::source::live
