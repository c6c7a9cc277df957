#include "marey/detect/people/people_size.h"

#include <functional>

#include <gtest/gtest.h>

#include "support/bodies.h"

namespace marey::detect::people {
namespace {

constexpr int kWidth = 768, kHeight = 576;
using HeightAt = std::function<double(double x, double y)>;

struct World {
  HeightAt height;
  double low = 120, high = 570;  ///< rows where feet are
  double fragments = 0.2, groups = 0.15, shadows = 0.1;
};

/// Shows `count` regions of people, some of them broken, grouped or with a shadow.
PersonSizeModel learned(const World& world, int count, unsigned seed) {
  std::mt19937 random(seed);
  PersonSizeModel model;
  for (int i = 0; i < count; ++i) {
    const double x = bodies::uniform(random, 60, kWidth - 60), y = bodies::uniform(random, world.low, world.high);
    const double height = world.height(x, y) * bodies::uniform(random, 0.93, 1.07);
    Box box{x - 0.18 * height, y - height, 0.36 * height, height};
    const double kind = bodies::uniform(random, 0, 1);
    if (kind < world.fragments) {
      box.height *= bodies::uniform(random, 0.2, 0.7);
    } else if (kind < world.fragments + world.groups) {
      box.width *= bodies::uniform(random, 1.5, 3);
      box.height *= bodies::uniform(random, 1.1, 1.8);
    } else if (kind < world.fragments + world.groups + world.shadows) {
      box.height *= 1.15;
    }
    model.observe_frame(box, {kWidth, kHeight});
  }
  model.fit();
  return model;
}

void expect_close(const PersonSizeModel& model, const World& world, double tolerance) {
  for (const double x : {150.0, 384.0, 620.0}) {
    for (const double y : {world.low + 40, (world.low + world.high) / 2, world.high - 20}) {
      const auto size = model.at(x, y);
      ASSERT_TRUE(size.has_value()) << x << " " << y;
      EXPECT_NEAR(size->height / world.height(x, y), 1, tolerance) << x << " " << y;
      EXPECT_NEAR(size->width / size->height, 0.36, 0.04);
    }
  }
}

TEST(PersonSizeModel, LearnsPerspectiveFromRegionsOfWhichHalfAreWrong) {
  const World world{[](double, double y) { return 20 + 0.22 * y; }};
  for (const unsigned seed : {1u, 2u, 3u, 4u}) {
    SCOPED_TRACE(seed);
    expect_close(learned(world, 400, seed), world, 0.05);
  }
}

TEST(PersonSizeModel, LearnsATiltedAFlatAndAnUpsideDownScene) {
  const World tilted{[](double x, double y) { return 15 + 0.2 * y + 0.05 * x; }};
  const World flat{[](double, double) { return 70.0; }};
  const World upside_down{[](double, double y) { return 150 - 0.18 * y; }};
  expect_close(learned(tilted, 400, 5), tilted, 0.06);
  expect_close(learned(flat, 400, 6), flat, 0.05);
  expect_close(learned(upside_down, 400, 7), upside_down, 0.06);
}

TEST(PersonSizeModel, SaysNothingFromTooLittle) {
  PersonSizeModel model;
  EXPECT_FALSE(model.at(10, 10).has_value());
  model.fit();
  EXPECT_FALSE(model.known());
  model.observe_frame({100, 100, 30, 80}, {kWidth, kHeight});
  model.observe_frame({300, 110, 31, 82}, {kWidth, kHeight});
  model.fit();
  EXPECT_FALSE(model.known());
}

TEST(PersonSizeModel, CountsStandingPersonOnce) {
  PersonSizeModel model;
  for (int i = 0; i < 1000; ++i) model.observe_frame({100.0 + i % 2, 100, 30, 80}, {kWidth, kHeight});
  model.fit();
  EXPECT_FALSE(model.known());
}

TEST(PersonSizeModel, NoPersonBeyondHorizon) {
  const World world{[](double, double y) { return 0.25 * (y - 100); }, 250, 570};
  const PersonSizeModel model = learned(world, 400, 8);
  EXPECT_TRUE(model.at(384, 300).has_value());
  EXPECT_FALSE(model.at(384, 120).has_value());
  EXPECT_FALSE(model.at(384, 20).has_value());
}

TEST(PersonSizeModel, FollowsNewEvidence) {
  PersonSizeModel model = learned({[](double, double) { return 60.0; }}, 300, 9);
  std::mt19937 random(10);
  for (int i = 0; i < 4000; ++i) {
    const double x = bodies::uniform(random, 60, kWidth - 60), y = bodies::uniform(random, 120, 570);
    model.observe_frame({x - 18, y - 100, 36, 100}, {kWidth, kHeight});
    if (model.needs_fit()) model.fit();
  }
  EXPECT_NEAR(model.at(384, 300).value().height, 100, 6);
}

TEST(PersonSizeModel, IgnoresNonUprightShapes) {
  PersonSizeModel model;
  std::mt19937 random(11);
  for (int i = 0; i < 300; ++i) {  // cars
    model.observe_frame({bodies::uniform(random, 0, 600), bodies::uniform(random, 0, 400), 150, 70}, {kWidth, kHeight});
  }
  model.fit();
  EXPECT_FALSE(model.known());
}

}  // namespace
}  // namespace marey::detect::people
