#include "marey/track/outlines_of_rows.h"

#include <cassert>
#include <utility>

namespace marey::track {
namespace {

/// The outline moved with its target from `from` to `to`, and scaled about it.
std::shared_ptr<const Outline> carried(const Outline& outline, const Vector<2>& from, const Vector<2>& to, double scale) {
  auto result = std::make_shared<Outline>(outline);
  const auto move = [&](const Vector<2>& point) -> Vector<2> { return to + scale * (point - from); };
  for (Vector<2>& point : result->control_points) point = move(point);
  for (Vector<2>& deviation : result->deviations) deviation *= scale;
  result->centre = move(outline.centre);
  result->lines.clear();
  result->silhouette.reset();
  result->state = Outline::State::held;
  return result;
}

std::shared_ptr<const Outline> with_centre(const std::shared_ptr<const Outline>& outline, const TrackRow& row) {
  if (!row.has_centre) return outline;
  const Vector<2> centre(row.centre_x, row.centre_y);
  auto result = std::make_shared<Outline>(*outline);
  if (outline->state == Outline::State::held) {
    for (Vector<2>& point : result->control_points) point += centre - outline->centre;
    result->lines.clear();
  }
  result->centre = centre;
  return result;
}

}  // namespace

void OutlinesOfRows::attach(std::int64_t frame, std::span<const TrackRow> rows, std::span<Track<2>> tracks) {
  assert(rows.size() == tracks.size());
  const OutlineLog::Frame& outlines = recording_.at(frame);
  std::swap(last_, before_);
  last_.clear();
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const TrackRow& row = rows[i];
    const Vector<2> place(row.x, row.y);
    if (row.observed()) {
      const auto found = outlines.find(row.first_id);
      if (found == outlines.end()) continue;
      tracks[i].outline = with_centre(found->second, row);
      last_[row.id] = {found->second, place, row.height};
    } else if (const auto known = before_.find(row.id); known != before_.end()) {
      const Last& last = known->second;
      const double scale = last.height > 0 && row.has_box() ? row.height / last.height : 1;
      tracks[i].outline = with_centre(carried(*last.outline, last.place, place, scale), row);
      last_[row.id] = last;
    }
  }
}

}  // namespace marey::track
