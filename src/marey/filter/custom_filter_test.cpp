#include "marey/filter/custom_filter.h"

#include <limits>

#include <gtest/gtest.h>

#include "marey/filter/any_filter.h"

namespace marey::filter {
namespace {

/// Our Kalman filter, brought from outside: what comes out must be its bits.
template <int D>
class BroughtKalman final : public CustomModel<D> {
 public:
  BroughtKalman(const KalmanOptions& options, const Vector<D>& z, const Matrix<D>& R) : kalman_(options, z, R) {}
  std::unique_ptr<CustomModel<D>> copy() const override { return std::make_unique<BroughtKalman>(*this); }
  void predict(double dt) override { kalman_.predict(dt); }
  void correct(const Vector<D>& z, const Matrix<D>& R) override { kalman_.correct(z, R); }
  MotionEstimate<D> estimate() const override { return {kalman_.position(), kalman_.velocity(), kalman_.covariance()}; }

 private:
  Kalman<D> kalman_;
};

template <int D>
MakeCustomModel<D> brought_kalman() {
  return [](const Vector<D>& z, const Matrix<D>& R, double unit) {
    return std::make_unique<BroughtKalman<D>>(KalmanOptions{}.scaled(unit), z, R);
  };
}

CustomFilterOptions brought() {
  return {
      .name = "brought", .plane = brought_kalman<2>(), .space = brought_kalman<3>(), .gate_sigmas = KalmanOptions{}.gate_sigmas};
}

template <int D>
void expect_the_same(const FilterOptions& own, const FilterOptions& custom) {
  const Matrix<D> R = 0.3 * Matrix<D>::Identity();
  Vector<D> location = Vector<D>::Constant(10);
  AnyFilter<D> a(own, location, R), b(custom, location, R);
  for (int k = 0; k < 50; ++k) {
    location += Vector<D>::LinSpaced(1, 2) * (k < 25 ? 1 : -0.5);
    for (AnyFilter<D>* filter : {&a, &b}) {
      filter->predict(k % 3 == 0 ? 0.02 : 0.05);
      if (k % 7 != 3) filter->correct(location, R);
    }
    ASSERT_EQ(a.position(), b.position()) << k;
    ASSERT_EQ(a.velocity(), b.velocity()) << k;
    ASSERT_EQ(a.covariance(), b.covariance()) << k;
    const Vector<D> shifted = location + Vector<D>::Constant(3);
    ASSERT_NEAR(a.gate_distance(shifted, R), b.gate_distance(shifted, R), 1e-12 * a.gate_distance(shifted, R)) << k;
    if (k == 30) b = AnyFilter<D>(b);
  }
}

TEST(CustomFilter, GivesTheBitsOfWhatIsBrought) {
  expect_the_same<2>(KalmanOptions{}, brought());
  expect_the_same<3>(KalmanOptions{}, brought());
}

TEST(CustomFilter, KnowsItsUnit) {
  expect_the_same<2>(KalmanOptions{}.scaled(0.75), scaled(scaled(brought(), 0.25), 3));
}

TEST(CustomFilter, ACopyGoesOnByItself) {
  AnyFilter<2> one(brought(), Vector<2>(1, 2), Matrix<2>::Identity());
  AnyFilter<2> copy = one;
  copy.predict(1);
  copy.correct(Vector<2>(50, 60), Matrix<2>::Identity());
  EXPECT_EQ(one.position(), Vector<2>(1, 2));
  AnyFilter<2> moved = std::move(copy);
  EXPECT_GT(moved.position().x(), 10);
}

TEST(CustomFilter, HasANameAndIsNotNamedOnTheCommandLine) {
  EXPECT_EQ(name_of(brought()), "brought");
  EXPECT_THROW(filter_named("brought"), Error);
}

/// Goes wrong at its second correction.
class Wrong final : public CustomModel<2> {
 public:
  explicit Wrong(MotionEstimate<2> later) : later_(std::move(later)) {}
  std::unique_ptr<CustomModel<2>> copy() const override { return std::make_unique<Wrong>(*this); }
  void predict(double) override {}
  void correct(const Vector<2>&, const Matrix<2>&) override { ++corrected_; }
  MotionEstimate<2> estimate() const override { return corrected_ < 2 ? MotionEstimate<2>{} : later_; }

 private:
  MotionEstimate<2> later_;
  int corrected_ = 0;
};

TEST(CustomFilter, RefusesWhatIsNoEstimate) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  const Matrix<2> I = Matrix<2>::Identity();
  const MotionEstimate<2> wrongs[] = {{.position = {nan, 0}},
                                      {.velocity = {0, std::numeric_limits<double>::infinity()}},
                                      {.covariance = nan * I},
                                      {.covariance = -1 * I}};
  for (const MotionEstimate<2>& wrong : wrongs) {
    const CustomFilterOptions options{
        .plane = [&](const Vector<2>&, const Matrix<2>&, double) { return std::make_unique<Wrong>(wrong); }};
    AnyFilter<2> filter(options, {0, 0}, I);
    filter.correct({1, 1}, I);
    EXPECT_THROW(filter.correct({1, 1}, I), Error);
  }
  EXPECT_THROW(AnyFilter<3>(CustomFilterOptions{.plane = brought_kalman<2>()}, Vector<3>::Zero(), Matrix<3>::Identity()), Error);
}

}  // namespace
}  // namespace marey::filter
