#include "experiments/plain_markers.h"

#include <string>

#include <Eigen/LU>
#include <opencv2/imgproc.hpp>

#include "marey/assign/linear_assignment.h"

namespace marey::experiments {
namespace {

constexpr double kAcceleration = 1;  // px a frame²
constexpr double kMeasured = 0.5;    // px
constexpr double kGate = 25;         // variances
constexpr double kNever = 1e6;

}  // namespace

std::vector<Observation<2>> plain_detections(const cv::Mat& image) {
  double brightest = 0;
  cv::minMaxLoc(image, nullptr, &brightest);
  cv::Mat labels, stats, centres;
  const int count = cv::connectedComponentsWithStats(image > brightest / 2, labels, stats, centres);
  std::vector<Observation<2>> detected;
  for (int i = 1; i < count; ++i) {
    if (stats.at<int>(i, cv::CC_STAT_AREA) < 2) continue;
    Observation<2> point;
    point.value = {centres.at<double>(i, 0), centres.at<double>(i, 1)};
    point.covariance = kMeasured * kMeasured * Matrix<2>::Identity();
    detected.push_back(point);
  }
  return detected;
}

std::vector<evaluate::NamedPosition> PlainTracker::step(std::span<const Observation<2>> detected) {
  if (targets_.empty()) {
    for (const Observation<2>& point : detected) {
      Target target;
      target.state << point.value, 0, 0;
      target.covariance = Eigen::Vector4d(kMeasured * kMeasured, kMeasured * kMeasured, 100, 100).asDiagonal();
      targets_.push_back(target);
    }
  } else {
    Eigen::Matrix4d F = Eigen::Matrix4d::Identity(), Q = Eigen::Matrix4d::Zero();
    F(0, 2) = F(1, 3) = 1;
    for (int i = 0; i < 2; ++i) {
      Q(i, i) = 0.25, Q(i, i + 2) = Q(i + 2, i) = 0.5, Q(i + 2, i + 2) = 1;
    }
    std::vector<double> costs;
    for (Target& target : targets_) {
      target.state = F * target.state;
      target.covariance = F * target.covariance * F.transpose() + kAcceleration * kAcceleration * Q;
      const Matrix<2> S = target.covariance.topLeftCorner<2, 2>() + kMeasured * kMeasured * Matrix<2>::Identity();
      for (const Observation<2>& point : detected) {
        const Vector<2> residual = point.value - target.state.head<2>();
        const double cost = residual.dot(S.inverse() * residual);
        costs.push_back(cost < kGate ? cost : kNever + residual.norm());
      }
    }
    assign::LinearAssigner assigner;
    const int columns = static_cast<int>(detected.size());
    const auto column = assigner.assign(static_cast<int>(targets_.size()), columns, costs);
    for (std::size_t row = 0; row < targets_.size(); ++row) {
      if (column[row] == assign::kNoIndex || costs[row * detected.size() + column[row]] >= kNever) continue;
      Target& target = targets_[row];
      const Matrix<2> S = target.covariance.topLeftCorner<2, 2>() + kMeasured * kMeasured * Matrix<2>::Identity();
      const Eigen::Matrix<double, 4, 2> gain = target.covariance.leftCols<2>() * S.inverse();
      target.state += gain * (detected[column[row]].value - target.state.head<2>());
      target.covariance -= gain * target.covariance.topRows<2>();
    }
  }
  std::vector<evaluate::NamedPosition> locations;
  for (std::size_t i = 0; i < targets_.size(); ++i) locations.push_back({std::to_string(i + 1), targets_[i].state.head<2>()});
  return locations;
}

}  // namespace marey::experiments
