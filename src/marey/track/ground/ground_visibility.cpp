#include "marey/track/ground/ground_visibility.h"

#include <algorithm>
#include <numeric>

#include "marey/track/check_frame.h"

namespace marey::track::ground {

void GroundVisibility::check(const CameraObservations& view) const {
  if (number(view.camera) < 0 || number(view.camera) >= cameras())
    throw Error("observations are of camera {}, but the rig has {} cameras; give each camera a view", number(view.camera),
                cameras());
  check_finite(view.time, view.detected);
}

void GroundVisibility::set_view(const CameraObservations& of, double min_score) {
  view_ = &views_->view_at(of.camera, of.time);
  boxes_.clear();
  for (const Observation<2>& one : of.detected) {
    if (one.box && !one.box->empty() && one.score >= min_score) boxes_.push_back(*one.box);
  }
}

double GroundVisibility::visible(const Vector<2>& location) const {
  const auto foot = view_->pixel(location);
  if (!foot) return 0;
  const cv::Size size = view_->size();
  const double inside = std::min({foot->x() + 0.5, foot->y() + 0.5, size.width - 0.5 - foot->x(), size.height - 0.5 - foot->y()});
  if (inside < 0) return 0;
  const double open = covered(*foot) > hidden_fraction ? observed_hidden : 1.0;
  return inside < border * size.width ? 0.5 * open : open;
}

/// The largest share of a body with its foot here that one other box covers, of those that stand nearer to the camera: their feet
/// are lower in the image. One that overlaps another is about as far away and thus as tall.
double GroundVisibility::covered(const Vector<2>& foot) const {
  double maximum = 0;
  for (const Box& other : boxes_) {
    if (other.foot().y() < foot.y()) continue;
    const Box body{foot.x() - (other.width - 1) / 2, foot.y() + 0.5 - other.height, other.width, other.height};
    maximum = std::max(maximum, geometry::intersection(body, other).area() / other.area());
  }
  return maximum;
}

std::vector<int> surest_first(std::span<const CameraObservations> views) {
  std::vector<double> spread;
  for (const CameraObservations& view : views) {
    double sum = 0;
    for (const Observation<2>& one : view.detected) sum += one.covariance->trace();
    spread.push_back(view.detected.empty() ? 0 : sum / static_cast<double>(view.detected.size()));
  }
  std::vector<int> order(views.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](int a, int b) { return spread[static_cast<std::size_t>(a)] < spread[static_cast<std::size_t>(b)]; });
  return order;
}

}  // namespace marey::track::ground
