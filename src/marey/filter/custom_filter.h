// A filter that is brought from outside, at run time: by a program that links the library, or by Python.
//
// What is brought is a CustomModel, made again for each target; it says where the target is, how fast it moves and how sure that
// is. The search area is an ellipse of its covariance and the measurement's together, `gate_sigmas` standard deviations wide. Cost:
// one allocation a target and copy, a virtual call each step.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "marey/core/error.h"
#include "marey/core/geometry.h"
#include "marey/filter/gaussian.h"

namespace marey::filter {

/// Position in px or m, velocity per second; the covariance is that of the position, symmetric and positive.
template <int D>
struct MotionEstimate {
  Vector<D> position = Vector<D>::Zero();
  Vector<D> velocity = Vector<D>::Zero();
  Matrix<D> covariance = Matrix<D>::Identity();
};

/// One target's state over time. What it throws ends the run and comes out as it is.
template <int D>
class CustomModel {
 public:
  virtual ~CustomModel() = default;
  virtual std::unique_ptr<CustomModel> copy() const = 0;
  virtual void predict(double dt) = 0;  ///< dt ≥ 0 seconds ahead
  virtual void correct(const Vector<D>& z, const Matrix<D>& R) = 0;
  virtual MotionEstimate<D> estimate() const = 0;
};

/// Begins at a first measurement z with covariance R. `unit`: how many px or m its lengths of 1 are: the height of a person in
/// an image, 1 elsewhere.
template <int D>
using MakeCustomModel = std::function<std::unique_ptr<CustomModel<D>>(const Vector<D>& z, const Matrix<D>& R, double unit)>;

template <int D>
class CustomFilter;

struct CustomFilterOptions {
  std::string name = "custom";
  MakeCustomModel<2> plane = {};  ///< for targets in images and on the ground
  MakeCustomModel<3> space = {};
  double gate_sigmas = 3.5;
  double unit = 1;

  template <int D>
  using Model = CustomFilter<D>;

  CustomFilterOptions scaled(double factor) const {
    CustomFilterOptions options = *this;
    options.unit *= factor;
    return options;
  }

  template <int D>
  const MakeCustomModel<D>& make() const {
    if constexpr (D == 2) {
      return plane;
    } else {
      return space;
    }
  }
};

template <int D>
class CustomFilter {
 public:
  using Options = CustomFilterOptions;
  static constexpr int dimension = D;

  /// Throws Error if the options bring no model of D dimensions, and where an estimate is not finite, here and below.
  CustomFilter(const Options& options, const Vector<D>& z, const Matrix<D>& R)
      : name_(std::make_shared<const std::string>(options.name)), gate_sigmas_(options.gate_sigmas) {
    if (!options.make<D>()) throw Error("the filter \"{}\" follows nothing in {} dimensions", options.name, D);
    model_ = options.make<D>()(z, R, options.unit);
    read();
  }
  CustomFilter(const CustomFilter& other)
      : name_(other.name_), model_(other.model_->copy()), estimate_(other.estimate_), gate_sigmas_(other.gate_sigmas_) {}
  CustomFilter(CustomFilter&&) noexcept = default;
  CustomFilter& operator=(const CustomFilter& other) { return *this = CustomFilter(other); }
  CustomFilter& operator=(CustomFilter&&) noexcept = default;
  ~CustomFilter() = default;

  void predict(double dt) {
    model_->predict(dt);
    read();
  }
  void correct(const Vector<D>& z, const Matrix<D>& R) {
    model_->correct(z, R);
    read();
  }

  const Vector<D>& position() const { return estimate_.position; }
  const Vector<D>& velocity() const { return estimate_.velocity; }
  const Matrix<D>& covariance() const { return estimate_.covariance; }
  Matrix<D> innovation_covariance(const Matrix<D>& R) const { return estimate_.covariance + R; }
  double gate_distance(const Vector<D>& z, const Matrix<D>& R) const {
    return mahalanobis<D>(z - estimate_.position, innovation_covariance(R)) / gate_sigmas_;
  }

 private:
  void read() {
    estimate_ = model_->estimate();
    if (!estimate_.position.allFinite() || !estimate_.velocity.allFinite() || !estimate_.covariance.allFinite())
      throw Error("the filter \"{}\" gave an estimate that is not finite", *name_);
    if (!(estimate_.covariance.diagonal().minCoeff() >= 0)) throw Error("the filter \"{}\" gave a negative variance", *name_);
  }

  std::shared_ptr<const std::string> name_;
  std::unique_ptr<CustomModel<D>> model_;
  MotionEstimate<D> estimate_;
  double gate_sigmas_;
};

}  // namespace marey::filter
