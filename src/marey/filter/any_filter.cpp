#include "marey/filter/any_filter.h"

#include <cmath>
#include <limits>
#include <new>
#include <type_traits>
#include <utility>

#include <Eigen/LU>

namespace marey::filter {

/// What the table holds for one model.
template <int D>
template <typename F>
struct AnyFilter<D>::CallsOf {
  static_assert(sizeof(F) <= kBytes, "AnyFilter keeps the model in itself: enlarge kBytes");
  static_assert(alignof(F) <= alignof(AnyFilter<D>));
  static_assert(std::is_nothrow_move_constructible_v<F>, "vectors of targets move their filters");

  static void copy(void* to, const void* from) { new (to) F(*static_cast<const F*>(from)); }
  static void move(void* to, void* from) { new (to) F(std::move(*static_cast<F*>(from))); }
  static void destroy(void* model) { static_cast<F*>(model)->~F(); }

  static void read(const F& model, Estimate& estimate) {
    estimate.position = model.position();
    estimate.velocity = model.velocity();
    estimate.covariance = model.covariance();
  }

  static void predict(void* model, double dt, Estimate& estimate) {
    F& filter = *static_cast<F*>(model);
    filter.predict(dt);
    read(filter, estimate);
  }

  static void predict_unobserved(void* model, double dt, Estimate& estimate) {
    F& filter = *static_cast<F*>(model);
    if constexpr (requires { filter.predict_unobserved(dt); }) {
      filter.predict_unobserved(dt);
    } else {
      filter.predict(dt);
    }
    read(filter, estimate);
  }

  static void scale_noise(void* model, double factor) {
    F& filter = *static_cast<F*>(model);
    if constexpr (requires { filter.scale_noise(factor); }) filter.scale_noise(factor);
  }

  static void correct(void* model, const Vector<D>& z, const Matrix<D>& R, Estimate& estimate) {
    F& filter = *static_cast<F*>(model);
    filter.correct(z, R);
    read(filter, estimate);
  }

  static Matrix<D> innovation_covariance(const void* model, const Matrix<D>& R) {
    return static_cast<const F*>(model)->innovation_covariance(R);
  }

  static double gate_distance(const void* model, const Vector<D>& z, const Matrix<D>& R) {
    return static_cast<const F*>(model)->gate_distance(z, R);
  }

  static double search_reach(const void* model, double variance) {
    if constexpr (requires(const F& filter) { filter.search_reach(variance); }) {
      return static_cast<const F*>(model)->search_reach(variance);
    } else {
      return std::numeric_limits<double>::infinity();
    }
  }

  static double log_likelihood(const void* model, const Vector<D>& z, const Matrix<D>& R) {
    const F& filter = *static_cast<const F*>(model);
    if constexpr (requires { filter.log_likelihood(z, R); }) {
      return filter.log_likelihood(z, R);
    } else {
      constexpr double kLogTwoPi = 1.8378770664093453;
      const Matrix<D> S = filter.innovation_covariance(R);
      const Vector<D> residual = z - filter.position();
      return -0.5 * (residual.dot(S.inverse() * residual) + std::log(S.determinant()) + D * kLogTwoPi);
    }
  }

  static constexpr Calls table = {.copy = copy,
                                  .move = move,
                                  .destroy = std::is_trivially_destructible_v<F> ? nullptr : destroy,
                                  .predict = predict,
                                  .correct = correct,
                                  .innovation_covariance = innovation_covariance,
                                  .gate_distance = gate_distance,
                                  .search_reach = search_reach,
                                  .log_likelihood = log_likelihood,
                                  .predict_unobserved = predict_unobserved,
                                  .scale_noise = scale_noise};
};

template <int D>
AnyFilter<D>::AnyFilter(const FilterOptions& options, const Vector<D>& z, const Matrix<D>& R) {
  with_filter<D>(options, [&]<typename F>(const typename F::Options& chosen) {
    const F* model = new (model_) F(chosen, z, R);
    calls_ = &CallsOf<F>::table;
    CallsOf<F>::read(*model, estimate_);
  });
}

template class AnyFilter<2>;
template class AnyFilter<3>;

}  // namespace marey::filter
