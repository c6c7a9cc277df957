#include "marey/calibrate/rig_report.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <fmt/core.h>

#include "marey/calibrate/rays.h"
#include "marey/geometry/median.h"

namespace marey::calibrate {
namespace {

constexpr int kColumns = 10, kRows = 8;  // parts of an image whose coverage is counted
constexpr double kMm = 1000;

std::vector<Camera> cameras_of(const bundle::Bundle& bundle, const std::vector<cv::Size>& sizes) {
  std::vector<Camera> cameras;
  for (std::size_t c = 0; c < bundle.cameras.size(); ++c) {
    cameras.emplace_back(bundle.cameras[c].lens, bundle.cameras[c].camera_from_world, sizes[c]);
  }
  return cameras;
}

/// Sums of 2-D distances.
struct Sum {
  double distance = 0, square = 0;
  int inliers = 0, observations = 0;

  void add(double error, bool inlier) {
    ++observations;
    if (!inlier) return;
    ++inliers;
    distance += error;
    square += error * error;
  }

  FitQuality quality() const {
    const double n = std::max(1, inliers);
    return {distance / n, std::sqrt(square / n), inliers, observations};
  }
};

/// Standard deviation of a point's place over all axes, m; nothing if fewer than two cameras see it.
std::optional<double> point_deviation(const std::vector<Camera>& cameras, const Vector<3>& point, double noise_px, int& observing) {
  Matrix<3> information = Matrix<3>::Zero();
  observing = 0;
  for (const Camera& camera : cameras) {
    const auto detected = camera.project_with_jacobian(point);
    if (!detected || !camera.in_image(detected->pixel)) continue;
    ++observing;
    information += detected->by_world.transpose() * detected->by_world;
  }
  if (observing < 2) return std::nullopt;
  return noise_px * std::sqrt(information.inverse().trace());
}

VolumeReport volume_of(const std::vector<Camera>& cameras, const std::vector<Vector<3>>& points, double noise_px) {
  VolumeReport volume;
  if (points.empty()) return volume;
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<double> values;
    for (const auto& point : points) values.push_back(point[axis]);
    volume.low[axis] = geometry::quantile(values, 0.05);
    volume.high[axis] = geometry::quantile(values, 0.95);
  }
  constexpr int steps = 9;
  std::vector<double> deviations;
  int two = 0, three = 0;
  for (int x = 0; x < steps; ++x) {
    for (int y = 0; y < steps; ++y) {
      for (int z = 0; z < steps; ++z) {
        const Vector<3> at = (Vector<3>(x, y, z) + Vector<3>::Constant(0.5)) / steps;
        int observing = 0;
        const auto deviation =
            point_deviation(cameras, volume.low + at.cwiseProduct(volume.high - volume.low), noise_px, observing);
        if (deviation) deviations.push_back(*deviation * kMm);
        two += observing >= 2 ? 1 : 0;
        three += observing >= 3 ? 1 : 0;
      }
    }
  }
  constexpr double all = steps * steps * steps;
  volume.median_mm = geometry::quantile(deviations, 0.5);
  volume.worst_tenth_mm = geometry::quantile(deviations, 0.9);
  volume.observed_by_two = two / all;
  volume.observed_by_three = three / all;
  return volume;
}

int part_of(const Vector<2>& pixel, cv::Size size) {
  const int column = std::clamp(static_cast<int>((pixel.x() + 0.5) / size.width * kColumns), 0, kColumns - 1);
  const int row = std::clamp(static_cast<int>((pixel.y() + 0.5) / size.height * kRows), 0, kRows - 1);
  return row * kColumns + column;
}

/// Gauss-Newton on the reprojection of one point.
std::optional<Vector<3>> refined_point(const std::vector<const Camera*>& cameras, const std::vector<Vector<2>>& pixels,
                                       Vector<3> point) {
  for (int i = 0; i < 5; ++i) {
    Matrix<3> normal = Matrix<3>::Zero();
    Vector<3> right = Vector<3>::Zero();
    for (std::size_t k = 0; k < cameras.size(); ++k) {
      const auto detected = cameras[k]->project_with_jacobian(point);
      if (!detected) return std::nullopt;
      normal += detected->by_world.transpose() * detected->by_world;
      right += detected->by_world.transpose() * (pixels[k] - detected->pixel);
    }
    point += normal.ldlt().solve(right);
  }
  return point;
}

/// A marker that was not adjusted, by the cameras that agree on it.
struct HeldOutPoint {
  Vector<3> location = Vector<3>::Zero();
  std::vector<const Camera*> observing;
  std::vector<Vector<2>> pixels;
};

std::optional<HeldOutPoint> held_out_point(const bundle::Bundle& bundle, const std::vector<Camera>& cameras,
                                           std::span<const bundle::BundleObservation* const> detected) {
  constexpr double kAgreed = 5;  // px
  HeldOutPoint found;
  std::vector<SightLine> lines;
  for (const bundle::BundleObservation* one : detected) {
    const Camera& camera = cameras[static_cast<std::size_t>(one->camera)];
    const Vector<2> pixel = one->pixel - one->velocity * bundle.cameras[static_cast<std::size_t>(one->camera)].offset_s;
    const auto ray = camera.ray(pixel);
    if (!ray) continue;
    lines.push_back({*ray, 1 / geometry::focal_of(camera.lens()).x()});
    found.observing.push_back(&camera);
    found.pixels.push_back(pixel);
  }
  const auto start = agreed_point(lines, kAgreed);
  if (!start) return std::nullopt;
  for (std::size_t k = lines.size(); k-- > 0;) {
    if (angle_off(lines[k], *start) <= kAgreed) continue;
    found.observing.erase(found.observing.begin() + static_cast<std::ptrdiff_t>(k));
    found.pixels.erase(found.pixels.begin() + static_cast<std::ptrdiff_t>(k));
  }
  const auto point = refined_point(found.observing, found.pixels, *start);
  if (!point) return std::nullopt;
  found.location = *point;
  return found;
}

using HeldOutPositions = std::map<int, std::map<int, Vector<3>>>;  // by body, marker

/// By how much the wand's length is off where both of its ends were placed.
void evaluate_lengths(const HeldOutPositions& locations, const std::vector<double>& wand, HeldOutReport& report) {
  double mean = 0, square = 0;
  int lengths = 0;
  const int last = static_cast<int>(wand.size()) - 1;
  for (const auto& [body, at] : locations) {
    if (last < 1 || !at.contains(0) || !at.contains(last)) continue;
    const double off = kMm * ((at.at(last) - at.at(0)).norm() - wand.back());
    mean += off;
    square += off * off;
    ++lengths;
  }
  report.length_mean_mm = mean / std::max(1, lengths);
  report.length_rms_mm = std::sqrt(square / std::max(1, lengths));
}

}  // namespace

RigReport report_on(const bundle::Bundle& bundle, const bundle::BundleResult& fit, const std::vector<std::string>& names,
                    const std::vector<cv::Size>& sizes) {
  const auto errors = bundle::errors_of(bundle);
  std::vector<Sum> sums(bundle.cameras.size());
  std::vector<double> world(bundle.cameras.size(), 0);
  std::vector<std::set<int>> parts(bundle.cameras.size());
  std::vector<Vector<3>> points;
  Sum all;
  for (std::size_t i = 0; i < errors.size(); ++i) {
    const bundle::BundleObservation& detected = bundle.observations[i];
    const auto c = static_cast<std::size_t>(detected.camera);
    const double error = errors[i] ? errors[i]->norm() : 0;
    sums[c].add(error, fit.inlier[i]);
    all.add(error, fit.inlier[i]);
    if (!fit.inlier[i]) continue;
    const Vector<3> point = bundle::marker_position(bundle, detected);
    points.push_back(point);
    parts[c].insert(part_of(detected.pixel, sizes[c]));
    world[c] += error * (bundle.cameras[c].camera_from_world * point).norm() / geometry::focal_of(bundle.cameras[c].lens).x();
  }
  RigReport report;
  report.all = all.quality();
  report.noise_px = fit.noise_px;
  for (std::size_t c = 0; c < names.size(); ++c) {
    CameraReport camera{names[c], sums[c].quality()};
    camera.coverage = static_cast<double>(parts[c].size()) / (kColumns * kRows);
    camera.world_error_mm = kMm * world[c] / std::max(1, camera.fit.inliers);
    if (c < fit.deviations.size()) camera.deviation = fit.deviations[c];
    report.cameras.push_back(camera);
  }
  report.volume = volume_of(cameras_of(bundle, sizes), points, fit.noise_px);
  return report;
}

HeldOutReport evaluate_held_out(const bundle::Bundle& bundle, const std::vector<cv::Size>& sizes) {
  const auto cameras = cameras_of(bundle, sizes);
  std::map<std::pair<int, int>, std::vector<const bundle::BundleObservation*>> markers;  // by body and marker
  for (const bundle::BundleObservation& detected : bundle.observations)
    markers[{detected.body, detected.marker}].push_back(&detected);
  HeldOutPositions locations;
  HeldOutReport report;
  Sum sum;
  int unknowns = 0;
  for (const auto& [key, detected] : markers) {
    const auto point = held_out_point(bundle, cameras, detected);
    if (!point) continue;
    unknowns += 3;
    locations[key.first][key.second] = point->location;
    for (std::size_t k = 0; k < point->observing.size(); ++k) {
      const auto again = point->observing[k]->project(point->location);
      if (again) sum.add((*again - point->pixels[k]).norm(), true);
    }
  }
  report.frames = static_cast<int>(locations.size());
  report.fit = sum.quality();
  report.noise_px = std::sqrt(sum.square / std::max(1, 2 * sum.inliers - unknowns));
  evaluate_lengths(locations, bundle.wand, report);
  return report;
}

}  // namespace marey::calibrate
