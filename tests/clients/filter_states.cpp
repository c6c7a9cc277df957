// Prints what a filter estimates on a random walk, in full precision, for filters_test.py to compare with other programs.
//
//   filter_states NAME DIMENSION SEED
//
// First line: the filter's parameters, `name=value` each. Then a line a step:
//   dt seen z… R… | predicted position… covariance… | position… velocity… covariance…
// where `seen` is 1 or 0 (no measurement this time; the last group repeats the prediction), matrices row by row.
#include <cstdlib>
#include <random>
#include <string>

#include <fmt/core.h>

#include "marey/core/error.h"
#include "marey/filter/filters.h"

namespace marey {
namespace {

void print_parameters(const filter::AlphaBetaOptions& o) {
  fmt::print("alpha={} beta={}\n", o.alpha, o.beta);
}
void print_parameters(const filter::AlphaBetaVariableOptions& o) {
  fmt::print("alpha={} beta={}\n", o.alpha, o.beta);
}
void print_parameters(const filter::ExtrapolationOptions& o) {
  fmt::print("bend={}\n", o.bend);
}
void print_parameters(const filter::CustomFilterOptions&) {}  // brought from outside: nothing to compare with
void print_parameters(const filter::KalmanOptions& o) {
  fmt::print("acceleration_noise={} initial_speed={}\n", o.acceleration_noise, o.initial_speed);
}
void print_parameters(const filter::KalmanPaperOptions& o) {
  fmt::print("frame_rate={} r_xx={} r_xy={} r_yy={} initial_velocity_variance={} noise_per_speed={} least_noise={}\n", o.frame_rate,
             o.r_xx, o.r_xy, o.r_yy, o.initial_velocity_variance, o.noise_per_speed, o.min_noise);
}
void print_parameters(const filter::KalmanAccelerationOptions& o) {
  fmt::print("jerk_noise={} initial_speed={} initial_acceleration={}\n", o.jerk_noise, o.initial_speed, o.initial_acceleration);
}
void print_parameters(const filter::ExtendedKalmanOptions& o) {
  fmt::print("acceleration_noise={} turn_sigma={} turn_time={} initial_speed={}\n", o.noise.acceleration_noise, o.noise.turn_sigma,
             o.noise.turn_time, o.initial_speed);
}
void print_parameters(const filter::UnscentedKalmanOptions& o) {
  fmt::print("acceleration_noise={} turn_sigma={} turn_time={} initial_speed={} kappa={}\n", o.noise.acceleration_noise,
             o.noise.turn_sigma, o.noise.turn_time, o.initial_speed, o.kappa);
}
void print_parameters(const filter::CondensationOptions& o) {
  fmt::print("particles={}\n", o.particles);
}
void print_parameters(const filter::InteractingModelsOptions& o) {
  fmt::print("steady_noise={} acceleration={} agility={} acceleration_time={} turn_limit={} mode_time={} initial_speed={} ",
             o.constant_noise, o.acceleration, o.agility, o.acceleration_time, o.turn_limit, o.mode_time, o.initial_speed);
  fmt::print("swerve_rate={} swerve_speed={} swerve_share={} share_0={} share_1={} share_2={}\n", o.swerve_rate, o.swerve_speed,
             o.swerve_fraction, o.fractions[0], o.fractions[1], o.fractions[2]);
}

template <typename Entries>
void print_entries(const Entries& entries) {
  for (int i = 0; i < entries.rows(); ++i) {
    for (int j = 0; j < entries.cols(); ++j) fmt::print(" {:.17g}", entries(i, j));
  }
}

template <int D>
class Walk {
 public:
  explicit Walk(unsigned seed) : random_(seed) {}

  template <typename F>
  void operator()(const typename F::Options& options) {
    print_parameters(options);
    Vector<D> x = normal(100);
    Vector<D> v = normal(80);
    Vector<D> z = x + normal(0.4);
    Matrix<D> R = covariance();
    F filter(options, z, R);
    print_line(0, true, z, R, filter, filter);
    for (int step = 1; step <= 120; ++step) {
      const double dt = 0.01 * (1 + step % 4);
      if (step % 30 == 0) v = normal(150);
      x += dt * v;
      z = x + normal(0.4);
      R = covariance();
      filter.predict(dt);
      const F predicted = filter;
      const bool detected = step % 9 != 0;
      if (detected) filter.correct(z, R);
      print_line(dt, detected, z, R, predicted, filter);
    }
  }

 private:
  Vector<D> normal(double sigma) {
    return Vector<D>::NullaryExpr([&] { return sigma * std::normal_distribution<double>()(random_); });
  }

  Matrix<D> covariance() {
    Matrix<D> A;
    for (int i = 0; i < D; ++i) A.col(i) = normal(0.3);
    return A * A.transpose() + 0.1 * Matrix<D>::Identity();
  }

  template <typename F>
  static void print_line(double dt, bool detected, const Vector<D>& z, const Matrix<D>& R, const F& predicted, const F& filter) {
    fmt::print("{:.17g} {:d}", dt, detected);
    print_entries(z);
    print_entries(R);
    print_entries(predicted.position());
    print_entries(predicted.covariance());
    print_entries(filter.position());
    print_entries(filter.velocity());
    print_entries(filter.covariance());
    fmt::print("\n");
  }

  std::mt19937 random_;
};

}  // namespace
}  // namespace marey

int main(int argc, char** argv) {
  if (argc != 4) {
    fmt::print(stderr, "usage: filter_states NAME DIMENSION SEED\n");
    return 2;
  }
  try {
    const marey::filter::FilterOptions options = marey::filter::filter_named(argv[1]);
    const auto seed = static_cast<unsigned>(std::strtoul(argv[3], nullptr, 10));
    if (std::string(argv[2]) == "2") {
      marey::filter::with_filter<2>(options, marey::Walk<2>(seed));
    } else {
      marey::filter::with_filter<3>(options, marey::Walk<3>(seed));
    }
  } catch (const marey::Error& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 1;
  }
  return 0;
}
