// What the tests of takes share: recordings compared, and a take's tables asked.
#pragma once

#include <string>

#include <gtest/gtest.h>

#include "marey/core/recording.h"
#include "marey/format/take/sqlite.h"

namespace marey::format::take::testing_take {

/// As a take keeps it: exactly, or with a float32's precision.
inline void expect_same(const Sample& a, const Sample& b) {
  EXPECT_EQ(a.track, b.track);
  EXPECT_EQ(a.position, b.position);
  EXPECT_EQ(a.provenance, b.provenance);
  EXPECT_EQ(a.cameras, b.cameras);
  EXPECT_EQ(a.box.has_value(), b.box.has_value());
  if (a.box && b.box) {
    EXPECT_EQ(a.box->left, b.box->left);
    EXPECT_EQ(a.box->top, b.box->top);
    EXPECT_EQ(a.box->width, b.box->width);
    EXPECT_EQ(a.box->height, b.box->height);
  }
  const auto floats = [](const auto& one, const auto& other) {
    ASSERT_EQ(one.has_value(), other.has_value());
    if (!one) return;
    EXPECT_TRUE(one->template cast<float>() == other->template cast<float>()) << *one << "\n" << *other;
  };
  floats(a.velocity, b.velocity);
  floats(a.covariance, b.covariance);
  const auto number = [](const std::optional<double>& one, const std::optional<double>& other) {
    ASSERT_EQ(one.has_value(), other.has_value());
    if (!one) return;
    EXPECT_EQ(static_cast<float>(*one), static_cast<float>(*other));
  };
  number(a.score, b.score);
  number(a.residual_px, b.residual_px);
  number(a.residual_m, b.residual_m);
  ASSERT_EQ(a.keypoints == nullptr, b.keypoints == nullptr);
  if (a.keypoints) {
    ASSERT_EQ(a.keypoints->points.size(), b.keypoints->points.size());
    EXPECT_EQ(static_cast<float>(a.keypoints->presence), static_cast<float>(b.keypoints->presence));
    for (std::size_t i = 0; i < a.keypoints->points.size(); ++i) {
      const auto &one = a.keypoints->points[i], &other = b.keypoints->points[i];
      ASSERT_EQ(one.has_value(), other.has_value()) << i;
      if (!one) continue;
      EXPECT_TRUE(one->position.cast<float>() == other->position.cast<float>());
      EXPECT_TRUE(one->covariance.cast<float>() == other->covariance.cast<float>());
      EXPECT_EQ(static_cast<float>(one->visibility), static_cast<float>(other->visibility));
      EXPECT_EQ(static_cast<float>(one->presence), static_cast<float>(other->presence));
    }
  }
  ASSERT_EQ(a.outline == nullptr, b.outline == nullptr);
  if (!a.outline) return;
  ASSERT_EQ(a.outline->control_points.size(), b.outline->control_points.size());
  for (std::size_t i = 0; i < a.outline->control_points.size(); ++i)
    EXPECT_TRUE(a.outline->control_points[i].cast<float>() == b.outline->control_points[i].cast<float>());
  EXPECT_EQ(a.outline->deviations.size(), b.outline->deviations.size());
  EXPECT_EQ(a.outline->order, b.outline->order);
  EXPECT_EQ(a.outline->state, b.outline->state);
  EXPECT_TRUE(a.outline->centre.cast<float>() == b.outline->centre.cast<float>());
  EXPECT_FLOAT_EQ(static_cast<float>(a.outline->scale_rate_deviation), static_cast<float>(b.outline->scale_rate_deviation));
  EXPECT_EQ(a.outline->silhouette.has_value(), b.outline->silhouette.has_value());
}

inline void expect_same(const ImageObservation& a, const ImageObservation& b) {
  EXPECT_EQ(a.camera, b.camera);
  EXPECT_EQ(a.pixel, b.pixel);
  EXPECT_EQ(a.track, b.track);
  EXPECT_EQ(a.sigma.has_value(), b.sigma.has_value());
  EXPECT_EQ(a.area.has_value(), b.area.has_value());
  EXPECT_EQ(static_cast<float>(a.sigma.value_or(0)), static_cast<float>(b.sigma.value_or(0)));
  EXPECT_EQ(static_cast<float>(a.area.value_or(0)), static_cast<float>(b.area.value_or(0)));
}

inline void expect_same(const BodyPose& a, const BodyPose& b) {
  EXPECT_EQ(a.body, b.body);
  EXPECT_EQ(a.world_from_body.rotation, b.world_from_body.rotation);
  EXPECT_EQ(a.world_from_body.translation, b.world_from_body.translation);
  EXPECT_EQ(a.tracked, b.tracked);
  ASSERT_EQ(a.other.has_value(), b.other.has_value());
  if (a.other) {
    EXPECT_EQ(geometry::rows_of(a.other->world_from_body), geometry::rows_of(b.other->world_from_body));
    EXPECT_EQ(a.other->probability, b.other->probability);
  }
  ASSERT_EQ(a.covariance.has_value(), b.covariance.has_value());
  if (a.covariance) {
    EXPECT_TRUE(a.covariance->cast<float>() == b.covariance->cast<float>());
  }
  ASSERT_EQ(a.residual_m.has_value(), b.residual_m.has_value());
  EXPECT_EQ(static_cast<float>(a.residual_m.value_or(0)), static_cast<float>(b.residual_m.value_or(0)));
}

inline void expect_same(const Instant& a, const Instant& b) {
  ASSERT_EQ(a.index, b.index);
  EXPECT_EQ(a.time, b.time);
  ASSERT_EQ(a.samples.size(), b.samples.size()) << a.index;
  for (std::size_t i = 0; i < a.samples.size(); ++i) expect_same(a.samples[i], b.samples[i]);
  ASSERT_EQ(a.detected.size(), b.detected.size()) << a.index;
  for (std::size_t i = 0; i < a.detected.size(); ++i) expect_same(a.detected[i], b.detected[i]);
  ASSERT_EQ(a.bodies.size(), b.bodies.size()) << a.index;
  for (std::size_t i = 0; i < a.bodies.size(); ++i) expect_same(a.bodies[i], b.bodies[i]);
}

inline void expect_same(const TrackColumns& a, const TrackColumns& b) {
  EXPECT_EQ(a.name, b.name);
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t row = 0; row < a.size(); ++row) {
    ASSERT_EQ(a.at()[row], b.at()[row]);
    expect_same(a.sample(row), b.sample(row));
  }
}

inline void expect_same(const Recording& a, const Recording& b) {
  ASSERT_EQ(a.instants().size(), b.instants().size());
  ASSERT_EQ(a.tracks().size(), b.tracks().size());
  for (std::size_t i = 0; i < a.tracks().size(); ++i) expect_same(a.tracks()[i], b.tracks()[i]);
  InstantsOf of_a(a), of_b(b);
  while (const auto instant = of_a.next()) expect_same(*instant, of_b.next().value());
}

inline std::int64_t number_in(const std::string& path, const std::string& query) {
  return Database(path, Database::Mode::read).number(query);
}

}  // namespace marey::format::take::testing_take
