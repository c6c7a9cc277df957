#include "marey/track/smooth.h"

#include <array>
#include <cmath>

namespace marey::track {
namespace {

using Tracklet = TrackletLog::Tracklet;

float between(float a, float b, double share) {
  return static_cast<float>(a + share * (static_cast<double>(b) - a));
}

TrackRow interpolated(const TrackRow& a, const TrackRow& b, std::int32_t frame, double share) {
  TrackRow row = a;
  row.frame = frame;
  row.x = between(a.x, b.x, share);
  row.y = between(a.y, b.y, share);
  row.vx = between(a.vx, b.vx, share);
  row.vy = between(a.vy, b.vy, share);
  row.left = between(a.left, b.left, share);
  row.top = between(a.top, b.top, share);
  row.width = between(a.width, b.width, share);
  row.height = between(a.height, b.height, share);
  row.score = between(a.score, b.score, share);
  row.state = Track<2>::State::predicted;
  row.has_centre = false;
  return row;
}

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

void fill_gaps(Tracklet& rows, const TrackletLog& log, double longest) {
  Tracklet filled;
  filled.reserve(rows.empty() ? 0 : static_cast<std::size_t>(rows.back().frame - rows.front().frame + 1));
  for (const TrackRow& row : rows) {
    if (!row.observed()) continue;
    if (!filled.empty()) {
      const TrackRow last = filled.back();
      const Duration gap = log.time_of(row.frame) - log.time_of(last.frame);
      for (std::int32_t frame = last.frame + 1; frame < row.frame && seconds(gap) <= longest; ++frame) {
        const double share = seconds(log.time_of(frame) - log.time_of(last.frame)) / seconds(gap);
        filled.push_back(interpolated(last, row, frame, share));
      }
    }
    filled.push_back(row);
  }
  rows = std::move(filled);
}

void smooth(Tracklet& rows, const TrackletLog& log, const Smoothing& smoothing) {
  std::vector<double> times;
  times.reserve(rows.size());
  for (const TrackRow& row : rows) times.push_back(seconds(log.time_of(row.frame)));
  const Tracklet before = rows;
  for (std::size_t k = 0; k < rows.size(); ++k) {
    LocalLine x, y, centre_x, centre_y, width, height;
    around(before, times, k, smoothing.place, [&](const TrackRow& row, double t, double weight) {
      x.add(t, weight, row.x);
      y.add(t, weight, row.y);
      centre_x.add(t, weight, row.left + row.width / 2);
      centre_y.add(t, weight, row.top + row.height / 2);
    });
    around(before, times, k, smoothing.size, [&](const TrackRow& row, double t, double weight) {
      width.add(t, weight, row.width);
      height.add(t, weight, row.height);
    });
    TrackRow& row = rows[k];
    smooth_outline(before, times, k, smoothing.place, row);
    row.x = static_cast<float>(x.value());
    row.y = static_cast<float>(y.value());
    row.vx = static_cast<float>(x.slope());
    row.vy = static_cast<float>(y.slope());
    if (!row.has_box()) continue;
    row.width = static_cast<float>(width.mean());
    row.height = static_cast<float>(height.mean());
    row.left = static_cast<float>(centre_x.value() - row.width / 2);
    row.top = static_cast<float>(centre_y.value() - row.height / 2);
  }
}

}  // namespace marey::track
