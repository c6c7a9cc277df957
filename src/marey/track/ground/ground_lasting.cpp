#include "marey/track/ground/ground_lasting.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

#include <Eigen/LU>

#include "marey/geometry/median.h"

namespace marey::track::ground {
namespace {

constexpr std::size_t kMinLinks = 100, kMinChanges = 30;
constexpr double kMinLasting = 0.05, kMaxLasting = 0.6;  // m
constexpr double kNoisiest = 3;
constexpr double kTwoSquaresMedian = 1.386;  // of two degrees
constexpr double kOneSquareMedian = 0.4549;  // of one

/// What two cameras say of one person at two instants, along an axis: their differences' sum and change, squared, m².
struct Squares {
  std::vector<double> sums, changes;

  /// The covariance of the differences at the two instants, m². Sums have twice their variance and twice this, changes twice and
  /// minus twice.
  double covariance() { return (geometry::median(sums) - geometry::median(changes)) / kOneSquareMedian / 4; }
};

/// By axes of the link's own uncertainty, the greater first: along it errors are of one size, where those of north and east would
/// be a mixture of which a median is too small.
using AxisSquares = std::array<Squares, 2>;

void add_link(AxisSquares& to, const Matrix<2>& S, const Vector<2>& sum, const Vector<2>& change) {
  const double angle = std::atan2(2 * S(0, 1), S(0, 0) - S(1, 1)) / 2;
  const Vector<2> major(std::cos(angle), std::sin(angle)), minor(-major.y(), major.x());
  for (std::size_t axis = 0; axis < 2; ++axis) {
    const Vector<2>& along = axis == 0 ? major : minor;
    to[axis].sums.push_back(std::pow(sum.dot(along), 2));
    to[axis].changes.push_back(std::pow(change.dot(along), 2));
  }
}

/// m² per axis and camera, over pairs of cameras; those that meet too rarely count together.
double lasting_variance(std::map<std::pair<int, int>, AxisSquares>& by_cameras) {
  AxisSquares rest;
  double sum = 0, count = 0;
  const auto take = [&](AxisSquares& of) {
    const auto links = static_cast<double>(of[0].sums.size());
    sum += links * (of[0].covariance() + of[1].covariance()) / 4, count += links;  // of two axes, of two cameras
  };
  for (auto& [cameras, of] : by_cameras) {
    if (of[0].sums.size() >= kMinLinks) {
      take(of);
      continue;
    }
    for (std::size_t axis = 0; axis < 2; ++axis) {
      rest[axis].sums.insert(rest[axis].sums.end(), of[axis].sums.begin(), of[axis].sums.end());
      rest[axis].changes.insert(rest[axis].changes.end(), of[axis].changes.begin(), of[axis].changes.end());
    }
  }
  if (!rest[0].sums.empty()) take(rest);
  return std::max(0.0, sum / count);
}

}  // namespace

LastingDisagreement lasting_disagreement(std::span<const LinkedDifferences> links, int cameras) {
  std::map<std::pair<int, int>, AxisSquares> by_cameras;
  std::vector<std::vector<double>> ratios(static_cast<std::size_t>(cameras));
  for (const LinkedDifferences& link : links) {
    const Vector<2> change = link.second - link.first;
    add_link(by_cameras[{link.a, link.b}], link.covariance, link.second + link.first, change);
    const double ratio = change.dot(link.covariance.inverse() * change);
    ratios[static_cast<std::size_t>(link.a)].push_back(ratio);
    ratios[static_cast<std::size_t>(link.b)].push_back(ratio);
  }
  LastingDisagreement lasting;
  for (std::vector<double>& of : ratios) {
    const bool enough = of.size() >= kMinChanges;
    lasting.noise.push_back(enough ? std::clamp(std::sqrt(geometry::median(of) / kTwoSquaresMedian), 1.0, kNoisiest) : 1.0);
  }
  if (links.size() >= kMinLinks) lasting.deviation = std::clamp(std::sqrt(lasting_variance(by_cameras)), kMinLasting, kMaxLasting);
  return lasting;
}

}  // namespace marey::track::ground
