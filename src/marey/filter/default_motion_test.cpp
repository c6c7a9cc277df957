#include "marey/filter/default_motion.h"

#include <cmath>

#include <gtest/gtest.h>

#include "marey/core/error.h"
#include "marey/filter/any_filter.h"

namespace marey::filter {
namespace {

/// By how much a filter takes the place of a person for uncertain who was seen once, after dt.
double spread_after(const FilterOptions& options, double dt) {
  const Matrix<2> R = 0.04 * 0.04 * Matrix<2>::Identity();
  AnyFilter<2> filter(options, Vector<2>::Zero(), R);
  filter.predict(dt);
  return std::sqrt(filter.innovation_covariance(R).trace() / 2);
}

TEST(DefaultMotion, LimitsPredictionToHumanSpeed) {
  for (const NamedFilter& named : named_filters()) {
    const FilterOptions people = filter_for_people_in_image(named.name);
    EXPECT_EQ(name_of(people), named.name);
    for (const double dt : {1 / 60.0, 0.04, 0.1, 0.2, 0.5})
      EXPECT_LT(spread_after(people, dt), 0.3 + 1.6 * dt) << named.name << " after " << dt << " s";
  }
}

TEST(DefaultMotion, TheUsualFilterIsTheUsualOne) {
  const auto typical = std::get<KalmanOptions>(filter_for_people_in_image("kalman"));
  EXPECT_EQ(typical.initial_speed, kPeopleInHeights.speed);
  EXPECT_EQ(typical.acceleration_noise, kPeopleInHeights.acceleration_noise);
  EXPECT_EQ(std::get<KalmanOptions>(filter_for_people_on_ground("kalman")).initial_speed, kPeopleInMetres.speed);
  EXPECT_THROW(filter_for_people_in_image("kalmann"), Error);
}

}  // namespace
}  // namespace marey::filter
