// The format marks a missing point by a fourth word of −1. Some programs write (0, 0, 0) alone. A real coordinate is barely ever
// exactly 0 and three are never at once, unless a point is the origin itself: it was put there, or its numbers are coarse and it
// rests there. So a run of exact zeros is a position if the marker comes from there and goes there, at the speed that it has before
// and behind the run, and missing if it would leap. A marker that is at the origin throughout has neither before nor behind: it is
// missing if the file shows that its program writes zeros (others leap, or several markers would be at one place), unless it has a
// residual or cameras, or is labelled as an origin; without such signs it is kept.
#include "marey/format/motion/c3d_zeros.h"

#include <algorithm>
#include <cctype>
#include <iterator>

#include <fmt/format.h>

namespace marey::format::motion {
namespace {

/// Between a marker's last steps and the one into the run. It bounds the acceleration alone: one that moves evenly needs 1.
constexpr double kMaxStepRatio = 3;

bool is_zero(const C3dPointWords& points, std::size_t frame, std::size_t point) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (points.coordinate(frame, point, axis) != 0) return false;
  }
  return true;
}

/// Whether a marker can be at the origin `gap` frames from `nearest`, which has it elsewhere, by its step from the frame beyond
/// that.
bool leads_to_origin(const C3dPointWords& points, std::size_t point, std::size_t nearest, std::ptrdiff_t beyond, std::size_t gap) {
  const Vector<3> position = points.position(nearest, point);
  double step = 0;
  if (beyond >= 0 && beyond < static_cast<std::ptrdiff_t>(points.layout().frames)) {
    const auto other = static_cast<std::size_t>(beyond);
    const Vector<3> from = points.position(other, point);
    if (points.fourth_word(other, point) >= 0 && from.allFinite() && !from.isZero(0)) step = (position - from).norm();
  }
  return position.norm() <= kMaxStepRatio * step * static_cast<double>(gap) + 2 * points.layout().scale;
}

bool labels_an_origin(const std::string& label) {
  std::string name = label.substr(label.find(':') == std::string::npos ? 0 : label.find(':') + 1);
  std::transform(name.begin(), name.end(), name.begin(),
                 [](unsigned char letter) { return static_cast<char>(std::tolower(letter)); });
  return name == "o" || name == "lab" || name == "world" || name == "global" || name.find("orig") != std::string::npos;
}

}  // namespace

C3dZeros::C3dZeros(const C3dPointWords& points, std::span<const TrackName> tracks) : missing_(points.layout().points) {
  std::vector<Marker> markers;
  for (const TrackName& track : tracks) {
    const int id = number(track.id);
    if (id < 1 || id > std::ssize(missing_)) continue;
    Marker& marker = markers.emplace_back();
    marker.point = static_cast<std::size_t>(id) - 1;
    marker.label = &track.label;
  }
  bool marks_missing = false;
  scan(points, markers, marks_missing);
  assess(points, markers, marks_missing);
}

bool C3dZeros::missing(std::size_t frame, std::size_t point) const {
  const auto& runs = missing_[point];
  const auto behind =
      std::upper_bound(runs.begin(), runs.end(), frame, [](std::size_t at, const Range& run) { return at < run.first; });
  return behind != runs.begin() && frame < std::prev(behind)->second;
}

void C3dZeros::scan(const C3dPointWords& points, std::vector<Marker>& markers, bool& marks_missing) {
  for (std::size_t frame = 0; frame < points.layout().frames; ++frame) {
    for (Marker& marker : markers) {
      const int word = points.fourth_word(frame, marker.point);
      if (word < 0) {
        marks_missing = true;
      } else if (!is_zero(points, frame, marker.point)) {
        if (!points.position(frame, marker.point).allFinite()) continue;
        for (; marker.open < marker.zeros.size(); ++marker.open) marker.zeros[marker.open].behind = frame;
        marker.elsewhere = frame;
      } else {
        marker.measured = marker.measured || word > 0;
        if (marker.zeros.empty() || marker.zeros.back().frames.second != frame)
          marker.zeros.push_back({.frames = {frame, frame}, .before = marker.elsewhere});
        marker.zeros.back().frames.second = frame + 1;
      }
    }
  }
}

/// A run of zeros is a position if the frames before and behind it lead there, as far as there are any.
bool C3dZeros::is_position(const C3dPointWords& points, std::size_t point, const Run& run) {
  const auto at = [](std::size_t frame) { return static_cast<std::ptrdiff_t>(frame); };
  const bool from_there =
      !run.before || leads_to_origin(points, point, *run.before, at(*run.before) - 1, run.frames.first - *run.before);
  const bool to_there =
      !run.behind || leads_to_origin(points, point, *run.behind, at(*run.behind) + 1, *run.behind + 1 - run.frames.second);
  return from_there && to_there;
}

void C3dZeros::assess(const C3dPointWords& points, std::vector<Marker>& markers, bool marks_missing) {
  bool writes_zeros = false;  // for missing points
  std::vector<Marker*> throughout;
  for (Marker& marker : markers) {
    if (marker.zeros.empty()) continue;
    if (!marker.elsewhere) {
      throughout.push_back(&marker);
      continue;
    }
    for (const Run& run : marker.zeros) {
      if (!is_position(points, marker.point, run)) missing_[marker.point].push_back(run.frames);
    }
    writes_zeros = writes_zeros || !missing_[marker.point].empty();
  }
  const auto unmeasured =
      std::count_if(throughout.begin(), throughout.end(), [](const Marker* marker) { return !marker->measured; });
  const bool lone = unmeasured == 1 && (marks_missing || !writes_zeros);
  std::vector<const Marker*> kept;
  for (Marker* marker : throughout) {
    if (marker->measured || lone || labels_an_origin(*marker->label)) {
      kept.push_back(marker);
    } else {
      for (const Run& run : marker->zeros) missing_[marker->point].push_back(run.frames);
    }
  }
  announce(kept, points.layout().frames * markers.size());
}

void C3dZeros::announce(const std::vector<const Marker*>& kept, std::size_t all_points) {
  std::size_t count = 0, of_markers = 0;
  for (const auto& runs : missing_) {
    of_markers += runs.empty() ? 0 : 1;
    for (const Range& run : runs) count += run.second - run.first;
  }
  if (count > 0) {
    warnings_.push_back(fmt::format(
        "{} of its {} points, of {} markers, are exactly (0, 0, 0) far from where the marker is otherwise, and are not marked as "
        "missing; they are read as missing",
        count, all_points, of_markers));
  }
  if (kept.empty()) return;
  const std::string& label = *kept.front()->label;
  warnings_.push_back(
      fmt::format("{}{} at exactly (0, 0, 0) throughout and kept as a marker of the origin; if it was never seen, exclude it",
                  label.empty() ? fmt::format("point {}", kept.front()->point + 1) : "\"" + label.substr(0, 40) + "\"",
                  kept.size() == 1 ? " is" : fmt::format(" and {} more are", kept.size() - 1)));
}

}  // namespace marey::format::motion
