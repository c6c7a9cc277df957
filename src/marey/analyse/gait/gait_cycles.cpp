#include "marey/analyse/gait/gait_cycles.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <utility>

namespace marey::analyse::gait {
namespace {

constexpr double kMinS = 0.4, kMaxS = 3;
constexpr double kJump = 0.5 * std::numbers::pi;  // between two frames

/// Between rows, straight; nothing if one of them is not known.
template <typename T>
std::optional<T> value_at(std::span<const std::optional<T>> values, double row) {
  if (row < 0 || row > static_cast<double>(values.size()) - 1 + 1e-6) return std::nullopt;
  const auto i = std::min(static_cast<std::size_t>(row + 1e-6), values.size() - 1);
  const double fraction = row - static_cast<double>(i);
  if (fraction < 1e-6) return values[i];
  if (!values[i] || !values[i + 1]) return std::nullopt;
  return T((1 - fraction) * *values[i] + fraction * *values[i + 1]);
}

std::vector<GaitCycles::Cycle> find_cycles(std::span<const GaitEvent> events) {
  std::vector<GaitCycles::Cycle> cycles;
  for (const Side side : kSides) {
    std::optional<double> begin, off;
    for (const GaitEvent& event : events) {
      if (event.side != side) continue;
      if (!event.strike) {
        off = event.time_s;
        continue;
      }
      if (begin && event.time_s - *begin >= kMinS && event.time_s - *begin <= kMaxS)
        cycles.push_back({side, *begin, event.time_s, off && *off > *begin ? off : std::nullopt});
      begin = event.time_s;
      off.reset();
    }
  }
  return cycles;
}

/// From row to row by more than a joint can turn.
bool jumps(const AngleCurve& angle, const GaitCycles::Cycle& cycle, double rate_hz) {
  const auto last = static_cast<std::size_t>(std::ceil(cycle.end_s * rate_hz));
  for (auto r = static_cast<std::size_t>(std::floor(cycle.begin_s * rate_hz)) + 1; r <= last && r < angle.values.size(); ++r) {
    if (angle.values[r] && angle.values[r - 1] && std::abs(*angle.values[r] - *angle.values[r - 1]) > kJump) return true;
  }
  return false;
}

std::optional<std::array<double, kCyclePoints>> points_of(const AngleCurve& angle, const GaitCycles::Cycle& cycle, double rate_hz) {
  std::array<double, kCyclePoints> points{};
  for (std::size_t p = 0; p < kCyclePoints; ++p) {
    const double time = cycle.begin_s + (cycle.end_s - cycle.begin_s) * static_cast<double>(p) / (kCyclePoints - 1);
    const auto value = value_at(std::span(angle.values), time * rate_hz);
    if (!value) return std::nullopt;
    points[p] = *value;
  }
  return points;
}

/// An angle that continued over half a turn between two cycles is whole turns off in the second.
void remove_revolutions(std::span<CyclePoints> cycles) {
  const auto mean = [](const auto& points) { return std::accumulate(points.begin(), points.end(), 0.0) / kCyclePoints; };
  for (auto& points : cycles) {
    const double turn = 2 * std::numbers::pi, rotations = turn * std::round((mean(cycles.front()) - mean(points)) / turn);
    for (double& point : points) point += rotations;
  }
}

CycleCurve curve_of(const AngleCurve& angle, std::span<const GaitCycles::Cycle> cycles, double rate_hz) {
  CycleCurve curve{.name = angle.name, .cycles = {}};
  for (std::size_t c = 0; c < cycles.size(); ++c) {
    if (cycles[c].side != side_of_curve(angle.name)) continue;
    const auto points = points_of(angle, cycles[c], rate_hz);
    if (!points) {
      ++curve.unknown;
    } else if (jumps(angle, cycles[c], rate_hz)) {
      ++curve.jumping;
    } else {
      curve.cycles.push_back(*points);
      curve.cycle_of.push_back(c);
    }
  }
  remove_revolutions(curve.cycles);
  summarise(curve.cycles, curve.mean, curve.deviation);
  return curve;
}

/// Between the paths of the cycle's two halves, so that the pelvis' sway from foot to foot remains in it (a few degrees).
std::optional<double> turn_of(const GaitCycles::Cycle& cycle, const MarkerPath& sacrum, double rate_hz) {
  const auto at = [&](double time) { return value_at(std::span(sacrum), time * rate_hz); };
  const auto from = at(cycle.begin_s), middle = at(0.5 * (cycle.begin_s + cycle.end_s)), to = at(cycle.end_s);
  if (!from || !middle || !to) return std::nullopt;
  const Vector<2> first = (*middle - *from).head<2>(), second = (*to - *middle).head<2>();
  if (!(first.norm() > 1e-6) || !(second.norm() > 1e-6)) return std::nullopt;
  return std::atan2(first.x() * second.y() - first.y() * second.x(), first.dot(second));
}

/// Mean and deviation of what each cycle of a side gives.
template <typename Of>
GaitFigure figure(const char* name, const char* unit, std::span<const GaitCycles::Cycle> cycles, Of&& of) {
  GaitFigure result{.name = name, .unit = unit, .mean = {}, .deviation = {}};
  for (const Side side : kSides) {
    std::vector<double> values;
    for (const GaitCycles::Cycle& cycle : cycles) {
      if (cycle.side != side) continue;
      if (const std::optional<double> value = of(cycle)) values.push_back(*value);
    }
    if (values.empty()) continue;
    double sum = 0, squares = 0;
    for (const double v : values) sum += v;
    const double mean = sum / static_cast<double>(values.size());
    for (const double v : values) squares += (v - mean) * (v - mean);
    result.mean[static_cast<std::size_t>(side)] = mean;
    if (values.size() > 1)
      result.deviation[static_cast<std::size_t>(side)] = std::sqrt(squares / static_cast<double>(values.size() - 1));
  }
  return result;
}

/// What one cycle says of lengths and times.
class CycleMeasure {
 public:
  CycleMeasure(std::span<const GaitEvent> events, const FeetPaths& feet, double rate_hz)
      : events_(events), feet_(feet), rate_hz_(rate_hz) {}

  std::optional<Vector<2>> stride(const GaitCycles::Cycle& cycle) const {
    const auto from = heel(cycle.side, cycle.begin_s), to = heel(cycle.side, cycle.end_s);
    if (!from || !to) return std::nullopt;
    return Vector<2>(*to - *from);
  }
  /// The other foot's strike within the cycle.
  std::optional<double> other_strike(const GaitCycles::Cycle& cycle) const { return other(cycle, true); }
  std::optional<double> other_off(const GaitCycles::Cycle& cycle) const { return other(cycle, false); }

  /// Ahead, and aside, of the other foot's last place at this foot's next strike.
  std::optional<Vector<2>> step(const GaitCycles::Cycle& cycle) const {
    const auto advance = stride(cycle), at = heel(cycle.side, cycle.end_s);
    const auto strike = other_strike(cycle);
    const auto there = strike ? heel(cycle.side == Side::left ? Side::right : Side::left, cycle.end_s) : std::nullopt;
    if (!advance || !at || !there || advance->norm() < 1e-6) return std::nullopt;
    const Vector<2> ahead = advance->normalized(), between = *at - *there;
    return Vector<2>(ahead.dot(between), std::abs(ahead.x() * between.y() - ahead.y() * between.x()));
  }

 private:
  std::optional<Vector<2>> heel(Side side, double time) const {
    const auto location = value_at(std::span(feet_.heel[static_cast<std::size_t>(side)]), time * rate_hz_);
    return location ? std::optional(Vector<2>(location->head<2>())) : std::nullopt;
  }
  std::optional<double> other(const GaitCycles::Cycle& cycle, bool strike) const {
    for (const GaitEvent& event : events_) {
      if (event.side != cycle.side && event.strike == strike && event.time_s > cycle.begin_s && event.time_s < cycle.end_s)
        return event.time_s;
    }
    return std::nullopt;
  }

  std::span<const GaitEvent> events_;
  const FeetPaths& feet_;
  double rate_hz_;
};

}  // namespace

Side side_of_curve(std::string_view name) {
  return name.starts_with("left_") ? Side::left : Side::right;
}

std::string_view without_side(std::string_view name) {
  return name.substr(name.starts_with("left_") ? 5 : name.starts_with("right_") ? 6 : 0);
}

void summarise(std::span<const CyclePoints> cycles, CyclePoints& mean, CyclePoints& deviation) {
  const auto count = static_cast<double>(cycles.size());
  mean.fill(0);
  deviation.fill(0);
  for (std::size_t p = 0; p < kCyclePoints && count > 0; ++p) {
    double sum = 0, squares = 0;
    for (const CyclePoints& cycle : cycles) sum += cycle[p];
    mean[p] = sum / count;
    for (const CyclePoints& cycle : cycles) squares += (cycle[p] - mean[p]) * (cycle[p] - mean[p]);
    deviation[p] = count > 1 ? std::sqrt(squares / (count - 1)) : 0;
  }
}

SignalCurve signal_over_cycles(std::string label, Side side, std::span<const double> signal, double rate_hz, double begin_s,
                               std::span<const GaitCycles::Cycle> cycles) {
  const std::vector<std::optional<double>> known(signal.begin(), signal.end());
  return signal_over_cycles(std::move(label), side, std::span(known), rate_hz, begin_s, cycles);
}

SignalCurve signal_over_cycles(std::string label, Side side, std::span<const std::optional<double>> signal, double rate_hz,
                               double begin_s, std::span<const GaitCycles::Cycle> cycles) {
  SignalCurve curve{.label = std::move(label), .side = side, .cycles = {}};
  for (const GaitCycles::Cycle& cycle : cycles) {
    if (cycle.side != side || signal.empty()) continue;
    CyclePoints points{};
    bool whole = true;
    for (std::size_t p = 0; p < kCyclePoints && whole; ++p) {
      const double time = cycle.begin_s + (cycle.end_s - cycle.begin_s) * static_cast<double>(p) / (kCyclePoints - 1);
      const auto value = value_at(signal, (time - begin_s) * rate_hz);
      whole = value.has_value();
      points[p] = value.value_or(0);
    }
    if (whole) curve.cycles.push_back(points);
  }
  summarise(curve.cycles, curve.mean, curve.deviation);
  return curve;
}

GaitCycles gait_cycles(std::span<const GaitEvent> events, std::span<const AngleCurve> angles, const FeetPaths& feet, double rate_hz,
                       const GaitCycleOptions& options) {
  using Cycle = GaitCycles::Cycle;
  GaitCycles result;
  result.cycles = find_cycles(events);
  for (Cycle& cycle : result.cycles) cycle.turn = turn_of(cycle, feet.sacrum, rate_hz);
  if (options.max_turn)
    result.curved =
        std::erase_if(result.cycles, [&](const Cycle& cycle) { return !cycle.turn || std::abs(*cycle.turn) > *options.max_turn; });
  for (const AngleCurve& angle : angles) result.curves.push_back(curve_of(angle, result.cycles, rate_hz));
  const CycleMeasure measure(events, feet, rate_hz);
  const auto time = [](const Cycle& c) { return c.end_s - c.begin_s; };
  const auto add = [&](const char* name, const char* unit, auto&& of) {
    result.figures.push_back(figure(name, unit, result.cycles, of));
  };
  add("stride time", "s", [&](const Cycle& c) { return std::optional(time(c)); });
  add("cadence", "steps/min", [&](const Cycle& c) { return std::optional(120 / time(c)); });
  add("stride length", "m", [&](const Cycle& c) {
    const auto s = measure.stride(c);
    return s ? std::optional(s->norm()) : std::nullopt;
  });
  add("speed", "m/s", [&](const Cycle& c) {
    const auto s = measure.stride(c);
    return s ? std::optional(s->norm() / time(c)) : std::nullopt;
  });
  add("step length", "m", [&](const Cycle& c) {
    const auto s = measure.step(c);
    return s ? std::optional(s->x()) : std::nullopt;
  });
  add("step width", "m", [&](const Cycle& c) {
    const auto s = measure.step(c);
    return s ? std::optional(s->y()) : std::nullopt;
  });
  add("stance", "% of cycle",
      [&](const Cycle& c) { return c.off_s ? std::optional(100 * (*c.off_s - c.begin_s) / time(c)) : std::nullopt; });
  add("first double support", "% of cycle", [&](const Cycle& c) {
    const auto off = measure.other_off(c);
    return off && c.off_s && *off < *c.off_s ? std::optional(100 * (*off - c.begin_s) / time(c)) : std::nullopt;
  });
  return result;
}

}  // namespace marey::analyse::gait
