#include "marey/calibrate/people/people_views.h"

#include <algorithm>
#include <limits>

namespace marey::calibrate::people {
namespace {

constexpr double kMaxGrid_hz = 30;  // numerical, time against precision

}  // namespace

std::optional<Vector<2>> PeopleViews::pixel(const PointRow& row, std::size_t camera, double later_frames) const {
  const CameraPeople& one = cameras[camera];
  const double frame = (row.time_s - offsets_s[camera]) * one.rate_hz + later_frames;
  for (std::size_t p = 0; p < one.people.size(); ++p) {
    if (identity[camera][p] != row.person) continue;
    if (auto found = one.people[p].at(frame, row.point)) return found;
  }
  return std::nullopt;
}

std::vector<PointRow> PeopleViews::rows() const {
  double begin = std::numeric_limits<double>::infinity(), end = -begin, rate_hz = 0;
  std::size_t points = 0;
  for (std::size_t c = 0; c < cameras.size(); ++c) {
    rate_hz = std::max(rate_hz, cameras[c].rate_hz);
    for (const ImagePerson& person : cameras[c].people) {
      for (const auto& frame : person.frames) points = std::max(points, frame.size());
      begin = std::min(begin, static_cast<double>(person.first) / cameras[c].rate_hz + offsets_s[c]);
      end = std::max(end, static_cast<double>(person.end()) / cameras[c].rate_hz + offsets_s[c]);
    }
  }
  const double step_s = 1 / std::min(kMaxGrid_hz, rate_hz);
  std::vector<PointRow> found;
  for (double time = begin; time < end; time += step_s) {
    for (int person = 0; person < people; ++person) {
      for (std::size_t i = 0; i < points; ++i) {
        const PointRow row{person, time, i};
        int seen_by = 0;
        for (std::size_t c = 0; c < cameras.size(); ++c) seen_by += pixel(row, c, 0) ? 1 : 0;
        if (seen_by >= 2) found.push_back(row);
      }
    }
  }
  return found;
}

std::vector<PointRow> some_of(const std::vector<PointRow>& rows, std::size_t maximum) {
  if (rows.size() <= maximum) return rows;
  std::vector<PointRow> some;
  for (std::size_t k = 0; k < maximum; ++k) some.push_back(rows[(2 * k + 1) * rows.size() / (2 * maximum)]);
  return some;
}

std::vector<PointRow> some_instants(const std::vector<PointRow>& rows, std::size_t number) {
  if (rows.size() <= number) return rows;
  std::vector<std::size_t> first;  // row of each instant
  for (std::size_t r = 0; r < rows.size(); ++r) {
    if (r == 0 || rows[r].time_s != rows[r - 1].time_s) first.push_back(r);
  }
  const std::size_t instants = first.size(), taken = std::max<std::size_t>(1, number * instants / rows.size());
  first.push_back(rows.size());
  std::vector<PointRow> some;
  for (std::size_t k = 0; k < taken; ++k) {
    const std::size_t instant = (2 * k + 1) * instants / (2 * taken);
    for (std::size_t r = first[instant]; r < first[instant + 1]; ++r) some.push_back(rows[r]);
  }
  return some;
}

}  // namespace marey::calibrate::people
