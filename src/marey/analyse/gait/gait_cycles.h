// Gait cycles: from a foot's strike to its next, every angle at 101 points of it, and what a walk is reported by: lengths, times,
// shares.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "marey/analyse/gait/gait_events.h"

namespace marey::analyse::gait {

inline constexpr std::size_t kCyclePoints = 101;  ///< at 0 %, 1 %, … 100 %, which is the next strike

/// One angle over time, rad, at the rate of the recording.
struct AngleCurve {
  std::string name;  ///< of `angle_names`
  std::vector<std::optional<double>> values;
};

using CyclePoints = std::array<double, kCyclePoints>;

/// One angle over the cycles of its side.
struct CycleCurve {
  std::string name;
  std::vector<CyclePoints> cycles;         ///< rad; of a cycle in which it is known throughout, and does not jump
  CyclePoints mean{}, deviation{};         ///< over the cycles
  std::size_t unknown = 0, jumping = 0;    ///< cycles of its side that are omitted
  std::vector<std::size_t> cycle_of = {};  ///< which of `GaitCycles::cycles` each of `cycles` is
};

/// The unit of a force that was divided by the body's weight.
inline constexpr std::string_view kPercentOfWeight = "% of weight";

/// Another signal over the cycles of its side, in its own unit: a force, a moment, a muscle's activity.
struct SignalCurve {
  std::string label;
  Side side = Side::left;
  std::vector<CyclePoints> cycles;
  CyclePoints mean{}, deviation{};
  std::string unit = {};
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
    std::optional<double> turn = {};  ///< rad: the walking direction in its second half against its first
  };
  std::vector<Cycle> cycles;
  std::vector<CycleCurve> curves;
  std::vector<GaitFigure> figures;
  std::size_t curved = 0;  ///< cycles that are omitted because they turn
};

struct GaitCycleOptions {
  std::optional<double> max_turn = {};  ///< rad; cycles that turn by more, or of which it is not known, are omitted
};

/// Cycles that last 0.4 to 3 s. Feet are for lengths: a stride is where the heel is at one strike and at the next.
GaitCycles gait_cycles(std::span<const GaitEvent> events, std::span<const AngleCurve> angles, const FeetPaths& feet, double rate_hz,
                       const GaitCycleOptions& options = {});

/// The side that a curve's name begins with, and the rest: "left_knee_flexion".
Side side_of_curve(std::string_view name);
std::string_view without_side(std::string_view name);

/// Mean over cycles, and deviation (n − 1; 0 for one cycle).
void summarise(std::span<const CyclePoints> cycles, CyclePoints& mean, CyclePoints& deviation);

/// `signal` has `rate_hz` samples per second and begins `begin_s` after the time from which the cycles count. Cycles of the other
/// side, and those that reach beyond the signal, are omitted.
SignalCurve signal_over_cycles(std::string label, Side side, std::span<const double> signal, double rate_hz, double begin_s,
                               std::span<const GaitCycles::Cycle> cycles);
/// The same of a signal that is not always known; cycles in which it is not are omitted.
SignalCurve signal_over_cycles(std::string label, Side side, std::span<const std::optional<double>> signal, double rate_hz,
                               double begin_s, std::span<const GaitCycles::Cycle> cycles);

}  // namespace marey::analyse::gait
