#include "marey/calibrate/pitch/pitch_start.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <random>

#include <Eigen/LU>

#include "marey/calibrate/pitch/pitch_residual.h"
#include "marey/geometry/decompositions.h"

namespace marey::calibrate::pitch {
namespace {

constexpr int kDrawsPerStrength = 400;               // of four points, per strength of distortion
constexpr double kReach = 0.02;                      // half image widths: beyond, a point says nothing (30 px in an image of 3,072)
constexpr double kStrongest = -1.2, kWeakest = 0.3;  // division model, per half image width squared
constexpr int kStrengths = 31;

/// Least squares with both sides scaled about their middle (Hartley); nothing if the points do not decide it.
std::optional<Matrix<3>> homography(const std::vector<Vector<2>>& from, const std::vector<Vector<2>>& to,
                                    const std::vector<int>& which) {
  Vector<2> middle = Vector<2>::Zero();
  for (const int i : which) middle += from[i];
  middle /= static_cast<double>(which.size());
  double spread = 0;
  for (const int i : which) spread += (from[i] - middle).squaredNorm();
  spread = std::sqrt(spread / static_cast<double>(which.size()));
  if (!(spread > 0)) return std::nullopt;
  Eigen::MatrixXd A(2 * which.size(), 9);
  for (std::size_t row = 0; row < which.size(); ++row) {
    const Vector<3> p = ((from[which[row]] - middle) / spread).homogeneous();
    const Vector<2>& q = to[which[row]];
    A.row(2 * row) << p.transpose(), Eigen::RowVector3d::Zero(), -q.x() * p.transpose();
    A.row(2 * row + 1) << Eigen::RowVector3d::Zero(), p.transpose(), -q.y() * p.transpose();
  }
  const geometry::Eigenpairs<9> solver = geometry::eigenpairs<9>(A.transpose() * A);
  if (!(solver.values(1) > 1e-10 * solver.values(8))) return std::nullopt;
  Matrix<3> normalise = Matrix<3>::Identity();
  normalise.topLeftCorner<2, 2>() /= spread;
  normalise.topRightCorner<2, 1>() = -middle / spread;
  const Eigen::Matrix<double, 9, 1> h = solver.vectors.col(0);
  return Matrix<3>(Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(h.data()) * normalise);
}

double cost_of(const Matrix<3>& H, const std::vector<Vector<2>>& from, const std::vector<Vector<2>>& to) {
  double cost = 0;
  for (std::size_t i = 0; i < from.size(); ++i) {
    const Vector<3> at = H * from[i].homogeneous();
    cost += std::abs(at.z()) < 1e-12 ? kReach : std::min((at.hnormalized() - to[i]).norm(), kReach);
  }
  return cost;
}

/// With the sign that puts the pitch before the camera, by the majority of the points.
Matrix<3> ahead(const Matrix<3>& H, const std::vector<Vector<2>>& ground) {
  const auto count =
      std::count_if(ground.begin(), ground.end(), [&](const Vector<2>& p) { return H.row(2).dot(p.homogeneous()) > 0; });
  return 2 * count < std::ssize(ground) ? Matrix<3>(-H) : H;
}

/// By all points that it reaches, in place of the four that it was drawn from; as it was where that explains no more.
PitchStart with_all_in_reach(PitchStart start, const std::vector<Vector<2>>& ground, const std::vector<Vector<2>>& straight) {
  constexpr int kRounds = 5;
  for (int round = 0; round < kRounds; ++round) {
    std::vector<int> reached;
    for (std::size_t i = 0; i < ground.size(); ++i) {
      const Vector<3> at = start.image_from_ground * ground[i].homogeneous();
      if (std::abs(at.z()) > 1e-12 && (at.hnormalized() - straight[i]).norm() < kReach) reached.push_back(static_cast<int>(i));
    }
    const auto H = reached.size() > 4 ? homography(ground, straight, reached) : std::nullopt;
    const double cost = H ? cost_of(*H, ground, straight) : start.cost;
    if (!(cost < start.cost)) break;
    const Matrix<3> better = ahead(*H, ground);
    if ((better.determinant() > 0) != (start.image_from_ground.determinant() > 0)) break;
    start.image_from_ground = better;
    start.cost = cost;
  }
  return start;
}

}  // namespace

std::vector<char> PitchStart::agreeing(const std::vector<PitchPoint>& points, cv::Size size) const {
  std::vector<char> agree;
  for (const PitchPoint& point : points) {
    const Vector<2> at = (point.pixel - middle_of(size)) / (size.width / 2.0);
    const Vector<2> straight = at / (1 + strength * at.squaredNorm());
    agree.push_back(((image_from_ground * point.ground.homogeneous()).hnormalized() - straight).norm() < kReach);
  }
  return agree;
}

PitchStarts find_pitch_starts(const std::vector<PitchPoint>& points, cv::Size size) {
  std::vector<Vector<2>> ground, straight(points.size());
  for (const PitchPoint& point : points) ground.push_back(point.ground);
  const int count = static_cast<int>(points.size());
  PitchStarts best;
  std::mt19937 random(1);
  for (int step = 0; step < kStrengths; ++step) {
    const double strength = kStrongest + (kWeakest - kStrongest) * step / (kStrengths - 1);
    bool folds = false;
    for (int i = 0; i < count; ++i) {
      const Vector<2> at = (points[i].pixel - middle_of(size)) / (size.width / 2.0);
      const double weight = 1 + strength * at.squaredNorm();
      folds |= weight < 0.1;
      straight[i] = at / std::max(weight, 0.1);
    }
    if (folds) continue;
    PitchStart right{.strength = strength}, left = right;
    std::vector<int> four(4);
    for (int sample = 0; sample < kDrawsPerStrength; ++sample) {
      for (int& i : four) i = static_cast<int>(random() % static_cast<unsigned>(count));
      std::vector<int> sorted = four;
      std::sort(sorted.begin(), sorted.end());
      if (std::adjacent_find(sorted.begin(), sorted.end()) != sorted.end()) continue;
      const auto drawn = homography(ground, straight, sorted);
      if (!drawn) continue;
      const double cost = cost_of(*drawn, ground, straight);
      if (!(cost < std::max(left.cost, right.cost))) continue;
      const Matrix<3> H = ahead(*drawn, ground);
      // Seen from above, with the image's y down, a right-handed ground is turned over: a negative determinant before the camera.
      PitchStart& hand = H.determinant() > 0 ? left : right;
      if (cost < hand.cost) hand = {H, strength, cost};
    }
    for (const auto& [hand, all] : {std::pair(&left, &best.left), std::pair(&right, &best.right)}) {
      if (std::isfinite(hand->cost)) all->push_back(with_all_in_reach(*hand, ground, straight));
    }
  }
  for (std::vector<PitchStart>* all : {&best.left, &best.right})
    std::stable_sort(all->begin(), all->end(), [](const PitchStart& a, const PitchStart& b) { return a.cost < b.cost; });
  return best;
}

}  // namespace marey::calibrate::pitch
