#pragma once

// A filter of any kind of the register as one value, so that who holds one for each target is compiled once, not once a filter.
//
// The model lies in the object itself, never on the heap; one table of functions, shared by all objects of a kind, says how to
// copy, predict and correct it. The estimate is kept beside it, so that position(), velocity() and covariance(), which are asked
// for far more often than the state changes, are plain reads. The model decides every bit of the result.
// Cost: an indirect call for each predict, correct, gate_distance and innovation_covariance. Size: that of the largest model.

#include <cstddef>
#include <utility>

#include "marey/core/geometry.h"
#include "marey/filter/filters.h"

namespace marey::filter {

/// See Filter for what the functions mean; D = 2 or 3.
template <int D>
class AnyFilter {
 public:
  static constexpr int dimension = D;

  /// The filter that `options` choose begins at a first measurement z (px or m) with covariance R, at rest.
  AnyFilter(const FilterOptions& options, const Vector<D>& z, const Matrix<D>& R);
  AnyFilter(const AnyFilter& other) : calls_(other.calls_), estimate_(other.estimate_) { calls_->copy(model_, other.model_); }
  AnyFilter(AnyFilter&& other) noexcept : calls_(other.calls_), estimate_(std::move(other.estimate_)) {
    calls_->move(model_, other.model_);
  }
  AnyFilter& operator=(const AnyFilter& other) {
    if (this != &other) *this = AnyFilter(other);
    return *this;
  }
  AnyFilter& operator=(AnyFilter&& other) noexcept {
    if (this == &other) return *this;
    destroy();
    calls_ = other.calls_;
    estimate_ = other.estimate_;
    calls_->move(model_, other.model_);
    return *this;
  }
  ~AnyFilter() { destroy(); }

  void predict(double dt) { calls_->predict(model_, dt, estimate_); }
  /// The same while the target is hidden; like `predict` where the method makes no difference.
  void predict_unobserved(double dt) { calls_->predict_unobserved(model_, dt, estimate_); }
  void correct(const Vector<D>& z, const Matrix<D>& R) { calls_->correct(model_, z, R, estimate_); }

  /// What drives the target becomes `factor` times as strong as in the options; without effect where the method has no such noise.
  void scale_noise(double factor) { calls_->scale_noise(model_, factor); }

  const Vector<D>& position() const { return estimate_.position; }
  const Vector<D>& velocity() const { return estimate_.velocity; }
  const Matrix<D>& covariance() const { return estimate_.covariance; }
  Matrix<D> innovation_covariance(const Matrix<D>& R) const { return calls_->innovation_covariance(model_, R); }
  double gate_distance(const Vector<D>& z, const Matrix<D>& R) const { return calls_->gate_distance(model_, z, R); }

  /// Logarithm of the density of a measurement at z: the method's own where it knows several models, else that of a Gaussian.
  double log_likelihood(const Vector<D>& z, const Matrix<D>& R) const { return calls_->log_likelihood(model_, z, R); }

  /// No measurement whose covariance is at most `variance` in any direction lies in the search area and farther than this from
  /// position(); infinite where the method knows no such bound that is cheaper than gate_distance.
  double search_reach(double variance) const { return calls_->search_reach(model_, variance); }

 private:
  struct Estimate {
    Vector<D> position;
    Vector<D> velocity;
    Matrix<D> covariance;
  };

  struct Calls {
    void (*copy)(void* to, const void* from);
    void (*move)(void* to, void* from);
    void (*destroy)(void* model);  ///< null where there is nothing to do
    void (*predict)(void* model, double dt, Estimate& estimate);
    void (*correct)(void* model, const Vector<D>& z, const Matrix<D>& R, Estimate& estimate);
    Matrix<D> (*innovation_covariance)(const void* model, const Matrix<D>& R);
    double (*gate_distance)(const void* model, const Vector<D>& z, const Matrix<D>& R);
    double (*search_reach)(const void* model, double variance);
    double (*log_likelihood)(const void* model, const Vector<D>& z, const Matrix<D>& R);
    void (*predict_unobserved)(void* model, double dt, Estimate& estimate);
    void (*scale_noise)(void* model, double factor);
  };

  template <typename F>
  struct CallsOf;

  void destroy() {
    if (calls_->destroy != nullptr) calls_->destroy(model_);
  }

  /// Of the largest model, InteractingModels; any_filter.cpp does not compile where one needs more.
  static constexpr std::size_t kBytes = D == 2 ? 1184 : 2352;

  const Calls* calls_;
  Estimate estimate_;
  alignas(std::max_align_t) alignas(Matrix<2>) std::byte model_[kBytes];
};

extern template class AnyFilter<2>;
extern template class AnyFilter<3>;

}  // namespace marey::filter
