// Gait cycles: from a foot's strike to its next, every angle at 101 points of it, and what a walk is reported by: lengths, times,
// shares.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "marey/analyse/gait/gait_events.h"

namespace marey::analyse::gait {

inline constexpr std::size_t kCyclePoints = 101;  ///< at 0 %, 1 %, … 100 %, which is the next strike

/// One angle over time, rad, at the rate of the recording.
struct AngleCurve {
  std::string name;  ///< of `angle_names`
  std::vector<std::optional<double>> values;
};

/// One angle over the cycles of its side.
struct CycleCurve {
  std::string name;
  std::vector<std::array<double, kCyclePoints>> cycles;  ///< rad; of a cycle in which it is known throughout, and does not jump
  std::array<double, kCyclePoints> mean{}, deviation{};  ///< over the cycles
  std::size_t unknown = 0, jumping = 0;                  ///< cycles of its side that are omitted
};

/// A figure of the walk, over its cycles.
struct GaitFigure {
  std::string name, unit;
  std::array<std::optional<double>, 2> mean, deviation;  ///< left, right; deviation where there are two cycles or more
};

struct GaitCycles {
  struct Cycle {
    Side side = Side::left;
    double begin_s = 0, end_s = 0;
    std::optional<double> off_s;
  };
  std::vector<Cycle> cycles;
  std::vector<CycleCurve> curves;
  std::vector<GaitFigure> figures;
};

/// Cycles that last 0.4 to 3 s. Feet are for lengths: a stride is where the heel is at one strike and at the next.
GaitCycles gait_cycles(std::span<const GaitEvent> events, std::span<const AngleCurve> angles, const FeetPaths& feet,
                       double rate_hz);

}  // namespace marey::analyse::gait
