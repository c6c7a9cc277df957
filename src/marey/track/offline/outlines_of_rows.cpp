#include "marey/track/offline/outlines_of_rows.h"

#include <algorithm>
#include <cassert>
#include <utility>

#include "marey/track/contour/silhouette_spline.h"

namespace marey::track::offline {
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
  result->behind.clear();
  result->hidden.clear();
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

/// Who hides it, by the names of the second pass.
std::shared_ptr<const Outline> with_names(const std::shared_ptr<const Outline>& outline,
                                          const std::map<std::int32_t, std::int32_t>& id_of) {
  if (outline->behind.empty()) return outline;
  auto result = std::make_shared<Outline>(*outline);
  result->behind.clear();
  for (const TrackId id : outline->behind) {
    if (const auto now = id_of.find(number(id)); now != id_of.end()) result->behind.push_back(TrackId{now->second});
  }
  std::sort(result->behind.begin(), result->behind.end());
  return result;
}

/// A curve that crosses itself, or has left its target's size, is not an outline of it.
bool may_be_written(const Outline& outline, const TrackRow& row) {
  return contour::is_outline_of({outline.order, outline.control_points}, {row.left, row.top, row.width, row.height});
}

/// Searched in a region that its target shares, and found near where the second pass says: there the first may only have coasted.
bool is_where(const Outline& outline, const TrackRow& row) {
  return outline.state != Outline::State::held && (outline.centre - Vector<2>(row.x, row.y)).norm() < row.height / 2;
}

}  // namespace

void OutlinesOfRows::attach(std::int64_t frame, std::span<const TrackRow> rows, std::span<Track<2>> tracks) {
  assert(rows.size() == tracks.size());
  const OutlineLog::Frame& outlines = recording_.at(frame);
  std::swap(last_, before_);
  last_.clear();
  std::map<std::int32_t, std::int32_t> id_of;  // what they are called now, by what the tracker called them
  for (const TrackRow& row : rows) id_of.emplace(row.first_id, row.id);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const TrackRow& row = rows[i];
    const Vector<2> location(row.x, row.y);
    const auto found = outlines.find(row.first_id);
    const bool own = found != outlines.end() && (row.observed() || is_where(*found->second, row));
    if (own) {
      tracks[i].outline = with_names(with_centre(found->second, row), id_of);
      last_[row.id] = {found->second, location, row.height};
    } else if (const auto known = before_.find(row.id); known != before_.end() && !row.observed()) {
      const Last& last = known->second;
      const double scale = last.height > 0 && row.has_box() ? row.height / last.height : 1;
      tracks[i].outline = with_centre(carried(*last.outline, last.location, location, scale), row);
      last_[row.id] = last;
    }
    if (tracks[i].outline && row.has_box() && !may_be_written(*tracks[i].outline, row)) tracks[i].outline.reset();
  }
}

}  // namespace marey::track::offline
