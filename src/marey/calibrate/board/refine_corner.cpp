// Where two edges cross, to a fraction of a pixel: along an edge the gradient stands across the line to the crossing, so the
// crossing p minimises Σ w (g · (q − p))² over the pixels q around it (Förstner & Gülch 1987; OpenCV's cornerSubPix). A pixel
// counts the more the nearer it is, and only where its edge leads past the crossing found so far: other edges within the window,
// such as the border of a board whose outer squares are cut short, would draw it away by several pixels. Cost: the window, some ten
// times.
#include "marey/calibrate/board/refine_corner.h"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

namespace marey::calibrate::board {
namespace {

constexpr int kMinHalf = 3, kMaxHalf = 12;  // px
constexpr double kFraction = 0.4;           // of the distance to the next corner
constexpr int kMaxIterations = 30;          // numerical: it ends earlier where it settles
constexpr double kEdgeWidth = 1.5;          // px: how far a blurred edge reaches to each side
constexpr double kMinCross = 0.02;          // of det/trace²: below, all edges are parallel

struct Sums {
  Matrix<2> A = Matrix<2>::Zero();
  Vector<2> b = Vector<2>::Zero();
};

/// Sums of the least squares over the window around `p`; an edge that passes `p` at more than about `reach` px is omitted.
Sums sums_around(const cv::Mat& grey, const Vector<2>& p, int half, double reach) {
  Sums sums;
  const int column = static_cast<int>(std::lround(p.x())), row = static_cast<int>(std::lround(p.y()));
  for (int y = row - half; y <= row + half; ++y) {
    const auto* above = grey.ptr<unsigned char>(y - 1);
    const auto* here = grey.ptr<unsigned char>(y);
    const auto* below = grey.ptr<unsigned char>(y + 1);
    for (int x = column - half; x <= column + half; ++x) {
      const double gx = 10 * (here[x + 1] - here[x - 1]) + 3 * (above[x + 1] - above[x - 1] + below[x + 1] - below[x - 1]);
      const double gy = 10 * (below[x] - above[x]) + 3 * (below[x - 1] - above[x - 1] + below[x + 1] - above[x + 1]);
      const double square = gx * gx + gy * gy;
      if (square == 0) continue;
      const Vector<2> g(gx, gy), aside = Vector<2>(x, y) - p;
      const double passes = g.dot(aside) * g.dot(aside) / square;
      const double past = 1 + passes / (reach * reach);
      const double weight = std::exp(-aside.squaredNorm() / (half * half)) / (past * past);
      sums.A += weight * g * g.transpose();
      sums.b += weight * g * g.dot(aside);
    }
  }
  return sums;
}

bool within(const cv::Mat& grey, const Vector<2>& p, int half) {
  return p.x() >= half + 1 && p.y() >= half + 1 && p.x() <= grey.cols - 2 - half && p.y() <= grey.rows - 2 - half;
}

}  // namespace

std::optional<Vector<2>> refine_corner(const cv::Mat& grey, const Vector<2>& start, double spacing) {
  const int half = std::clamp(static_cast<int>(std::lround(kFraction * spacing)), kMinHalf, kMaxHalf);
  const double farthest = std::max(1.5, 0.3 * spacing);
  Vector<2> p = start;
  double reach = std::max(kEdgeWidth, half / 3.0);
  for (int round = 0; round < kMaxIterations; ++round) {
    if (!within(grey, p, half)) return std::nullopt;
    const Sums sums = sums_around(grey, p, half, reach);
    const double trace = sums.A.trace();
    if (!(sums.A.determinant() > kMinCross * trace * trace)) return std::nullopt;
    const Vector<2> step = sums.A.inverse() * sums.b;
    p += step;
    if ((p - start).norm() > farthest) return std::nullopt;
    if (step.norm() < 1e-3 && reach <= kEdgeWidth) break;
    reach = std::max(kEdgeWidth, 0.8 * reach);
  }
  return p;
}

double opposite_likeness(const cv::Mat& grey, const Vector<2>& pixel, double radius) {
  const int half = std::max(kMinHalf, static_cast<int>(std::lround(radius)));
  if (!within(grey, pixel, half)) return 0;
  const auto at = [&](double x, double y) {
    const int column = static_cast<int>(std::floor(x)), row = static_cast<int>(std::floor(y));
    const double right = x - column, down = y - row;
    const auto* above = grey.ptr<unsigned char>(row) + column;
    const auto* below = grey.ptr<unsigned char>(row + 1) + column;
    return (1 - down) * ((1 - right) * above[0] + right * above[1]) + down * ((1 - right) * below[0] + right * below[1]);
  };
  double sum = 0, square = 0, product = 0;
  int count = 0;
  for (int y = -half; y <= half; ++y) {
    for (int x = -half; x <= half; ++x) {
      if (x * x + y * y > half * half) continue;
      const double here = at(pixel.x() + x, pixel.y() + y), opposite = at(pixel.x() - x, pixel.y() - y);
      sum += here;
      square += here * here;
      product += here * opposite;
      ++count;
    }
  }
  const double mean = sum / count, variance = square / count - mean * mean;
  return variance > 1 ? (product / count - mean * mean) / variance : 0;
}

}  // namespace marey::calibrate::board
