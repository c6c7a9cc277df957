#include "marey/geometry/layout.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <Eigen/Geometry>
#include <Eigen/LU>

#include "marey/geometry/decompositions.h"

namespace marey::geometry {
namespace {

constexpr double kFlattest = 0.1;       // height of the triangle over its base, at least
constexpr int kMaxTriangles = 200'000;  // that are tried
constexpr double kAsGood = 1.5;         // misfits within this factor count as equal

/// The two markers farthest apart, and the one farthest from their line, `without` one that may be hidden.
std::optional<std::array<int, 3>> largest_triangle(std::span<const Vector<3>> layout, int without) {
  std::array<int, 3> best{};
  double base = 0;
  for (int a = 0; a < std::ssize(layout); ++a) {
    for (int b = 0; b < a; ++b) {
      if (a == without || b == without) continue;
      if (const double distance = (layout[a] - layout[b]).norm(); distance > base) base = distance, best[0] = a, best[1] = b;
    }
  }
  if (base <= 0) return std::nullopt;
  double height = 0;
  const Vector<3> along = (layout[best[1]] - layout[best[0]]) / base;
  for (int c = 0; c < std::ssize(layout); ++c) {
    const double here = (layout[c] - layout[best[0]]).cross(along).norm();
    if (c != without && here > height) height = here, best[2] = c;
  }
  if (height < kFlattest * base) return std::nullopt;
  return best;
}

/// Gives every marker the nearest point within the tolerance, each point once, the nearest pairs first.
LayoutMatch assign(std::span<const Vector<3>> layout, std::span<const Vector<3>> points, const Rigid3& motion, double tolerance) {
  struct Pair {
    double distance;
    int marker, point;
  };
  std::vector<Pair> pairs;
  for (int m = 0; m < std::ssize(layout); ++m) {
    const Vector<3> location = motion * layout[m];
    for (int p = 0; p < std::ssize(points); ++p) {
      if (const double distance = (points[p] - location).norm(); distance < tolerance) pairs.push_back({distance, m, p});
    }
  }
  std::stable_sort(pairs.begin(), pairs.end(), [](const Pair& a, const Pair& b) { return a.distance < b.distance; });
  LayoutMatch match{motion, std::vector<std::optional<int>>(layout.size()), 0, 0};
  std::vector<char> taken(points.size(), 0);
  double sum = 0;
  for (const Pair& pair : pairs) {
    if (match.point_of[pair.marker] || taken[pair.point]) continue;
    match.point_of[pair.marker] = pair.point;
    taken[pair.point] = 1;
    ++match.matched;
    sum += pair.distance * pair.distance;
  }
  match.rms = match.matched > 0 ? std::sqrt(sum / match.matched) : 0;
  return match;
}

LayoutMatch refine(std::span<const Vector<3>> layout, std::span<const Vector<3>> points, LayoutMatch match, double tolerance) {
  for (int round = 0; round < 3 && match.matched >= 3; ++round) {
    std::vector<Vector<3>> from, to;
    for (std::size_t m = 0; m < layout.size(); ++m) {
      if (!match.point_of[m]) continue;
      from.push_back(layout[m]);
      to.push_back(points[*match.point_of[m]]);
    }
    match = assign(layout, points, rigid_fit(from, to), tolerance);
  }
  return match;
}

bool better(const LayoutMatch& a, const LayoutMatch& b) {
  if (a.matched != b.matched) return a.matched > b.matched;
  if (a.rms > kAsGood * b.rms || b.rms > kAsGood * a.rms) return a.rms < b.rms;
  return a.world_from_layout.rotation.trace() > b.world_from_layout.rotation.trace();
}

/// The best motion of those under which the triangle falls on three points.
std::optional<LayoutMatch> match_triangle(std::span<const Vector<3>> layout, std::span<const Vector<3>> points,
                                          const std::array<int, 3>& triangle, double tolerance) {
  const std::array<Vector<3>, 3> corners = {layout[triangle[0]], layout[triangle[1]], layout[triangle[2]]};
  const double ab = (corners[0] - corners[1]).norm(), ac = (corners[0] - corners[2]).norm(), bc = (corners[1] - corners[2]).norm();
  const auto near = [&](int p, int q, double distance) {
    return std::abs((points[p] - points[q]).norm() - distance) < 2 * tolerance;
  };
  std::optional<LayoutMatch> best;
  int tried = 0;
  for (int p = 0; p < std::ssize(points); ++p) {
    for (int q = 0; q < std::ssize(points); ++q) {
      if (p == q || !near(p, q, ab)) continue;
      for (int r = 0; r < std::ssize(points) && tried < kMaxTriangles; ++r) {
        if (r == p || r == q || !near(p, r, ac) || !near(q, r, bc)) continue;
        ++tried;
        const std::array<Vector<3>, 3> detected = {points[p], points[q], points[r]};
        LayoutMatch match = refine(layout, points, assign(layout, points, rigid_fit(corners, detected), 2 * tolerance), tolerance);
        if (!best || better(match, *best)) best = std::move(match);
      }
    }
  }
  return best;
}

}  // namespace

Rigid3 rigid_fit(std::span<const Vector<3>> from, std::span<const Vector<3>> to) {
  Vector<3> from_mean = Vector<3>::Zero(), to_mean = Vector<3>::Zero();
  for (std::size_t i = 0; i < from.size(); ++i) from_mean += from[i], to_mean += to[i];
  from_mean /= static_cast<double>(from.size());
  to_mean /= static_cast<double>(to.size());
  Matrix<3> time_step = Matrix<3>::Zero();
  for (std::size_t i = 0; i < from.size(); ++i) time_step += (to[i] - to_mean) * (from[i] - from_mean).transpose();
  const SingularValues3 svd = singular_values(time_step);
  Matrix<3> keep = Matrix<3>::Identity();
  keep(2, 2) = (svd.U * svd.V.transpose()).determinant() < 0 ? -1 : 1;
  const Matrix<3> rotation = svd.U * keep * svd.V.transpose();
  return {rotation, to_mean - rotation * from_mean};
}

std::optional<LayoutMatch> match_layout(std::span<const Vector<3>> layout, std::span<const Vector<3>> points, double tolerance,
                                        double fraction) {
  const auto first = largest_triangle(layout, -1);
  if (layout.size() < 3 || !first) return std::nullopt;
  std::optional<LayoutMatch> best;
  // One of the corners may be hidden: then the largest triangle without it is searched for.
  for (const int without : {-1, (*first)[0], (*first)[1], (*first)[2]}) {
    const auto triangle = largest_triangle(layout, without);
    if (!triangle) continue;
    auto match = match_triangle(layout, points, *triangle, tolerance);
    if (match && (!best || better(*match, *best))) best = std::move(match);
    if (best && best->matched >= 3 && best->matched >= fraction * static_cast<double>(layout.size())) return best;
  }
  return std::nullopt;
}

}  // namespace marey::geometry
