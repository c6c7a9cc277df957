#include "marey/track/offline/fill_gaps.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <span>
#include <utility>

namespace marey::track::offline {
namespace {

using Tracklet = TrackletLog::Tracklet;

float on_line(float a, float b, double fraction) {
  return static_cast<float>(a + fraction * (static_cast<double>(b) - a));
}

TrackRow straight_row(const TrackRow& a, const TrackRow& b, std::int32_t frame, double fraction) {
  TrackRow row = a;
  row.frame = frame;
  row.x = on_line(a.x, b.x, fraction);
  row.y = on_line(a.y, b.y, fraction);
  row.vx = on_line(a.vx, b.vx, fraction);
  row.vy = on_line(a.vy, b.vy, fraction);
  row.left = on_line(a.left, b.left, fraction);
  row.top = on_line(a.top, b.top, fraction);
  row.width = on_line(a.width, b.width, fraction);
  row.height = on_line(a.height, b.height, fraction);
  row.score = on_line(a.score, b.score, fraction);
  row.provenance = Provenance::filled;
  row.has_centre = false;
  return row;
}

/// Hermite's cubic from `a` to `b`, which are `span` seconds apart, at a share `u` of the span. Velocities at the ends are
/// means over the gap where they would throw the curve wide: a target that turned unseen has left with another velocity.
float on_cubic(float a, float va, float b, float vb, double span, double u) {
  const double rise = b - a;
  const double maximum = 3 * std::abs(rise);  // Fritsch & Carlson 1980: no overshoot
  const double ta = std::clamp(va * span, -maximum, maximum), tb = std::clamp(vb * span, -maximum, maximum);
  const double u2 = u * u, u3 = u2 * u;
  return static_cast<float>((2 * u3 - 3 * u2 + 1) * a + (u3 - 2 * u2 + u) * ta + (-2 * u3 + 3 * u2) * b + (u3 - u2) * tb);
}

TrackRow cubic_row(const TrackRow& from, const TrackRow& to, const TrackRow& guess, double span, double u) {
  TrackRow row = guess;
  row.x = on_cubic(from.x, from.vx, to.x, to.vx, span, u);
  row.y = on_cubic(from.y, from.vy, to.y, to.vy, span, u);
  row.vx = static_cast<float>((to.x - from.x) / span);
  row.vy = static_cast<float>((to.y - from.y) / span);
  row.provenance = Provenance::filled;
  row.left = row.x - (row.width - 1) / 2;
  row.top = row.y - (row.height - 1) / 2;
  return row;
}

void sort_by_frame(std::vector<TrackRow>& rows) {
  std::sort(rows.begin(), rows.end(),
            [](const TrackRow& a, const TrackRow& b) { return std::pair(a.frame, a.id) < std::pair(b.frame, b.id); });
}

/// The rows of the frames between the first and the last of `rows`, which are observed; what lies between them was guessed.
void append_between(std::span<const TrackRow> rows, const TrackletLog& log, double longest, GapInterpolation method,
                    Tracklet& filled) {
  const TrackRow &from = rows.front(), &to = rows.back();
  const Timestamp begin = log.time_of(from.frame);
  const double span = seconds(log.time_of(to.frame) - begin);
  if (span > longest) return;
  auto guess = rows.begin();
  for (std::int32_t frame = from.frame + 1; frame < to.frame; ++frame) {
    const double fraction = seconds(log.time_of(frame) - begin) / span;
    const TrackRow straight = straight_row(from, to, frame, fraction);
    if (method == GapInterpolation::straight) {
      filled.push_back(straight);
      continue;
    }
    while (guess->frame < frame) ++guess;
    filled.push_back(cubic_row(from, to, guess->frame == frame ? *guess : straight, span, fraction));
  }
}

}  // namespace

void fill_gaps(Tracklet& rows, const TrackletLog& log, double longest, GapInterpolation method) {
  Tracklet filled;
  filled.reserve(rows.empty() ? 0 : static_cast<std::size_t>(rows.back().frame - rows.front().frame + 1));
  const TrackRow* last = nullptr;
  for (const TrackRow& row : rows) {
    if (!row.observed()) continue;
    if (last != nullptr) append_between(std::span(last, &row + 1), log, longest, method, filled);
    filled.push_back(row);
    last = &row;
  }
  rows = std::move(filled);
}

std::vector<TrackRow> fill_between_searches(std::span<const TrackRow> rows, std::span<const std::int32_t> searched,
                                            std::span<const Timestamp> times) {
  std::vector<TrackRow> filled;
  std::map<std::int32_t, TrackRow> last;  // of each target; `frame` counts searched frames
  for (const TrackRow& row : rows) {
    const std::int32_t frame = searched[static_cast<std::size_t>(row.frame)];
    const auto before = last.find(row.id);
    if (before != last.end() && before->second.frame == row.frame - 1) {
      const std::int32_t begin = searched[static_cast<std::size_t>(row.frame) - 1];
      const auto time = [&](std::int32_t at) { return times[static_cast<std::size_t>(at)]; };
      const double span = seconds(time(frame) - time(begin));
      const bool extrapolated = before->second.provenance == Provenance::predicted || row.provenance == Provenance::predicted;
      for (std::int32_t between = begin + 1; between < frame; ++between) {
        filled.push_back(straight_row(before->second, row, between, seconds(time(between) - time(begin)) / span));
        if (extrapolated) filled.back().provenance = Provenance::predicted;
      }
    }
    last[row.id] = row;
    filled.push_back(row);
    filled.back().frame = frame;
  }
  sort_by_frame(filled);
  return filled;
}

std::vector<TrackRow> rows_of_points(TrackletLog& log, int lowest_count, double longest) {
  std::vector<TrackRow> rows;
  for (TrackletLog::Tracklet& tracklet : log.take_tracklets()) {
    const auto detected = [](const TrackRow& row) { return row.observed(); };
    if (std::count_if(tracklet.begin(), tracklet.end(), detected) < lowest_count) continue;
    fill_gaps(tracklet, log, longest, GapInterpolation::cubic);
    rows.insert(rows.end(), tracklet.begin(), tracklet.end());
  }
  sort_by_frame(rows);
  return rows;
}

}  // namespace marey::track::offline
