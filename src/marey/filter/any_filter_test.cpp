#include "marey/filter/any_filter.h"

#include <optional>
#include <vector>

#include <gtest/gtest.h>

namespace marey::filter {
namespace {

/// Where the model itself and AnyFilter differ in any bit over an uneven walk: the step, or nothing.
template <int D>
struct FirstDifference {
  FilterOptions options;

  template <typename F>
  std::optional<int> operator()(const typename F::Options& chosen) const {
    const Matrix<D> R = 0.3 * Matrix<D>::Identity();
    Vector<D> location = Vector<D>::Constant(10);
    F model(chosen, location, R);
    AnyFilter<D> any(options, location, R);
    for (int k = 0; k < 50; ++k) {
      const double dt = k % 3 == 0 ? 0.02 : 0.05;
      location += Vector<D>::LinSpaced(1, 2) * (k < 25 ? 1 : -0.5);
      model.predict(dt);
      any.predict(dt);
      if (!same(model, any, location, R)) return k;
      if (k % 7 == 3) continue;
      model.correct(location, R);
      any.correct(location, R);
      if (!same(model, any, location, R)) return k;
    }
    return std::nullopt;
  }

  template <typename F>
  static bool same(const F& model, const AnyFilter<D>& any, const Vector<D>& z, const Matrix<D>& R) {
    if constexpr (requires { model.search_reach(1.0); }) {
      if (model.search_reach(1.0) != any.search_reach(1.0)) return false;
    } else if (any.search_reach(1.0) < 1e300) {
      return false;
    }
    return model.position() == any.position() && model.velocity() == any.velocity() && model.covariance() == any.covariance() &&
           model.innovation_covariance(R) == any.innovation_covariance(R) && model.gate_distance(z, R) == any.gate_distance(z, R);
  }
};

TEST(AnyFilter, GivesTheBitsOfTheModelItHolds) {
  for (const NamedFilter& filter : named_filters()) {
    EXPECT_EQ(with_filter<2>(filter.options, FirstDifference<2>{filter.options}), std::nullopt) << filter.name;
    EXPECT_EQ(with_filter<3>(filter.options, FirstDifference<3>{filter.options}), std::nullopt) << filter.name;
  }
}

AnyFilter<2> walked(const FilterOptions& options, double speed) {
  AnyFilter<2> filter(options, Vector<2>(1, 2), Matrix<2>::Identity());
  for (int k = 1; k <= 10; ++k) {
    filter.predict(0.04);
    filter.correct(Vector<2>(1 + speed * k, 2), Matrix<2>::Identity());
  }
  return filter;
}

TEST(AnyFilter, ACopyGoesOnAlikeAndByItself) {
  for (const NamedFilter& filter : named_filters()) {
    AnyFilter<2> one = walked(filter.options, 3);
    AnyFilter<2> copy = one;
    const Vector<2> before = one.position();
    copy.predict(0.1);
    copy.correct(Vector<2>(50, 60), Matrix<2>::Identity());
    EXPECT_EQ(one.position(), before) << filter.name;
    one.predict(0.1);
    one.correct(Vector<2>(50, 60), Matrix<2>::Identity());
    EXPECT_EQ(one.position(), copy.position()) << filter.name;
    EXPECT_EQ(one.covariance(), copy.covariance()) << filter.name;
  }
}

/// Every kind takes over every other's place: what it held is released (by address sanitizer), and it continues as that one.
TEST(AnyFilter, IsAssignedAcrossKinds) {
  for (const NamedFilter& from : named_filters()) {
    for (const NamedFilter& to : named_filters()) {
      AnyFilter<2> source = walked(from.options, 3);
      AnyFilter<2> target = walked(to.options, -2);
      target = source;
      target.predict(0.04);
      source.predict(0.04);
      EXPECT_EQ(target.position(), source.position()) << from.name << " to " << to.name;
      AnyFilter<2> moved = walked(to.options, -2);
      moved = std::move(target);
      EXPECT_EQ(moved.position(), source.position()) << from.name << " to " << to.name;
    }
  }
}

TEST(AnyFilter, SurvivesBeingMovedAboutInAVector) {
  std::vector<AnyFilter<3>> filters;
  for (int round = 0; round < 3; ++round) {
    for (const NamedFilter& filter : named_filters()) {
      filters.emplace_back(filter.options, Vector<3>::Constant(static_cast<double>(filters.size())), Matrix<3>::Identity());
    }
  }
  filters.erase(filters.begin(), filters.begin() + 5);
  for (std::size_t i = 0; i < filters.size(); ++i) {
    filters[i].predict(0.02);
    EXPECT_NEAR(filters[i].position().x(), static_cast<double>(i) + 5, 25);
    EXPECT_NEAR(filters[i].position().x(), filters[i].position().z(), 25);
  }
}

}  // namespace
}  // namespace marey::filter
