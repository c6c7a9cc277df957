#include "marey/solve/skeleton/functional_joints.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

#include <Eigen/Dense>

namespace marey::solve::skeleton {
namespace {

using geometry::Rigid3;
constexpr int kMinInstants = 30, kPieces = 10;
constexpr double kMinTurn = 0.02;  // a system of which another direction is no better determined has no answer
// What skin does repeats with the joint's angles, so that 2,000 instants are worth no more than these: with 24 simulated people's
// skin the mean deviation is then that of the errors, 17 mm (functional_joints_test.cpp).
constexpr double kIndependent = 2.5;
constexpr double kMinRotation = 0.2;  // rad

/// The child seen from the parent at the instants that show both.
std::vector<Rigid3> relative_poses(SegmentPoses parent, SegmentPoses child) {
  std::vector<Rigid3> relative;
  for (std::size_t t = 0; t < std::min(parent.size(), child.size()); ++t) {
    if (parent[t] && child[t]) relative.push_back(parent[t]->inverse() * *child[t]);
  }
  return relative;
}

/// Σ AᵀA and Σ Aᵀp of rows A = [I, −R], c₁ − R c₂ = p: the system in the parent's frame, which turns no length.
struct JointSystem {
  Matrix<6> square = Matrix<6>::Zero();
  Vector<6> right = Vector<6>::Zero();
  int count = 0;

  void add(const Rigid3& pose) {
    square.topLeftCorner<3, 3>() += Matrix<3>::Identity();
    square.bottomRightCorner<3, 3>() += Matrix<3>::Identity();
    square.topRightCorner<3, 3>() -= pose.rotation;
    square.bottomLeftCorner<3, 3>() -= pose.rotation.transpose();
    right.head<3>() += pose.translation;
    right.tail<3>() -= pose.rotation.transpose() * pose.translation;
    ++count;
  }
};

/// All instants but those of one piece; −1: all.
template <class Item, class Take>
void without_piece(const std::vector<Item>& items, int piece, const Take& take) {
  const std::size_t n = items.size();
  for (std::size_t t = 0; t < n; ++t) {
    if (static_cast<int>(t * kPieces / n) != piece) take(items[t]);
  }
}

/// The jackknife's deviation of solutions, each without one piece; nothing if one has none.
std::optional<double> jackknife(const std::function<std::optional<Vector<3>>(int piece)>& solve) {
  std::vector<Vector<3>> solutions;
  Vector<3> mean = Vector<3>::Zero();
  for (int piece = 0; piece < kPieces; ++piece) {
    const auto solution = solve(piece);
    if (!solution) return std::nullopt;
    solutions.push_back(*solution);
    mean += *solution / kPieces;
  }
  double sum = 0;
  for (const Vector<3>& solution : solutions) sum += (solution - mean).squaredNorm();
  return std::sqrt(sum * (kPieces - 1) / kPieces);
}

std::optional<Vector<6>> centres_of(const std::vector<Rigid3>& relative, int piece) {
  JointSystem system;
  without_piece(relative, piece, [&](const Rigid3& pose) { system.add(pose); });
  const Eigen::SelfAdjointEigenSolver<Matrix<6>> solver(system.square);
  if (solver.eigenvalues()[0] < kMinTurn * kMinTurn * system.count) return std::nullopt;
  return Vector<6>(solver.eigenvectors() * (solver.eigenvectors().transpose() * system.right).cwiseQuotient(solver.eigenvalues()));
}

struct Hinge {
  Vector<3> point, direction;
};

std::optional<Hinge> hinge_of(const std::vector<Rigid3>& relative, int piece) {
  JointSystem system;
  without_piece(relative, piece, [&](const Rigid3& pose) { system.add(pose); });
  const Eigen::SelfAdjointEigenSolver<Matrix<6>> solver(system.square);
  if (solver.eigenvalues()[1] < kMinTurn * kMinTurn * system.count) return std::nullopt;
  Vector<6> weighed = solver.eigenvectors().transpose() * system.right;
  weighed = weighed.cwiseQuotient(solver.eigenvalues());
  weighed[0] = 0;
  const Vector<6> points = solver.eigenvectors() * weighed, axis = solver.eigenvectors().col(0);
  return Hinge{points.head<3>(), axis.head<3>().normalized()};
}

/// From the least to the most turn about the axis.
double rotated_about(const std::vector<Rigid3>& relative, const Hinge& hinge) {
  const Vector<3> across = hinge.direction.unitOrthogonal(), third = hinge.direction.cross(across);
  const Vector<3> in_child = relative.front().rotation.transpose() * across;
  double minimum = 0, maximum = 0;
  for (const Rigid3& pose : relative) {
    const Vector<3> now = pose.rotation * in_child;
    const double angle = std::atan2(third.dot(now), across.dot(now));
    minimum = std::min(minimum, angle);
    maximum = std::max(maximum, angle);
  }
  return maximum - minimum;
}

}  // namespace

std::optional<FunctionalCentre> functional_centre(SegmentPoses parent, SegmentPoses child) {
  const std::vector<Rigid3> relative = relative_poses(parent, child);
  if (std::ssize(relative) < kMinInstants) return std::nullopt;
  const auto both = centres_of(relative, -1);
  const auto deviation = jackknife([&](int piece) -> std::optional<Vector<3>> {
    const auto found = centres_of(relative, piece);
    return found ? std::optional<Vector<3>>(found->head<3>()) : std::nullopt;
  });
  if (!both || !deviation) return std::nullopt;
  FunctionalCentre centre{both->head<3>(), 0, 0, static_cast<int>(relative.size())};
  JointSystem system;
  for (const Rigid3& pose : relative) {
    system.add(pose);
    centre.gap_m += (centre.in_parent - pose * Vector<3>(both->tail<3>())).squaredNorm() / centre.instants;
  }
  const Matrix<6> spread = (system.square / system.count).inverse();
  const double skin_m2 = centre.gap_m / 3 * spread.topLeftCorner<3, 3>().trace() / kIndependent;
  centre.gap_m = std::sqrt(centre.gap_m);
  centre.deviation_m = std::sqrt(skin_m2 + *deviation * *deviation);
  return centre;
}

std::optional<FunctionalAxis> functional_axis(SegmentPoses parent, SegmentPoses child) {
  const std::vector<Rigid3> relative = relative_poses(parent, child);
  if (std::ssize(relative) < kMinInstants) return std::nullopt;
  const auto hinge = hinge_of(relative, -1);
  if (!hinge) return std::nullopt;
  const double rotated = rotated_about(relative, *hinge);
  const auto deviation = jackknife([&](int piece) -> std::optional<Vector<3>> {
    const auto found = hinge_of(relative, piece);
    if (!found) return std::nullopt;
    return Vector<3>(found->direction.dot(hinge->direction) < 0 ? -found->direction : found->direction);
  });
  if (!deviation || rotated < kMinRotation) return std::nullopt;
  return FunctionalAxis{hinge->point, hinge->direction, std::min(*deviation, std::numbers::pi / 2), rotated,
                        static_cast<int>(relative.size())};
}

}  // namespace marey::solve::skeleton
