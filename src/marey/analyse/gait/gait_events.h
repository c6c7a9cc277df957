// When feet meet the ground and leave it, by their speed over it against the walker's: a foot that stands has none, one that swings
// is more than twice as fast as the body. A strike is where the heel's speed falls below a share of the walker's, an off where the
// toe's rises above one. Unlike the extremes of Zeni et al. (2008) that needs no half cycle on either side, so that steps at a
// trial's rim count, and no direction of walking, so that turning does not matter.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "marey/analyse/gait/conventional_model.h"

namespace marey::analyse::gait {

/// Shares and deviation: found on 131 strikes and offs of the biomechZoo children, walking straight and turning (docs/gait.md says
/// what they give).
struct GaitEventOptions {
  double strike_fraction = 0.4;  ///< of the walker's speed, that of the heel
  double off_fraction = 0.75;    ///< that of the toe
  double cutoff_hz = 15;         ///< of the feet's paths
  double deviation_s = 0.014;    ///< of one event
  double slowest_m_s = 0.15;     ///< who is slower does not walk
};

struct GaitEvent {
  Side side = Side::left;
  bool strike = true;  ///< otherwise the foot leaves the ground
  double time_s = 0;
  double deviation_s = 0;
};

/// One marker at an even rate; nothing if it is missing. Gaps within are bridged straight.
using MarkerPath = std::vector<std::optional<Vector<3>>>;

struct FeetPaths {
  std::array<MarkerPath, 2> heel, toe;  ///< left, right
  MarkerPath sacrum;                    ///< or the middle of the hips
};

/// By time. Times count from the first row, `rate_hz` rows a second.
std::vector<GaitEvent> gait_events(const FeetPaths& feet, double rate_hz, const GaitEventOptions& options = {});

/// Butterworth's, order 2, forwards and backwards, so that nothing lags; `cutoff_hz` is that of both passes together (Winter 2009,
/// section 2.2.4.4). Ends are continued by their own mirror image turned round.
std::vector<double> low_pass(std::vector<double> values, double cutoff_hz, double rate_hz);

}  // namespace marey::analyse::gait
