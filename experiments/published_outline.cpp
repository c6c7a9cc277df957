// Arnaut & Costa, "Rastreamento de Jogadores de Futebol em Seqüência de Imagens", TECCEN 2(1), 2009, section 3, after De Bem
// (2007). The paper numbers no equations; in its order:
//   curve        x(u) = Σ xᵢ Bᵢ(u)
//   shape        x_k = v_{k−1} + x_{k−1} + s_{k−1} (x_{k−1} − c_{k−1}), for every control point
//   motion       v and s stay as they are from k − 1 to k
//   measurement  along lines normal to the curve, evenly spread: the variation of light that parts the target from the ground;
//                of the motion filter: the centre's shift, and d_k / d_{k−1} − 1, d from the centre to one control point
// What the paper leaves open is in PublishedOptions. The change of light taken is the largest along the line; every line has one,
// and every one is trusted, so that a line that meets a neighbour pulls the outline there: Figure 6.
#include "experiments/published_outline.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <opencv2/imgproc.hpp>

#include "marey/core/error.h"

namespace marey::experiments {
namespace {

constexpr double kNoGate = 1e12;
constexpr double kInitialDeviation = 1;  // px, of control points from a silhouette
constexpr double kMaxGrowth = 0.5;       // a frame: beyond it the outline is lost, and would only overflow

geometry::ClosedSpline fitted(std::span<const Vector<2>> polygon, const PublishedOptions& options) {
  if (options.order < 2 || options.order > geometry::SplineWeights::max_order ||
      options.control_points < std::max(options.order, 3)) {
    throw Error("{} control points of order {} make no outline; give an order from 2 to {} and as many control points or more",
                options.control_points, options.order, +geometry::SplineWeights::max_order);
  }
  if (options.lines < 1) throw Error("{} measurement lines an outline; give 1 or more", options.lines);
  auto spline =
      geometry::fit_spline(polygon, {.order = options.order, .minimum = options.control_points, .maximum = options.control_points});
  if (!spline) throw Error("a silhouette of {} corners is too small for an outline", polygon.size());
  return std::move(*spline);
}

/// Luma at (x, y), interpolated; at the border for what lies beyond it.
double light(const cv::Mat& luma, const Vector<2>& at) {
  const double x = std::clamp(at.x(), 0.0, luma.cols - 1.0), y = std::clamp(at.y(), 0.0, luma.rows - 1.0);
  const int left = std::min(static_cast<int>(x), luma.cols - 1), top = std::min(static_cast<int>(y), luma.rows - 1);
  const int right = std::min(left + 1, luma.cols - 1), below = std::min(top + 1, luma.rows - 1);
  const double fx = x - left, fy = y - top;
  const auto pixel = [&](int row, int column) { return static_cast<double>(luma.at<std::uint8_t>(row, column)); };
  return (1 - fy) * ((1 - fx) * pixel(top, left) + fx * pixel(top, right)) +
         fy * ((1 - fx) * pixel(below, left) + fx * pixel(below, right));
}

}  // namespace

PublishedOutline::PublishedOutline(const PublishedOptions& options, std::span<const Vector<2>> before,
                                   std::span<const Vector<2>> now)
    : options_(options), shape_(fitted(now, options), kInitialDeviation), locations_(options.lines) {
  const geometry::ClosedSpline earlier = fitted(before, options);
  const geometry::ClosedSpline& spline = shape_.spline();
  centre_ = spline.centroid();
  velocity_ = centre_ - earlier.centroid();
  arm_ = (spline.control_points()[0] - centre_).norm();
  const double arm_before = (earlier.control_points()[0] - earlier.centroid()).norm();
  growth_ = arm_before > 0 ? std::clamp(arm_ / arm_before - 1, -kMaxGrowth, kMaxGrowth) : 0;
  velocity_variance_ = 2 * kInitialDeviation * kInitialDeviation;
  growth_variance_ = options.scale_noise * options.scale_noise;
  report();
}

const Outline& PublishedOutline::step(const Frame& frame) {
  if (time_ && frame.time > *time_) frame_seconds_ = seconds(frame.time - *time_);
  time_ = frame.time;
  shape_.predict(velocity_, growth_, centre_, {.bend = options_.shape_noise});
  velocity_variance_ += options_.velocity_noise * options_.velocity_noise;
  growth_variance_ += options_.scale_noise * options_.scale_noise;
  search(frame.image.luma());
  correct();
  report();
  return outline_;
}

void PublishedOutline::search(const cv::Mat& luma) {
  const geometry::ClosedSpline& spline = shape_.spline();
  spline.evenly_spaced(locations_);
  outline_.lines.clear();
  weights_.clear();
  for (const double location : locations_) {
    const auto normal = spline.normal(location);
    if (!normal) continue;
    MeasurementLine line{.foot = spline.at(location), .normal = *normal, .reach = options_.reach};
    double largest = 0;
    for (double offset = -options_.reach; offset <= options_.reach; offset += 0.5) {
      const double change =
          std::abs(light(luma, line.foot + (offset + 1) * *normal) - light(luma, line.foot + (offset - 1) * *normal));
      if (change <= largest) continue;
      largest = change;
      line.offset = offset;
      line.finding = MeasurementLine::Finding::found;
    }
    line.variance = options_.measurement_noise * options_.measurement_noise;
    outline_.lines.push_back(line);
    weights_.push_back(geometry::spline_weights(spline.order(), spline.count(), location));
  }
}

void PublishedOutline::correct() {
  for (std::size_t i = 0; i < weights_.size(); ++i) {
    const MeasurementLine& line = outline_.lines[i];
    if (line.finding != MeasurementLine::Finding::found) continue;
    shape_.correct(weights_[i], line.normal, line.normal.dot(line.foot) + line.offset, line.variance, kNoGate);
  }
  const Vector<2> centre = shape_.spline().centroid();
  const double arm = (shape_.spline().control_points()[0] - centre).norm();
  const double noise = options_.measurement_noise * options_.measurement_noise;
  const double K = velocity_variance_ / (velocity_variance_ + 2 * noise);
  velocity_ += K * (centre - centre_ - velocity_);
  velocity_variance_ *= 1 - K;
  if (arm_ > 1) {
    const double growth_noise = 2 * noise / (arm_ * arm_);
    const double Ks = growth_variance_ / (growth_variance_ + growth_noise);
    growth_ = std::clamp(growth_ + Ks * (arm / arm_ - 1 - growth_), -kMaxGrowth, kMaxGrowth);
    growth_variance_ *= 1 - Ks;
  }
  centre_ = centre;
  arm_ = arm;
}

void PublishedOutline::report() {
  const geometry::ClosedSpline& spline = shape_.spline();
  const double rate = frame_seconds_ ? 1 / *frame_seconds_ : 1;
  outline_.order = spline.order();
  outline_.control_points = spline.control_points();
  outline_.deviations.resize(spline.count());
  for (int i = 0; i < spline.count(); ++i) outline_.deviations[i] = shape_.deviation(i);
  outline_.centre = centre_;
  outline_.velocity = rate * velocity_;
  outline_.scale_rate = rate * growth_;
  outline_.centre_deviation = shape_.centroid_covariance().diagonal().cwiseMax(0).cwiseSqrt();
  outline_.velocity_deviation = Vector<2>::Constant(rate * std::sqrt(velocity_variance_));
  outline_.scale_rate_deviation = rate * std::sqrt(growth_variance_);
}

}  // namespace marey::experiments
