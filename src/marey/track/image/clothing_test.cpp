#include "marey/track/image/clothing.h"

#include <random>

#include <gtest/gtest.h>

namespace marey::track::image {
namespace {

Clothes worn(float lightness, float a, float b, float deviation = 3) {
  const Appearance colour{.lightness = lightness, .a = a, .b = b, .deviation = deviation};
  return {colour, colour};
}

/// The observations of ten people of different colours for five seconds each; light and pose change them by `noise`.
std::vector<std::vector<Clothes>> ten_people(float noise) {
  std::mt19937 random(7);
  std::normal_distribution<float> change(0, noise);
  std::vector<std::vector<Clothes>> people;
  for (int identity = 0; identity < 10; ++identity) {
    std::vector<Clothes>& detected = people.emplace_back();
    const auto spread = static_cast<float>(identity * 7 % 10);
    for (int k = 0; k < 50; ++k)
      detected.push_back(worn(25 + 5 * spread + change(random), -20 + 4 * spread + change(random), change(random)));
  }
  return people;
}

TEST(Clothes, AreKeptInTwelveBytesToAUnit) {
  EXPECT_EQ(sizeof(PackedClothes), 12U);
  const Clothes kept =
      PackedClothes(Clothes{Appearance{.lightness = 61.4F, .a = -12.3F, .b = 40.6F, .deviation = 2.6F}, {}}).unpacked();
  ASSERT_TRUE(kept.upper);
  EXPECT_FALSE(kept.lower);
  EXPECT_NEAR(kept.upper->lightness, 61.4, 0.5);
  EXPECT_NEAR(kept.upper->a, -12.3, 0.5);
  EXPECT_NEAR(kept.upper->b, 40.6, 0.5);
  EXPECT_NEAR(kept.upper->deviation, 2.6, 0.07);
}

TEST(Clothes, AlikeSpeakForOnePersonAndDifferentOnesForTwo) {
  const ClothesLikelihood likelihood(ten_people(2));
  EXPECT_GT(likelihood.log_ratio(worn(40, -8, 0), worn(41, -7, 1)), 0.5);
  EXPECT_LT(likelihood.log_ratio(worn(40, -8, 0), worn(65, 12, 0)), -3);
  EXPECT_EQ(likelihood.log_ratio(worn(40, -8, 0), Clothes{}), 0) << "what is not seen says nothing";
}

TEST(Clothes, ThatChangeWithTheLightSayLess) {
  const ClothesLikelihood stabilise(ten_people(1)), flickering(ten_people(12));
  const Clothes one = worn(40, -8, 0, 1), other = worn(55, 4, 0, 1);
  EXPECT_LT(stabilise.log_ratio(one, other), flickering.log_ratio(one, other));
}

TEST(Clothes, TheMeanBelievesWhatIsSure) {
  const std::vector<Clothes> detected{worn(50, 0, 0, 2), worn(52, 0, 0, 2), worn(90, 0, 0, 20)};
  const Clothes mean = mean_clothes(detected);
  ASSERT_TRUE(mean.upper);
  EXPECT_NEAR(mean.upper->lightness, 51, 0.5);
  EXPECT_FALSE(mean_clothes({}).upper);
}

}  // namespace
}  // namespace marey::track::image
