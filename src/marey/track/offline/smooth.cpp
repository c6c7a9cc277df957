#include "marey/track/offline/smooth.h"

#include <cmath>

namespace marey::track::offline {
namespace {

using Tracklet = TrackletLog::Tracklet;

/// Values of one quantity, fitted at time 0 by value + slope · t under weights.
class LocalLine {
 public:
  void add(double t, double weight, double value) {
    w_ += weight;
    wt_ += weight * t;
    wtt_ += weight * t * t;
    wv_ += weight * value;
    wtv_ += weight * t * value;
  }
  double slope() const {
    const double spread = wtt_ - wt_ * wt_ / w_;
    return spread > 1e-12 ? (wtv_ - wt_ * wv_ / w_) / spread : 0.0;
  }
  double value() const { return wv_ / w_ - slope() * wt_ / w_; }
  double mean() const { return wv_ / w_; }
  double weight() const { return w_; }

 private:
  double w_ = 0, wt_ = 0, wtt_ = 0, wv_ = 0, wtv_ = 0;
};

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
  LocalLine x, y, early, late;
  around(rows, times, k, sigma, [&](const TrackRow& other, double t, double weight) {
    if (!other.has_centre) return;
    x.add(t, weight, other.centre_x);
    y.add(t, weight, other.centre_y);
    (t < 0 ? early : late).add(t, weight, 0);
  });
  row.has_centre = row.has_centre || (early.weight() > 0 && late.weight() > 0);
  if (!row.has_centre) return;
  row.centre_x = static_cast<float>(x.value());
  row.centre_y = static_cast<float>(y.value());
}

}  // namespace

void smooth(Tracklet& rows, const TrackletLog& log, const Smoothing& smoothing) {
  std::vector<double> times;
  times.reserve(rows.size());
  for (const TrackRow& row : rows) times.push_back(seconds(log.time_of(row.frame)));
  const Tracklet before = rows;
  for (std::size_t k = 0; k < rows.size(); ++k) {
    LocalLine x, y, fast_x, fast_y, centre_x, centre_y, width, height;
    around(before, times, k, smoothing.location, [&](const TrackRow& row, double t, double weight) {
      x.add(t, weight, row.x);
      y.add(t, weight, row.y);
      centre_x.add(t, weight, row.left + row.width / 2);
      centre_y.add(t, weight, row.top + row.height / 2);
    });
    around(before, times, k, smoothing.velocity, [&](const TrackRow& row, double t, double weight) {
      fast_x.add(t, weight, row.x);
      fast_y.add(t, weight, row.y);
    });
    around(before, times, k, smoothing.size, [&](const TrackRow& row, double t, double weight) {
      width.add(t, weight, row.width);
      height.add(t, weight, row.height);
    });
    TrackRow& row = rows[k];
    smooth_outline(before, times, k, smoothing.location, row);
    row.x = static_cast<float>(x.value());
    row.y = static_cast<float>(y.value());
    row.vx = static_cast<float>(fast_x.slope());
    row.vy = static_cast<float>(fast_y.slope());
    if (!row.has_box()) continue;
    row.width = static_cast<float>(width.mean());
    row.height = static_cast<float>(height.mean());
    row.left = static_cast<float>(centre_x.value() - row.width / 2);
    row.top = static_cast<float>(centre_y.value() - row.height / 2);
  }
}

}  // namespace marey::track::offline
