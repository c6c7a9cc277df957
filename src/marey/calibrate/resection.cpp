#include "marey/calibrate/resection.h"

#include <algorithm>
#include <cmath>
#include <random>

#include <Eigen/Geometry>
#include <opencv2/calib3d.hpp>

#include "marey/calibrate/draw_below.h"

namespace marey::calibrate {
namespace {

constexpr double kWandGate = 4;    // standard deviations within which a wand is explained
constexpr double kMinAhead = 0.2;  // of a bearing's z, to be used in OpenCV's plane of images
constexpr std::size_t kMinWands = 4;

/// Mean squared angle of a wand in units of the noise, in the better orientation.
double error(const Rigid3& pose, const MarkObservation& wand, const ResectionOptions& options, bool& rotated) {
  double best = 0;
  rotated = false;
  for (const bool turn : {false, true}) {
    if (turn && !options.reversible) break;
    double sum = 0;
    for (std::size_t m = 0; m < options.markers; ++m) {
      const Vector<3> to = pose * wand.world[m];
      const Vector<3>& bearing = wand.bearing[turn ? options.markers - 1 - m : m];
      sum += std::pow(std::atan2(bearing.cross(to).norm(), bearing.dot(to)) / options.sigma, 2);
    }
    if (!turn || sum < best) best = sum, rotated = turn;
  }
  return best / static_cast<double>(options.markers);
}

double cost(const Rigid3& pose, std::span<const MarkObservation> wands, const ResectionOptions& options) {
  double sum = 0;
  bool rotated = false;
  for (const MarkObservation& wand : wands) sum += std::min(kWandGate * kWandGate, error(pose, wand, options, rotated));
  return sum;
}

/// Poses by three drawn markers of three wands.
std::vector<Rigid3> propose(std::span<const MarkObservation> wands, const ResectionOptions& options, std::mt19937_64& engine) {
  std::vector<cv::Point3d> points;
  std::vector<cv::Point2d> detected;
  for (int i = 0; i < 3; ++i) {
    const MarkObservation& wand = wands[draw_below(engine, wands.size())];
    const std::size_t marker = draw_below(engine, options.markers);
    const bool rotated = options.reversible && draw_below(engine, 2) == 1;
    const Vector<3>& bearing = wand.bearing[rotated ? options.markers - 1 - marker : marker];
    if (bearing.z() < kMinAhead) return {};
    points.emplace_back(wand.world[marker].x(), wand.world[marker].y(), wand.world[marker].z());
    detected.emplace_back(bearing.x() / bearing.z(), bearing.y() / bearing.z());
  }
  std::vector<cv::Mat> rotations, translations;
  cv::solveP3P(points, detected, cv::Matx33d::eye(), cv::noArray(), rotations, translations, cv::SOLVEPNP_P3P);
  std::vector<Rigid3> poses;
  for (std::size_t i = 0; i < rotations.size(); ++i) {
    const cv::Mat &r = rotations[i], &t = translations[i];
    const Rigid3 pose{geometry::rotation_from({r.at<double>(0), r.at<double>(1), r.at<double>(2)}),
                      {t.at<double>(0), t.at<double>(1), t.at<double>(2)}};
    if (pose.rotation.allFinite() && pose.translation.allFinite()) poses.push_back(pose);
  }
  return poses;
}

}  // namespace

std::optional<Resection> resect(std::span<const MarkObservation> wands, const ResectionOptions& options) {
  if (wands.size() < kMinWands) return std::nullopt;
  constexpr int max_draws = 1000;
  std::mt19937_64 engine(options.seed);
  Resection best;
  double best_cost = std::numeric_limits<double>::infinity();
  for (int i = 0; i < max_draws; ++i) {
    for (const Rigid3& pose : propose(wands, options, engine)) {
      const double here = cost(pose, wands, options);
      if (here < best_cost) best_cost = here, best.camera_from_world = pose;
    }
    // Nearly everything is explained, and well: more draws bring nothing.
    if (i >= 100 && best_cost < 2 * static_cast<double>(wands.size())) break;
  }
  if (!std::isfinite(best_cost)) return std::nullopt;
  for (const MarkObservation& wand : wands) {
    bool rotated = false;
    best.inlier.push_back(error(best.camera_from_world, wand, options, rotated) <= kWandGate * kWandGate);
    best.rotated.push_back(rotated);
    best.inliers += static_cast<std::size_t>(best.inlier.back());
  }
  if (best.inliers < kMinWands) return std::nullopt;
  return best;
}

}  // namespace marey::calibrate
