#include "marey/track/offline/smooth.h"

#include <cmath>

#include "marey/geometry/local_polynomial.h"

namespace marey::track::offline {
namespace {

using Tracklet = TrackletLog::Tracklet;

/// Straight lines of C quantities.
template <int C>
using LocalLines = geometry::LocalPolynomial<2, C>;

constexpr double kernel_reach = 3;        // standard deviations
constexpr double predicted_weight = 0.1;  // beside an observed row's 1

/// Calls visit(row, t, weight) for the rows around rows[k] that the kernel reaches.
template <typename Visit>
void around(const Tracklet& rows, const std::vector<double>& times, std::size_t k, double sigma, Visit&& visit) {
  const auto take = [&](std::size_t i) {
    const double t = times[i] - times[k];
    if (std::abs(t) > kernel_reach * sigma) return false;
    visit(rows[i], t, std::exp(-t * t / (2 * sigma * sigma)) * (rows[i].observed() ? 1 : predicted_weight));
    return true;
  };
  for (std::size_t i = k; take(i) && i > 0; --i) {
  }
  for (std::size_t i = k + 1; i < rows.size() && take(i); ++i) {
  }
}

/// The centre of the outline, from those found round about; a row between two that have one gets one.
void smooth_outline(const Tracklet& rows, const std::vector<double>& times, std::size_t k, double sigma, TrackRow& row) {
  LocalLines<2> centre;
  double early = 0, late = 0;
  around(rows, times, k, sigma, [&](const TrackRow& other, double t, double weight) {
    if (!other.has_centre) return;
    centre.add(t, weight, {other.centre_x, other.centre_y});
    (t < 0 ? early : late) += weight;
  });
  row.has_centre = row.has_centre || (early > 0 && late > 0);
  if (!row.has_centre) return;
  const auto at = centre.fit();
  row.centre_x = static_cast<float>(at(0, 0));
  row.centre_y = static_cast<float>(at(0, 1));
}

}  // namespace

void smooth(Tracklet& rows, const TrackletLog& log, const Smoothing& smoothing) {
  std::vector<double> times;
  times.reserve(rows.size());
  for (const TrackRow& row : rows) times.push_back(seconds(log.time_of(row.frame)));
  const Tracklet before = rows;
  for (std::size_t k = 0; k < rows.size(); ++k) {
    LocalLines<4> location;  // of the place and of the box's centre
    LocalLines<2> velocity, size;
    around(before, times, k, smoothing.location, [&](const TrackRow& row, double t, double weight) {
      location.add(t, weight, {row.x, row.y, row.left + row.width / 2, row.top + row.height / 2});
    });
    around(before, times, k, smoothing.velocity,
           [&](const TrackRow& row, double t, double weight) { velocity.add(t, weight, {row.x, row.y}); });
    around(before, times, k, smoothing.size,
           [&](const TrackRow& row, double t, double weight) { size.add(t, weight, {row.width, row.height}); });
    TrackRow& row = rows[k];
    smooth_outline(before, times, k, smoothing.location, row);
    const auto at = location.fit();
    const auto moving = velocity.fit();
    row.x = static_cast<float>(at(0, 0));
    row.y = static_cast<float>(at(0, 1));
    row.vx = static_cast<float>(moving(1, 0));
    row.vy = static_cast<float>(moving(1, 1));
    if (!row.has_box()) continue;
    row.width = static_cast<float>(size.mean()[0]);
    row.height = static_cast<float>(size.mean()[1]);
    row.left = static_cast<float>(at(0, 2) - row.width / 2);
    row.top = static_cast<float>(at(0, 3) - row.height / 2);
  }
}

}  // namespace marey::track::offline
