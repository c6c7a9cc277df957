// Along the normal of each piece the intensity is read at half pixels; its slope, weighed by nearness to the silhouette's edge, has
// a peak where light changes, found to a part of a pixel by a parabola. Neighbouring pieces must agree: a median over them leaves
// out folds of clothing and lines on the ground. A piece without a clear peak moves as its neighbours do, or stays.
// Cost: a dozen reads a pixel of the outline.
#include "marey/track/contour/intensity_edge.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <optional>

#include "marey/geometry/median.h"

namespace marey::track::contour {
namespace {

constexpr double kStep = 0.5;       // px between readings
constexpr int kReadings = 5;        // to either side
constexpr double kNearness = 1;     // px, standard deviation of a silhouette's edge
constexpr double kTrust = 0.6;      // of light over the silhouette: each is off by a part of a pixel
constexpr double kMinSlope = 3;     // grey levels a px, weighed
constexpr int kNeighbours = 2;      // to either side whose median is taken
constexpr double kTangentSpan = 2;  // px to either side from which a normal is read

double brightness(const cv::Mat& luma, const Vector<2>& at) {
  const double x = std::clamp(at.x(), 0.0, luma.cols - 1.001), y = std::clamp(at.y(), 0.0, luma.rows - 1.001);
  const int left = static_cast<int>(x), top = static_cast<int>(y);
  const double u = x - left, v = y - top;
  const auto* upper = luma.ptr<std::uint8_t>(top) + left;
  const auto* lower = luma.ptr<std::uint8_t>(std::min(top + 1, luma.rows - 1)) + left;
  return (1 - v) * ((1 - u) * upper[0] + u * upper[1]) + v * ((1 - u) * lower[0] + u * lower[1]);
}

/// Points a pixel apart round the polygon.
std::vector<Vector<2>> every_pixel(const std::vector<Vector<2>>& polygon) {
  std::vector<Vector<2>> points;
  double left_over = 0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vector<2>& from = polygon[i];
    const Vector<2> along = polygon[(i + 1) % polygon.size()] - from;
    const double length = along.norm();
    double at = left_over;
    for (; at < length; at += 1) points.emplace_back(from + along * (at / length));
    left_over = at - length;
  }
  return points;
}

std::optional<double> edge_along(const cv::Mat& luma, const Vector<2>& foot, const Vector<2>& normal) {
  std::array<double, 2 * kReadings + 3> value;
  for (int i = 0; i < static_cast<int>(value.size()); ++i) value[i] = brightness(luma, foot + kStep * (i - kReadings - 1) * normal);
  std::array<double, 2 * kReadings + 1> slope;
  std::optional<int> strongest;
  double maximum = kMinSlope;
  for (int i = 0; i <= 2 * kReadings; ++i) slope[i] = std::abs(value[i + 2] - value[i]) / (2 * kStep);
  for (int i = 1; i < 2 * kReadings; ++i) {
    if (slope[i] < slope[i - 1] || slope[i] < slope[i + 1]) continue;
    const double offset = kStep * (i - kReadings);
    const double merit = slope[i] * std::exp(-0.5 * offset * offset / (kNearness * kNearness));
    if (merit > maximum) strongest = i, maximum = merit;
  }
  if (!strongest) return std::nullopt;
  const int best = *strongest;
  const double before = slope[best - 1], here = slope[best], after = slope[best + 1];
  const double bend = before - 2 * here + after;
  return kStep * (best - kReadings + (bend < 0 ? (before - after) / (2 * bend) : 0));
}

}  // namespace

std::vector<Vector<2>> moved_to_intensity_edges(const std::vector<Vector<2>>& polygon, const cv::Mat& luma) {
  if (luma.empty() || luma.type() != CV_8UC1 || polygon.size() < 3) return polygon;
  std::vector<Vector<2>> points = every_pixel(polygon);
  const int count = static_cast<int>(points.size());
  if (count < 8) return polygon;
  const auto wrapped = [count](int i) { return static_cast<std::size_t>((i % count + count) % count); };
  // Where the polygon doubles back a point has no normal, and stays.
  std::vector<Vector<2>> normals(points.size(), Vector<2>::Zero());
  std::vector<std::optional<double>> offsets(points.size());
  const int span = static_cast<int>(kTangentSpan);
  for (int i = 0; i < count; ++i) {
    const Vector<2> along = points[wrapped(i + span)] - points[wrapped(i - span)];
    const double length = along.norm();
    if (!(length > 0.5)) continue;
    normals[i] = Vector<2>(along.y(), -along.x()) / length;
    offsets[i] = edge_along(luma, points[i], normals[i]);
  }
  std::vector<double> near;
  std::vector<Vector<2>> moved = points;
  for (int i = 0; i < count; ++i) {
    near.clear();
    for (int k = -kNeighbours; k <= kNeighbours; ++k) {
      if (const auto& one = offsets[wrapped(i + k)]) near.push_back(*one);
    }
    if (near.size() <= kNeighbours) continue;
    moved[i] += kTrust * geometry::median(near) * normals[i];
  }
  return moved;
}

}  // namespace marey::track::contour
