#include "marey/calibrate/bundle/bundle_residual.h"

#include <algorithm>

#include <ceres/jet.h>

namespace marey::calibrate::bundle {
namespace {

using RowMajor3 = Eigen::Matrix<double, 2, 3, Eigen::RowMajor>;
template <int Columns>
using Rows = Eigen::Matrix<double, 2, Columns, Eigen::RowMajor>;

Matrix<3> skew(const Vector<3>& v) {
  Matrix<3> m;
  m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return m;
}

template <typename Model>
class Reprojection final : public ceres::CostFunction {
 public:
  Reprojection(const Body& body, const Vector<3>& site, const BundleObservation& detected, bool with_offset)
      : kind_(body.index()), site_(site), pixel_(detected.pixel), velocity_(detected.velocity) {
    set_num_residuals(2);
    *mutable_parameter_block_sizes() = {kPose, kLensBase + Model::coefficients, body_numbers(body)};
    if (with_offset) mutable_parameter_block_sizes()->push_back(1);
  }

  bool Evaluate(double const* const* blocks, double* residuals, double** jacobians) const override {
    const Eigen::Map<const Vector<3>> rotation(blocks[0]), translation(blocks[0] + 3);
    const Matrix<3> R = geometry::rotation_from(rotation);
    const Vector<3> world = position(blocks[2]);
    const Vector<3> rotated = R * world;
    const Vector<3> in_camera = rotated + translation;
    if (!in_front(in_camera)) return false;

    Eigen::Map<Vector<2>> error(residuals);
    if (jacobians == nullptr) {
      error = lens_only(in_camera, blocks[1]) - pixel_;
    } else {
      RowMajor3 by_camera;
      error = lens_with_jacobian(in_camera, blocks[1], by_camera, jacobians[1]) - pixel_;
      if (jacobians[0] != nullptr) {
        Eigen::Map<Rows<kPose>> J(jacobians[0]);
        J.leftCols<3>() = -by_camera * skew(rotated) * left_jacobian(rotation);
        J.rightCols<3>() = by_camera;
      }
      if (jacobians[2] != nullptr) by_body(by_camera * R, blocks[2], jacobians[2]);
    }
    if (parameter_block_sizes().size() > 3) {
      error += velocity_ * *blocks[3];
      if (jacobians != nullptr && jacobians[3] != nullptr) std::copy_n(velocity_.data(), 2, jacobians[3]);
    }
    return error.allFinite();
  }

 private:
  static bool in_front(const Vector<3>& in_camera) {
    if constexpr (!Model::ahead_only) return in_camera.squaredNorm() > 1e-12;
    return in_camera.z() > 1e-6;
  }

  Vector<3> position(const double* body) const {
    const Eigen::Map<const Vector<3>> first(body);
    if (kind_ == 0) return first;
    const Eigen::Map<const Vector<3>> second(body + 3);
    if (kind_ == 1) return first + site_.x() * second;
    return geometry::rotation_from(first) * site_ + second;
  }

  void by_body(const RowMajor3& by_world, const double* body, double* jacobian) const {
    if (kind_ == 0) {
      Eigen::Map<RowMajor3> J(jacobian);
      J = by_world;
      return;
    }
    Eigen::Map<Rows<6>> J(jacobian);
    if (kind_ == 1) {
      J << by_world, by_world * site_.x();
    } else {
      const Vector<3> rotation(body[0], body[1], body[2]);
      J << -by_world * skew(geometry::rotation_from(rotation) * site_) * left_jacobian(rotation), by_world;
    }
  }

  static Vector<2> lens_only(const Vector<3>& in_camera, const double* lens) {
    const Vector<2> at = Model::distort(in_camera, lens + kLensBase);
    return {lens[2] + lens[0] * at.x(), lens[3] + lens[0] * lens[1] * at.y()};
  }

  static Vector<2> lens_with_jacobian(const Vector<3>& in_camera, const double* lens, RowMajor3& by_camera, double* by_lens) {
    const Vector<2> focal(lens[0], lens[0] * lens[1]);
    Vector<2> at;
    if (by_lens == nullptr) {
      Rows<3> J = distort<3>(in_camera, lens + kLensBase, at);
      by_camera = focal.asDiagonal() * J;
    } else {
      const auto J = distort<3 + Model::coefficients>(in_camera, lens + kLensBase, at);
      by_camera = focal.asDiagonal() * J.template leftCols<3>();
      Eigen::Map<Rows<kLensBase + Model::coefficients>> L(by_lens);
      L.template leftCols<kLensBase>() << at.x(), 0, 1, 0, lens[1] * at.y(), lens[0] * at.y(), 0, 1;
      L.template rightCols<Model::coefficients>() = focal.asDiagonal() * J.template rightCols<Model::coefficients>();
    }
    return Vector<2>(lens[2], lens[3]) + focal.cwiseProduct(at);
  }

  /// Derivatives by the point and, where N asks, by the coefficients.
  template <int N>
  static Rows<N> distort(const Vector<3>& in_camera, const double* k, Vector<2>& at) {
    using Jet = ceres::Jet<double, N>;
    std::array<Jet, Model::coefficients> coefficients;
    for (int i = 0; i < Model::coefficients; ++i) {
      coefficients[static_cast<std::size_t>(i)] = Jet(k[i]);
      if (N > 3) coefficients[static_cast<std::size_t>(i)].v[(3 + i) % N] = 1;
    }
    const auto d = Model::distort(Eigen::Matrix<Jet, 3, 1>(Jet(in_camera.x(), 0), Jet(in_camera.y(), 1), Jet(in_camera.z(), 2)),
                                  coefficients.data());
    at = {d.x().a, d.y().a};
    Rows<N> J;
    J << d.x().v.transpose(), d.y().v.transpose();
    return J;
  }

  std::size_t kind_;
  Vector<3> site_;
  Vector<2> pixel_, velocity_;
};

}  // namespace

int lens_numbers(const geometry::Lens& lens) {
  return std::visit([](const auto& model) { return kLensBase + std::decay_t<decltype(model)>::coefficients; }, lens);
}

int body_numbers(const Body& body) {
  return body.index() == 0 ? 3 : 6;
}

std::vector<double> numbers_of(const Rigid3& pose) {
  const Vector<3> rotation = geometry::angle_axis_of(pose.rotation);
  return {rotation.x(), rotation.y(), rotation.z(), pose.translation.x(), pose.translation.y(), pose.translation.z()};
}

std::vector<double> numbers_of(const geometry::Lens& lens) {
  return std::visit(
      [](const auto& model) {
        std::vector<double> numbers = {model.focal.x(), model.focal.y() / model.focal.x(), model.principal.x(),
                                       model.principal.y()};
        numbers.insert(numbers.end(), model.distortion.begin(), model.distortion.end());
        return numbers;
      },
      lens);
}

std::vector<double> numbers_of(const Body& body) {
  if (const auto* point = std::get_if<Vector<3>>(&body)) return {point->x(), point->y(), point->z()};
  if (const auto* board = std::get_if<Rigid3>(&body)) return numbers_of(*board);
  const auto& [origin, direction] = std::get<WandPose>(body);
  return {origin.x(), origin.y(), origin.z(), direction.x(), direction.y(), direction.z()};
}

Rigid3 pose_from(const double* numbers) {
  const Eigen::Map<const Vector<3>> rotation(numbers), translation(numbers + 3);
  return {geometry::rotation_from(rotation), translation};
}

void set_numbers(geometry::Lens& lens, const double* numbers) {
  std::visit(
      [&](auto& model) {
        model.focal = {numbers[0], numbers[0] * numbers[1]};
        model.principal = {numbers[2], numbers[3]};
        std::copy_n(numbers + kLensBase, model.distortion.size(), model.distortion.begin());
      },
      lens);
}

void set_numbers(Body& body, const double* numbers) {
  const Eigen::Map<const Vector<3>> first(numbers);
  if (auto* point = std::get_if<Vector<3>>(&body)) {
    *point = first;
  } else if (auto* wand = std::get_if<WandPose>(&body)) {
    *wand = {first, Eigen::Map<const Vector<3>>(numbers + 3).normalized()};
  } else {
    body = pose_from(numbers);
  }
}

Matrix<3> left_jacobian(const Vector<3>& angle_axis) {
  const double angle = angle_axis.norm();
  if (angle < 1e-8) return Matrix<3>::Identity() + 0.5 * skew(angle_axis);
  const Vector<3> axis = angle_axis / angle;
  const double s = std::sin(angle) / angle;
  return s * Matrix<3>::Identity() + (1 - s) * axis * axis.transpose() + (1 - std::cos(angle)) / angle * skew(axis);
}

ceres::CostFunction* make_reprojection(const geometry::Lens& lens, const Body& body, const Vector<3>& site,
                                       const BundleObservation& detected, bool with_offset) {
  return std::visit(
      [&](const auto& model) -> ceres::CostFunction* {
        return new Reprojection<std::decay_t<decltype(model)>>(body, site, detected, with_offset);
      },
      lens);
}

}  // namespace marey::calibrate::bundle
