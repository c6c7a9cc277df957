#include "marey/source/live/device_clock.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace marey::source::live {

void DeviceClock::reset() {
  device_origin_.reset();
  kept_.clear();
  offset_ = slope_ = 0;
}

Timestamp DeviceClock::time_of(Duration device, Timestamp arrival) {
  if (device_origin_) {
    const double now = seconds(device - *device_origin_);
    const double ahead = seconds(arrival - arrival_origin_) - now;
    if (now < last_ || ahead < ahead_at(now) - options_.step_s) {
      ++steps_;
      reset();
    }
  }
  if (!device_origin_) {
    device_origin_ = device;
    arrival_origin_ = arrival;
  }
  const double now = seconds(device - *device_origin_);
  last_ = now;
  keep({now, seconds(arrival - arrival_origin_) - now});
  fit();
  return std::min(arrival, arrival_origin_ + duration_from_seconds(now + ahead_at(now)));
}

void DeviceClock::keep(const Point& point) {
  const auto bucket = [&](const Point& each) { return std::floor(each.device / options_.bucket_s); };
  if (kept_.empty() || bucket(kept_.back()) != bucket(point)) {
    kept_.push_back(point);
  } else if (point.ahead < kept_.back().ahead) {
    kept_.back() = point;
  }
  while (kept_.front().device < point.device - options_.window_s) kept_.pop_front();
}

void DeviceClock::fit() {
  const auto below_all = [&](double slope) {
    double offset = kept_.front().ahead - slope * kept_.front().device;
    for (const Point& point : kept_) offset = std::min(offset, point.ahead - slope * point.device);
    return offset;
  };
  slope_ = 0;
  if (kept_.back().device - kept_.front().device >= options_.settle_s) {
    std::vector<Point> hull;  // the lower one
    double mean = 0;
    for (const Point& point : kept_) {
      mean += point.device / static_cast<double>(kept_.size());
      while (hull.size() >= 2) {
        const Point& a = hull[hull.size() - 2];
        const Point& b = hull.back();
        if ((b.device - a.device) * (point.ahead - a.ahead) > (point.device - a.device) * (b.ahead - a.ahead)) break;
        hull.pop_back();
      }
      hull.push_back(point);
    }
    std::size_t edge = 0;
    while (edge + 2 < hull.size() && hull[edge + 1].device < mean) ++edge;
    const double slope = (hull[edge + 1].ahead - hull[edge].ahead) / (hull[edge + 1].device - hull[edge].device);
    slope_ = std::clamp(slope, -options_.max_drift, options_.max_drift);
  }
  offset_ = below_all(slope_);
}

}  // namespace marey::source::live
