#include "marey/track/image/box_noise.h"

#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace marey::track::image {
namespace {

/// The noise learned from `people` whose boxes behave as `truth` says, one in ten missed, over `frames` at `rate` Hz.
BoxNoise learned(const BoxNoiseLevels& truth, double rate, int people, int frames, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform;
  const double dt = 1 / rate, height = 100;
  BoxNoise noise;
  struct Person {
    Vector<2> location, velocity, log_size;
    BoxTrail trail;
  };
  std::vector<Person> all(static_cast<std::size_t>(people), Person{{500, 300}, {0, 0}, {std::log(40), std::log(height)}, {}});
  const auto draw = [&](double sigma) { return Vector<2>(sigma * normal(random), sigma * normal(random)); };
  for (int frame = 0; frame < frames; ++frame) {
    for (Person& person : all) {
      const Vector<2> kick = draw(truth.acceleration * std::sqrt(dt) * std::exp(person.log_size.y()));
      person.location += dt * person.velocity + dt / 2 * kick;
      person.velocity += kick;
      person.log_size += draw(truth.drift * std::sqrt(dt));
      const Vector<2> size = (person.log_size + draw(truth.size)).array().exp();
      const Box box = Box::from_centre(person.location + draw(truth.location * std::exp(person.log_size.y())), size.x(), size.y());
      person.trail.add(uniform(random) < 0.1 ? Box{} : box);
      noise.observe_frame(person.trail, dt);
    }
  }
  return noise;
}

TEST(BoxNoise, LearnsWhatBoxesAreLike) {
  const std::vector<BoxNoiseLevels> kinds = {{.location = 0.02, .acceleration = 0.8, .size = 0.04, .drift = 0.1},
                                             {.location = 0.05, .acceleration = 0.2, .size = 0.12, .drift = 0.05},
                                             {.location = 0.1, .acceleration = 1.5, .size = 0.2, .drift = 0.1}};
  for (const BoxNoiseLevels& truth : kinds) {
    for (const double rate : {12.5, 25.0, 30.0}) {
      const BoxNoiseLevels found = learned(truth, rate, 12, 600, 7).levels();
      EXPECT_NEAR(found.location / truth.location, 1, 0.3) << truth.location << ' ' << rate << " Hz";
      EXPECT_NEAR(found.acceleration / truth.acceleration, 1, 0.3) << truth.acceleration << ' ' << rate << " Hz";
      EXPECT_NEAR(found.size / truth.size, 1, 0.3) << truth.size << ' ' << rate << " Hz";
    }
  }
}

TEST(BoxNoise, TakesWhatLastsForThePersons) {
  const BoxNoiseLevels frame =
      learned({.location = 0.01, .acceleration = 0.5, .size = 0.02, .drift = 0.3}, 25, 12, 600, 3).levels_of_a_frame();
  EXPECT_LT(frame.location, 0.02);
  EXPECT_LT(frame.size, 0.06);
}

TEST(BoxNoise, KeepsTheFirstLevelsUntilMoreIsKnown) {
  const BoxNoiseLevels first{.location = 0.07, .acceleration = 0.4, .size = 0.15, .drift = 0.2};
  BoxNoise noise(first);
  EXPECT_EQ(noise.levels().location, first.location);
  BoxTrail trail;
  trail.add({100, 100, 40, 90});
  noise.observe_frame(trail, 0.04);
  EXPECT_NEAR(noise.levels().location, first.location, 1e-9);
  EXPECT_NEAR(noise.levels().acceleration, first.acceleration, 1e-9);
  noise.observe_frame(trail, 0);  // a frame of the same time has no information
  EXPECT_NEAR(noise.levels().size, first.size, 1e-9);
}

TEST(BoxNoise, ATrailForgets) {
  BoxTrail trail;
  EXPECT_EQ(trail.back(0), nullptr);
  trail.add({0, 0, 10, 20});
  trail.add({});
  ASSERT_NE(trail.back(1), nullptr);
  EXPECT_EQ(trail.back(0), nullptr);
  EXPECT_EQ(trail.back(2), nullptr);
  for (std::size_t i = 0; i < BoxTrail::kLength; ++i) trail.add({1, 1, 10, 20});
  EXPECT_EQ(trail.back(BoxTrail::kLength), nullptr);
  EXPECT_NE(trail.back(BoxTrail::kLength - 1), nullptr);
}

}  // namespace
}  // namespace marey::track::image
