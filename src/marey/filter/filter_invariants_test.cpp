// What every filter of the register fulfils, in both dimensions. It is asked of AnyFilter, which gives the bits of the model that
// it holds (any_filter_test.cpp), so that each test is compiled once and not once a filter.
#include <algorithm>
#include <cmath>
#include <ostream>
#include <random>
#include <string>

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

#include "marey/filter/any_filter.h"
#include "marey/filter/random_measurements.h"

namespace marey::filter {
namespace {

/// Of a filter, what its invariants depend on.
struct FilterKind {
  bool mixture = false;     ///< the estimate is the mean of several hypotheses or of particles, which a measurement weighs again
  bool sampled = false;     ///< the estimate carries the noise of random particles
  bool unsmoothed = false;  ///< the velocity is that of the last few measurements as they are, noise and all
};

struct FindKind {
  template <typename F>
  FilterKind operator()(const typename F::Options& /*options*/) const {
    constexpr bool mixture = requires { requires F::mixture; };
    constexpr bool sampled = requires { requires F::sampled; };
    constexpr bool unsmoothed = requires { requires F::unsmoothed; };
    return {mixture, sampled, unsmoothed};
  }
};

/// The register's, but for particles: enough of them, and little enough diffusion, that the property is not lost in their
/// noise.
FilterOptions requested(const NamedFilter& filter) {
  FilterOptions options = filter.options;
  if (auto* particles = std::get_if<CondensationOptions>(&options)) {
    particles->particles = 2000;
    if (particles->with_velocity) {
      particles->velocity_diffusion = 100, particles->initial_speed = 150;
    } else {
      particles->diffusion = 20;
    }
  }
  return options;
}

template <int D>
class Subject : public RandomMeasurements<D> {
 public:
  explicit Subject(const FilterOptions& options) : options_(options) {}

  AnyFilter<D> begun(const Vector<D>& z, const Matrix<D>& R) const { return AnyFilter<D>(options_, z, R); }

  /// A filter that has seen a noisy straight walk of 20 uneven steps.
  AnyFilter<D> experienced() {
    const Vector<D> velocity = this->random_vector(100);
    Vector<D> x = this->random_vector(200);
    AnyFilter<D> filter = begun(x, Matrix<D>::Identity());
    std::uniform_real_distribution<double> step(0.02, 0.1);
    for (int i = 0; i < 20; ++i) {
      const double dt = step(this->random_);
      x += dt * velocity;
      filter.predict(dt);
      filter.correct(x + this->random_vector(1), Matrix<D>::Identity());
    }
    return filter;
  }

 private:
  FilterOptions options_;
};

template <int D>
void expect_valid(const Matrix<D>& P) {
  ASSERT_TRUE(P.allFinite());
  EXPECT_LE((P - P.transpose()).cwiseAbs().maxCoeff(), 1e-9 * (1 + P.cwiseAbs().maxCoeff()));
  const Vector<D> values = Eigen::SelfAdjointEigenSolver<Matrix<D>>(P, Eigen::EigenvaluesOnly).eigenvalues();
  EXPECT_GE(values.minCoeff(), -1e-9 * (1 + values.maxCoeff()));
}

class FilterInvariants : public testing::TestWithParam<NamedFilter> {
 protected:
  /// `check(subject)` in the plane and in space.
  template <typename Check>
  void in_both_dimensions(Check check) const {
    Subject<2> plane(options_);
    check(plane);
    SCOPED_TRACE("in space");
    Subject<3> space(options_);
    check(space);
  }

  const FilterOptions options_ = requested(GetParam());
  const FilterKind kind_ = with_filter<2>(options_, FindKind{});
};

TEST_P(FilterInvariants, BeginsAtItsFirstMeasurementAtRest) {
  in_both_dimensions([]<int D>(Subject<D>& subject) {
    const Vector<D> z = subject.random_vector(200);
    const AnyFilter<D> filter = subject.begun(z, subject.random_covariance(2));
    EXPECT_LE((filter.position() - z).norm(), 1e-9);
    EXPECT_LE(filter.velocity().norm(), 1e-9);
  });
}

TEST_P(FilterInvariants, PredictingNoTimeChangesNothing) {
  in_both_dimensions([]<int D>(Subject<D>& subject) {
    AnyFilter<D> filter = subject.experienced();
    const AnyFilter<D> before = filter;
    filter.predict(0);
    EXPECT_LE((filter.position() - before.position()).norm(), 1e-9);
    EXPECT_LE((filter.velocity() - before.velocity()).norm(), 1e-9);
    EXPECT_LE((filter.covariance() - before.covariance()).norm(), 1e-9 * (1 + before.covariance().norm()));
  });
}

TEST_P(FilterInvariants, AMeasurementAtThePredictionDoesNotMoveIt) {
  in_both_dimensions([this]<int D>(Subject<D>& subject) {
    AnyFilter<D> filter = subject.experienced();
    filter.predict(0.04);
    const Vector<D> position = filter.position();
    filter.correct(position, subject.random_covariance(1));
    const double allowed = kind_.mixture ? 0.5 * std::sqrt(filter.covariance().trace()) : 1e-6 * (1 + position.norm());
    EXPECT_LE((filter.position() - position).norm(), allowed);
  });
}

TEST_P(FilterInvariants, CovariancesStaySymmetricAndPositive) {
  in_both_dimensions([]<int D>(Subject<D>& subject) {
    for (int trial = 0; trial < 20; ++trial) {
      AnyFilter<D> filter = subject.experienced();
      for (int i = 0; i < 50; ++i) {
        filter.predict(0.04 * (i % 3));
        const Matrix<D> R = subject.random_covariance(i % 7 == 0 ? 1e-3 : 3);
        expect_valid<D>(filter.covariance());
        expect_valid<D>(filter.innovation_covariance(R));
        if (i % 4 != 0) filter.correct(filter.position() + subject.random_vector(3), R);
      }
      expect_valid<D>(filter.covariance());
    }
  });
}

TEST_P(FilterInvariants, WaitingDoesNotMakeItSurer) {
  in_both_dimensions([this]<int D>(Subject<D>& subject) {
    AnyFilter<D> filter = subject.experienced();
    double before = filter.covariance().trace();
    for (int i = 0; i < 10; ++i) {
      filter.predict(0.04);
      EXPECT_GE(filter.covariance().trace(), before * (1 - (kind_.sampled ? 0.1 : 1e-9)));
      before = filter.covariance().trace();
    }
  });
}

TEST_P(FilterInvariants, ASteadyWalkIsFollowedWithoutBias) {
  const bool at_rest = GetParam().name == "condensation";  // its model is a target that stands still
  in_both_dimensions([&, this]<int D>(Subject<D>& subject) {
    const Vector<D> velocity = Vector<D>::Constant(at_rest ? 0 : 60);
    Vector<D> x = Vector<D>::Constant(100);
    const Matrix<D> R = 0.25 * Matrix<D>::Identity();
    AnyFilter<D> filter = subject.begun(x, R);
    Vector<D> sum = Vector<D>::Zero();
    constexpr int steps = 400;
    constexpr int settled = 100;
    for (int i = 0; i < steps; ++i) {
      const double dt = i % 2 == 0 ? 0.03 : 0.05;
      x += dt * velocity;
      filter.predict(dt);
      if (i >= settled) sum += filter.position() - x;
      filter.correct(x + subject.random_vector(0.5), R);
    }
    EXPECT_LE((sum / (steps - settled)).norm(), 0.3);
    EXPECT_LE((filter.velocity() - velocity).norm(), kind_.unsmoothed ? 200 : 40);
  });
}

TEST_P(FilterInvariants, TheSearchAreaIsCentredOnThePrediction) {
  in_both_dimensions([]<int D>(Subject<D>& subject) {
    AnyFilter<D> filter = subject.experienced();
    filter.predict(0.04);
    const Matrix<D> R = Matrix<D>::Identity();
    EXPECT_LE(filter.gate_distance(filter.position(), R), 1e-3);
    const Vector<D> direction = subject.random_vector(1).normalized();
    double before = 0;
    for (const double away : {1.0, 10.0, 100.0, 1000.0}) {
      const double distance = filter.gate_distance(filter.position() + away * direction, R);
      EXPECT_GT(distance, before);
      before = distance;
    }
    EXPECT_GT(before, 1);
  });
}

TEST_P(FilterInvariants, NothingBecomesNaN) {
  in_both_dimensions([]<int D>(Subject<D>& subject) {
    for (const double scale : {1e-6, 1.0, 1e6}) {
      for (const double dt : {0.0, 1e-9, 0.04, 3600.0}) {
        AnyFilter<D> filter = subject.begun(Vector<D>::Constant(scale), Matrix<D>::Identity());
        for (int i = 0; i < 4; ++i) {
          filter.predict(dt);
          filter.correct(subject.random_vector(scale), Matrix<D>::Identity());
        }
        EXPECT_TRUE(filter.position().allFinite());
        EXPECT_TRUE(filter.velocity().allFinite());
        EXPECT_TRUE(filter.covariance().allFinite());
        EXPECT_TRUE(std::isfinite(filter.gate_distance(subject.random_vector(scale), Matrix<D>::Identity())));
      }
    }
  });
}

INSTANTIATE_TEST_SUITE_P(Register, FilterInvariants, testing::ValuesIn(named_filters()), [](const auto& tested) {
  std::string name(tested.param.name);
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
});

}  // namespace

void PrintTo(const NamedFilter& filter, std::ostream* out) {  // googletest's name
  *out << filter.name;
}

}  // namespace marey::filter
