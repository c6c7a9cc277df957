#include "marey/analyse/gait/gait_events.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "marey/geometry/butterworth.h"
#include "marey/geometry/median.h"

namespace marey::analyse::gait {
namespace {

constexpr std::size_t kMirrored = 20;
constexpr double kWalkCutoffHz = 3;  // of the body's own path

/// A marker's speed over the ground at each row, m/s; its first and last known values hold beyond them. Empty if it is never
/// seen.
std::vector<double> ground_speed(const MarkerPath& path, double cutoff_hz, double rate_hz) {
  std::vector<std::size_t> known;
  for (std::size_t i = 0; i < path.size(); ++i) {
    if (path[i]) known.push_back(i);
  }
  if (known.size() < 5) return {};
  std::array<std::vector<double>, 2> along;
  for (std::size_t k = 0; k + 1 < known.size(); ++k) {
    for (std::size_t i = known[k]; i < known[k + 1] || (k + 2 == known.size() && i == known[k + 1]); ++i) {
      const double fraction = static_cast<double>(i - known[k]) / static_cast<double>(known[k + 1] - known[k]);
      for (int c = 0; c < 2; ++c)
        along[static_cast<std::size_t>(c)].push_back((1 - fraction) * (*path[known[k]])[c] + fraction * (*path[known[k + 1]])[c]);
    }
  }
  for (auto& values : along) values = low_pass(std::move(values), cutoff_hz, rate_hz);
  std::vector<double> speed(path.size());
  const std::size_t count = along[0].size();
  for (std::size_t i = 0; i < path.size(); ++i) {
    const std::size_t at = std::min(i - std::min(i, known.front()), count - 1), from = at > 0 ? at - 1 : 0,
                      to = std::min(at + 1, count - 1);
    const double step = rate_hz / static_cast<double>(to - from);
    speed[i] = step * std::hypot(along[0][to] - along[0][from], along[1][to] - along[1][from]);
  }
  return speed;
}

/// Where a line from row `i` to the next passes `level`.
double crossing(const std::vector<double>& values, std::size_t i, double level) {
  const double step = values[i + 1] - values[i];
  return static_cast<double>(i) + (step != 0 ? std::clamp((level - values[i]) / step, 0.0, 1.0) : 0);
}

void add_events(Side side, const std::vector<double>& heel, const std::vector<double>& toe, double walk, double rate_hz,
                const GaitEventOptions& options, std::vector<GaitEvent>& events) {
  const std::size_t n = heel.size();
  const auto swings = [&](std::size_t i) { return 0.5 * (heel[i] + toe[i]) > walk; };
  const auto add = [&](bool strike, double row) { events.push_back({side, strike, row / rate_hz, options.deviation_s}); };
  for (std::size_t begin = 0; begin < n;) {
    if (!swings(begin)) {
      ++begin;
      continue;
    }
    std::size_t end = begin;
    while (end < n && swings(end)) ++end;
    std::size_t off = begin;
    while (off > 0 && toe[off] > options.off_fraction * walk) --off;
    if (begin > 0 && toe[off] <= options.off_fraction * walk && off + 1 < n)
      add(false, crossing(toe, off, options.off_fraction * walk));
    std::size_t strike = end;
    while (strike < n && heel[strike] > options.strike_fraction * walk) ++strike;
    if (end < n && strike < n && strike > 0) add(true, crossing(heel, strike - 1, options.strike_fraction * walk));
    begin = end;
  }
}

}  // namespace

std::vector<double> low_pass(std::vector<double> values, double cutoff_hz, double rate_hz) {
  const double each = geometry::cutoff_of_one_pass(cutoff_hz) / rate_hz;
  if (values.size() >= 3 && each < 0.5) geometry::low_pass(std::span(values), each, kMirrored);
  return values;
}

std::vector<GaitEvent> gait_events(const FeetPaths& feet, double rate_hz, const GaitEventOptions& options) {
  std::vector<GaitEvent> events;
  std::vector<double> walk = ground_speed(feet.sacrum, kWalkCutoffHz, rate_hz);
  if (walk.empty()) return events;
  const auto middle = geometry::median(walk);
  if (middle < options.slowest_m_s) return events;
  for (const Side side : kSides) {
    const auto i = static_cast<std::size_t>(side);
    const std::vector<double> heel = ground_speed(feet.heel[i], options.cutoff_hz, rate_hz),
                              toe = ground_speed(feet.toe[i], options.cutoff_hz, rate_hz);
    if (!heel.empty() && heel.size() == toe.size()) add_events(side, heel, toe, middle, rate_hz, options, events);
  }
  std::stable_sort(events.begin(), events.end(), [](const GaitEvent& a, const GaitEvent& b) { return a.time_s < b.time_s; });
  return events;
}

}  // namespace marey::analyse::gait
