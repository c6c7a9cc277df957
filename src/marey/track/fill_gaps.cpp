#include "marey/track/fill_gaps.h"

#include <algorithm>
#include <cmath>

namespace marey::track {
namespace {

/// Hermite's cubic from `a` to `b`, which are `span` seconds apart, at a share `u` of the way. Velocities at the ends are
/// means over the gap where they would throw the curve wide: a target that turned unseen has left with another velocity.
float between(float a, float va, float b, float vb, double span, double u) {
  const double rise = b - a;
  const double most = 3 * std::abs(rise);  // Fritsch & Carlson 1980: no overshoot
  const double ta = std::clamp(va * span, -most, most), tb = std::clamp(vb * span, -most, most);
  const double u2 = u * u, u3 = u2 * u;
  return static_cast<float>((2 * u3 - 3 * u2 + 1) * a + (u3 - 2 * u2 + u) * ta + (-2 * u3 + 3 * u2) * b + (u3 - u2) * tb);
}

TrackRow row_between(const TrackRow& from, const TrackRow& to, const TrackRow& guess, double span, double u) {
  TrackRow row = guess;
  row.x = between(from.x, from.vx, to.x, to.vx, span, u);
  row.y = between(from.y, from.vy, to.y, to.vy, span, u);
  row.vx = static_cast<float>((to.x - from.x) / span);
  row.vy = static_cast<float>((to.y - from.y) / span);
  row.left = row.x - (row.width - 1) / 2;
  row.top = row.y - (row.height - 1) / 2;
  return row;
}

}  // namespace

std::vector<TrackRow> fill_gaps(TrackletLog& log, const GapOptions& options, int fewest) {
  std::vector<TrackRow> rows;
  for (const TrackletLog::Tracklet& tracklet : log.take_tracklets()) {
    const auto seen = [](const TrackRow& row) { return row.observed(); };
    if (std::count_if(tracklet.begin(), tracklet.end(), seen) < fewest) continue;
    auto last = tracklet.end();
    for (auto at = tracklet.begin(); at != tracklet.end(); ++at) {
      if (!at->observed()) continue;
      if (last != tracklet.end() && at - last > 1) {
        const Timestamp from = log.time_of(last->frame), to = log.time_of(at->frame);
        const double span = seconds(to - from);
        for (auto gap = last + 1; gap != at && span <= options.longest_filled; ++gap) {
          rows.push_back(row_between(*last, *at, *gap, span, seconds(log.time_of(gap->frame) - from) / span));
        }
      }
      rows.push_back(*at);
      last = at;
    }
  }
  std::sort(rows.begin(), rows.end(),
            [](const TrackRow& a, const TrackRow& b) { return std::pair(a.frame, a.id) < std::pair(b.frame, b.id); });
  return rows;
}

}  // namespace marey::track
