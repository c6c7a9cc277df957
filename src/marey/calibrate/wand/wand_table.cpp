#include "marey/calibrate/wand/wand_table.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace marey::calibrate::wand {
namespace {

constexpr double kSameTimeStep = 1e-3;  // of a period
constexpr double kNeighbour = 0.1;      // of a period, by which a neighbouring frame may be early or late

bool neighbours(const MarkFrame& earlier, const MarkFrame& later, double period_s) {
  return std::abs(later.time_s - earlier.time_s - period_s) <= kNeighbour * period_s;
}

/// The slope at frame k of one marker, by its two neighbours.
Vector<2> velocity_at(const MarkTrack& track, std::size_t k, std::size_t marker) {
  const auto& frames = track.frames;
  if (k == 0 || k + 1 >= frames.size() || track.period_s <= 0) return Vector<2>::Zero();
  const auto &before = frames[k - 1].marks[marker], &after = frames[k + 1].marks[marker];
  if (!before || !after || !neighbours(frames[k - 1], frames[k], track.period_s) ||
      !neighbours(frames[k], frames[k + 1], track.period_s)) {
    return Vector<2>::Zero();
  }
  return (*after - *before) / (frames[k + 1].time_s - frames[k - 1].time_s);
}

/// Lagrange's cubic through four evenly spaced values, at `u` in [0, 1] between the second and the third, and its slope by u.
MarkSample cubic(const std::array<Vector<2>, 4>& p, double u, double period_s) {
  const Vector<2> a = p[1], b = p[2] - p[0] / 3 - p[1] / 2 - p[3] / 6, c = (p[0] + p[2]) / 2 - p[1],
                  d = (p[3] - p[0]) / 6 + (p[1] - p[2]) / 2;
  return {a + u * (b + u * (c + u * d)), (b + u * (2 * c + u * 3 * d)) / period_s};
}

MarkSamples between(const MarkTrack& track, std::size_t later, double time_s) {
  MarkSamples samples;
  const auto& frames = track.frames;
  if (later < 2 || later + 1 >= frames.size() || track.period_s <= 0) return samples;
  for (std::size_t k = later - 1; k <= later + 1; ++k) {
    if (!neighbours(frames[k - 1], frames[k], track.period_s)) return samples;
  }
  const double step = frames[later].time_s - frames[later - 1].time_s, u = (time_s - frames[later - 1].time_s) / step;
  for (std::size_t m = 0; m < samples.size(); ++m) {
    std::array<Vector<2>, 4> pixels;
    bool whole = true;
    for (std::size_t k = 0; k < 4; ++k) {
      const auto& mark = frames[later - 2 + k].marks[m];
      whole &= mark.has_value();
      if (mark) pixels[k] = *mark;
    }
    if (whole) samples[m] = cubic(pixels, u, step);
  }
  return samples;
}

}  // namespace

std::array<double, 4> cubic_weights(double u) {
  return {-u * (u - 1) * (u - 2) / 6, (u + 1) * (u - 1) * (u - 2) / 2, -(u + 1) * u * (u - 2) / 2, (u + 1) * u * (u - 1) / 6};
}

double period_of(std::span<const BlobFrame> frames) {
  std::vector<double> steps;
  for (std::size_t i = 1; i < frames.size(); ++i) steps.push_back(frames[i].time_s - frames[i - 1].time_s);
  if (steps.empty()) return 0;
  // A wand is out of sight most of the time of some cameras: the common step is among the short ones.
  const auto low = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 10);
  std::nth_element(steps.begin(), low, steps.end());
  return *low;
}

MarkSamples sample_at(const MarkTrack& track, double time_s) {
  const double own = time_s - track.offset_s, near = kSameTimeStep * track.period_s + 1e-9;
  const auto& frames = track.frames;
  const auto later = std::lower_bound(frames.begin(), frames.end(), own - near,
                                      [](const MarkFrame& frame, double time) { return frame.time_s < time; });
  if (later == frames.end()) return {};
  const auto k = static_cast<std::size_t>(later - frames.begin());
  if (later->time_s > own + near) return between(track, k, own);
  MarkSamples samples;
  for (std::size_t m = 0; m < samples.size(); ++m) {
    if (later->marks[m]) samples[m] = MarkSample{*later->marks[m], velocity_at(track, k, m)};
  }
  return samples;
}

std::vector<double> instants_of(std::span<const MarkTrack> tracks) {
  double longest = 0, shortest = std::numeric_limits<double>::infinity();
  const MarkTrack* slowest = nullptr;
  std::vector<double> times;
  for (const MarkTrack& track : tracks) {
    for (const MarkFrame& frame : track.frames) times.push_back(frame.time_s + track.offset_s);
    if (track.period_s > 0) shortest = std::min(shortest, track.period_s);
    if (track.frames.empty() || track.period_s <= 1.01 * longest) continue;
    longest = track.period_s;
    slowest = &track;
  }
  std::sort(times.begin(), times.end());
  const double same = std::isfinite(shortest) ? kSameTimeStep * shortest + 1e-9 : 1e-9;
  std::vector<double> instants;
  bool in_step = true;
  for (const double time : times) {
    if (!instants.empty() && time - instants.back() <= same) continue;
    in_step &= instants.empty() || !std::isfinite(shortest) || time - instants.back() > 0.5 * shortest;
    instants.push_back(time);
  }
  if (in_step || slowest == nullptr) return instants;
  const double first = slowest->frames.front().time_s + slowest->offset_s;
  const double begin = first + std::ceil((times.front() - first) / longest) * longest;
  instants.clear();
  for (std::size_t i = 0; begin + static_cast<double>(i) * longest <= times.back(); ++i) {
    instants.push_back(begin + static_cast<double>(i) * longest);
  }
  return instants;
}

MarkTable table_of(std::span<const MarkTrack> tracks, std::span<const double> instants, std::size_t markers) {
  MarkTable table(instants.size(), std::vector<std::optional<Marks>>(tracks.size()));
  for (std::size_t i = 0; i < instants.size(); ++i) {
    for (std::size_t c = 0; c < tracks.size(); ++c) {
      const MarkSamples samples = sample_at(tracks[c], instants[i]);
      Marks marks;
      bool whole = true;
      for (std::size_t m = 0; m < markers; ++m) {
        whole &= samples[m].has_value();
        if (samples[m]) marks[m] = samples[m]->pixel;
      }
      if (whole) table[i][c] = marks;
    }
  }
  return table;
}

}  // namespace marey::calibrate::wand
