#include "marey/calibrate/wand/wand_offsets.h"

#include <algorithm>
#include <cmath>

#include "marey/calibrate/two_views.h"
#include "marey/core/geometry.h"
#include "marey/geometry/camera.h"

namespace marey::calibrate::wand {
namespace {

constexpr double kMaxShift_s = 60;
constexpr std::size_t kMinCommon = 40;  // samples of speed, to compare them
constexpr double kMinOverlap = 0.4;     // of the shorter recording, that two have in common
constexpr std::size_t kMinPairs = 50;   // views, to relate two cameras: few fit to anything
constexpr std::size_t kMaxPairs = 200;  // views by which a shift is evaluated
constexpr std::size_t kPeaks = 6;       // shifts whose geometry is tried
constexpr int kDraws = 300;             // of RANSAC: where the shift is right nearly all fits
constexpr double kFits = 0.85;          // share of views that fit when a shift is right
constexpr double kBetter = 0.1;         // by which the share must exceed that of the offsets as given

struct Shift {
  double seconds = 0, agreement = 0;
};

/// Logarithm of the wand's speed in the image, at even times.
struct Speed {
  double begin_s = 0;
  std::vector<std::optional<double>> values;
};

Speed speed_of(const MarkTrack& track, std::size_t markers, double period_s) {
  Speed speed;
  if (track.frames.empty() || period_s <= 0) return speed;
  speed.begin_s = track.frames.front().time_s + track.offset_s;
  const double end = track.frames.back().time_s + track.offset_s;
  for (std::size_t k = 0; speed.begin_s + static_cast<double>(k) * period_s <= end; ++k) {
    const MarkSamples samples = sample_at(track, speed.begin_s + static_cast<double>(k) * period_s);
    double sum = 0;
    for (std::size_t m = 0; m < markers; ++m) sum += samples[m] ? samples[m]->velocity.norm() : 0;
    speed.values.push_back(sum > 0 ? std::optional(std::log(sum)) : std::nullopt);
  }
  return speed;
}

/// Correlation of two speeds, b's samples moved by `lag`, as a standard normal deviate (Fisher); nothing if too few meet.
std::optional<double> agreement(const Speed& a, const Speed& b, std::ptrdiff_t lag) {
  double n = 0, sa = 0, sb = 0, saa = 0, sbb = 0, sab = 0;
  for (std::size_t i = 0; i < a.values.size(); ++i) {
    const std::ptrdiff_t j = static_cast<std::ptrdiff_t>(i) - lag;
    if (j < 0 || j >= std::ssize(b.values) || !a.values[i] || !b.values[static_cast<std::size_t>(j)]) continue;
    const double x = *a.values[i], y = *b.values[static_cast<std::size_t>(j)];
    n += 1, sa += x, sb += y, saa += x * x, sbb += y * y, sab += x * y;
  }
  const auto present = [](const Speed& speed) {
    return static_cast<double>(
        std::count_if(speed.values.begin(), speed.values.end(), [](const auto& value) { return value.has_value(); }));
  };
  if (n < std::max<double>(kMinCommon, kMinOverlap * std::min(present(a), present(b)))) return std::nullopt;
  const double variance = (saa - sa * sa / n) * (sbb - sb * sb / n);
  if (!(variance > 0)) return std::nullopt;
  const double r = std::clamp((sab - sa * sb / n) / std::sqrt(variance), -0.9999, 0.9999);
  return std::atanh(r) * std::sqrt(n - 3);
}

class Offsets {
 public:
  Offsets(std::vector<MarkTrack>& tracks, const std::vector<StartingCamera>& cameras, const MarkerLine& wand, std::uint64_t seed)
      : tracks_(tracks), cameras_(cameras), wand_(wand), seed_(seed) {
    for (const MarkTrack& track : tracks) period_s_ = std::max(period_s_, track.period_s);
    for (const StartingCamera& camera : cameras) lenses_.emplace_back(camera.lens, Rigid3{}, camera.size);
  }

  bool settle();

 private:
  struct Edge {
    std::size_t a = 0, b = 0;
    std::vector<Shift> peaks;  // best first, s added to b's times
  };

  double fraction(std::size_t a, std::size_t b, double shift_s) const;
  std::vector<Shift> peaks_of(const Speed& a, const Speed& b) const;
  std::vector<Edge> edges() const;
  std::optional<double> shift_that_fits(const Edge& edge) const;
  bool fits_as_given() const;
  std::optional<MarkerPositions> bearings(std::size_t c, double time_s) const;

  std::vector<MarkTrack>& tracks_;
  const std::vector<StartingCamera>& cameras_;
  const MarkerLine& wand_;
  std::uint64_t seed_;
  double period_s_ = 0;
  std::vector<Camera> lenses_;
};

std::optional<MarkerPositions> Offsets::bearings(std::size_t c, double time_s) const {
  const MarkSamples samples = sample_at(tracks_[c], time_s);
  MarkerPositions locations{};
  for (std::size_t m = 0; m < wand_.markers(); ++m) {
    const auto bearing = samples[m] ? lenses_[c].bearing(samples[m]->pixel) : std::nullopt;
    if (!bearing) return std::nullopt;
    locations[m] = *bearing;
  }
  return locations;
}

/// Of the views that two cameras share, b's times moved, how many one geometry explains.
double Offsets::fraction(std::size_t a, std::size_t b, double shift_s) const {
  std::vector<MarkPair> pairs;
  for (const MarkFrame& frame : tracks_[a].frames) {
    const double time = frame.time_s + tracks_[a].offset_s;
    const auto there = bearings(b, time - shift_s), here = there ? bearings(a, time) : std::nullopt;
    if (here) pairs.push_back({*here, *there});
  }
  if (pairs.size() < kMinPairs) return 0;
  if (pairs.size() > kMaxPairs) {  // spread over time
    std::vector<MarkPair> some;
    for (std::size_t i = 0; i < kMaxPairs; ++i) some.push_back(pairs[i * pairs.size() / kMaxPairs]);
    pairs = std::move(some);
  }
  const auto sigma = [&](std::size_t c) { return cameras_[c].sigma_px / geometry::focal_of(cameras_[c].lens).x(); };
  const auto views = relate(pairs, {wand_.markers(), wand_.reversible(), sigma(a), sigma(b), seed_, kDraws});
  return views ? views->fraction : 0;
}

/// Whether the cameras, each with one it shares much with, see one geometry with the offsets they have.
bool Offsets::fits_as_given() const {
  for (std::size_t c = 1; c < tracks_.size(); ++c) {
    double best = 0;
    for (std::size_t other = 0; other < c && best < kFits; ++other) best = std::max(best, fraction(other, c, 0));
    if (best < kFits) return false;
  }
  return true;
}

/// Shifts at which the speeds agree better than at those beside.
std::vector<Shift> Offsets::peaks_of(const Speed& a, const Speed& b) const {
  const auto reach = static_cast<std::ptrdiff_t>(kMaxShift_s / period_s_);
  const std::ptrdiff_t first = std::max(-reach, -std::ssize(b.values)), last = std::min(reach, std::ssize(a.values));
  std::vector<double> scores;
  for (std::ptrdiff_t lag = first; lag <= last; ++lag) scores.push_back(agreement(a, b, lag).value_or(0));
  std::vector<Shift> peaks;
  for (std::size_t i = 0; i < scores.size(); ++i) {
    if (scores[i] <= 0 || (i > 0 && scores[i - 1] >= scores[i]) || (i + 1 < scores.size() && scores[i + 1] > scores[i])) continue;
    peaks.push_back({a.begin_s - b.begin_s + static_cast<double>(first + static_cast<std::ptrdiff_t>(i)) * period_s_, scores[i]});
  }
  return peaks;
}

std::vector<Offsets::Edge> Offsets::edges() const {
  std::vector<Speed> speeds;
  for (const MarkTrack& track : tracks_) speeds.push_back(speed_of(track, wand_.markers(), period_s_));
  std::vector<Edge> edges;
  for (std::size_t a = 0; a < speeds.size(); ++a) {
    for (std::size_t b = a + 1; b < speeds.size(); ++b) {
      Edge edge{a, b, {}};
      edge.peaks = peaks_of(speeds[a], speeds[b]);
      std::stable_sort(edge.peaks.begin(), edge.peaks.end(),
                       [](const Shift& x, const Shift& y) { return x.agreement > y.agreement; });
      if (edge.peaks.size() > kPeaks) edge.peaks.resize(kPeaks);
      if (!edge.peaks.empty()) edges.push_back(std::move(edge));
    }
  }
  std::stable_sort(edges.begin(), edges.end(),
                   [](const Edge& x, const Edge& y) { return x.peaks.front().agreement > y.peaks.front().agreement; });
  return edges;
}

/// The shift at which most views fit: the best peak, then climbed in steps down to a quarter of a frame.
std::optional<double> Offsets::shift_that_fits(const Edge& edge) const {
  double best = 0, shift = 0;
  const auto attempt = [&](double seconds) {
    const double here = fraction(edge.a, edge.b, seconds);
    if (here > best) best = here, shift = seconds;
  };
  for (const Shift& peak : edge.peaks) {
    if (best < kFits) attempt(peak.seconds);
  }
  for (const double step : {2.0, 1.0, 0.5, 0.25}) {
    const double from = shift;
    attempt(from - step * period_s_);
    attempt(from + step * period_s_);
  }
  if (best < kFits || best < fraction(edge.a, edge.b, 0) + kBetter * (1 - best)) return std::nullopt;
  return shift;
}

bool Offsets::settle() {
  if (period_s_ <= 0 || fits_as_given()) return false;
  std::vector<std::size_t> group(tracks_.size());
  for (std::size_t c = 0; c < group.size(); ++c) group[c] = c;
  std::vector<double> shift(tracks_.size(), 0);
  bool changed = false;
  for (const Edge& edge : edges()) {
    if (group[edge.a] == group[edge.b]) continue;
    const auto found = shift_that_fits(edge);
    if (!found) continue;
    // All of b's group moves so that b fits to a.
    const double by = *found + shift[edge.a] - shift[edge.b];
    const std::size_t joined = group[edge.b];
    for (std::size_t c = 0; c < group.size(); ++c) {
      if (group[c] == joined) shift[c] += by, group[c] = group[edge.a];
    }
    changed = true;
  }
  for (std::size_t c = 0; c < tracks_.size(); ++c) {
    if (group[c] == group[0]) tracks_[c].offset_s += shift[c] - shift[0];
  }
  return changed;
}

}  // namespace

bool settle_offsets(std::vector<MarkTrack>& tracks, const std::vector<StartingCamera>& cameras, const MarkerLine& wand,
                    std::uint64_t seed) {
  return Offsets(tracks, cameras, wand, seed).settle();
}

}  // namespace marey::calibrate::wand
