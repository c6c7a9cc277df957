#include "marey/detect/people/people_fit.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include "support/bodies.h"

namespace marey::detect::people {
namespace {

const cv::Size kFitImage(200, 160);

FitScene scene_of(double height) {
  return {kFitImage, [height](double, double) { return PersonSize{height, 0.36 * height}; }};
}

double best_iou(const std::vector<Located>& located, const Box& truth) {
  double best = 0;
  for (const Located& one : located) best = std::max(best, geometry::iou(one.box, truth));
  return best;
}

// The slow twin: pixels are counted one by one, at every place.
struct Part {
  double left, top, right, bottom;
};
constexpr std::array<Part, 3> kBody = {{{0.28, 0.0, 0.72, 0.16}, {0.10, 0.16, 0.90, 0.52}, {0.18, 0.52, 0.82, 1.0}}};
constexpr Part kAboveHead = {0.25, -0.16, 0.75, -0.02};

struct Count {
  double filled = 0, valid = 0;
};

Count count(const cv::Mat& mask, const Box& box, const Part& part) {
  Count result;
  const auto round = [](double value) { return static_cast<int>(std::lround(value)); };
  for (int y = round(box.top + part.top * box.height); y < round(box.top + part.bottom * box.height); ++y) {
    for (int x = round(box.left + part.left * box.width); x < round(box.left + part.right * box.width); ++x) {
      if (x < 0 || y < 0 || x >= mask.cols || y >= mask.rows) continue;
      ++result.valid;
      result.filled += mask.at<std::uint8_t>(y, x) != 0;
    }
  }
  return result;
}

double value_at(const cv::Mat& mask, const Box& box, const FitOptions& options) {
  double filled = 0, valid = 0, area = 0;
  for (const Part& part : kBody) {
    const Count counted = count(mask, box, part);
    filled += counted.filled;
    valid += counted.valid;
    area += (part.right - part.left) * (part.bottom - part.top) * box.area();
  }
  if (valid < 0.3 * area) return -1;
  const double cover = (filled - options.blank_penalty * (valid - filled)) / valid - 0.2 * std::max(0.0, 1 - valid / area);
  if (cover < options.min_cover_new) return -1;
  const double arms = 0.2 * std::max(0.0, count(mask, box, {0, 0, 1, 1}).filled - filled) / area;
  const Count above = count(mask, box, kAboveHead);
  return cover + arms - (above.valid > 0 ? 0.3 * above.filled / above.valid : 0);
}

TEST(FitPeople, TheFirstPersonIsWhereTheSlowTwinFindsTheBestPlace) {
  const FitOptions options;
  int found = 0;
  for (unsigned seed = 1; seed <= 6; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    const double height = std::floor(bodies::uniform(random, 28, 46));  // a cell is one pixel
    const Box truth = bodies::person(bodies::uniform(random, 20, 180), bodies::uniform(random, 50, 150), height);
    cv::Mat mask = cv::Mat::zeros(kFitImage, CV_8UC1);
    bodies::draw(mask, truth, bodies::uniform(random, 0, 1));
    for (int i = 0; i < 300; ++i) {  // noise, in the body and round it
      mask.at<std::uint8_t>(static_cast<int>(bodies::uniform(random, truth.top, truth.bottom())),
                            static_cast<int>(bodies::uniform(random, truth.left, truth.right()))) = i % 3 == 0 ? 0 : 255;
    }
    const FitScene scene = scene_of(height);
    const auto located = fit_people(bodies::runs(mask), {}, scene, options);
    double best = -1;
    for (double y = 0; y < kFitImage.height + 40; ++y) {
      for (double x = -20; x < kFitImage.width + 20; ++x) {
        best = std::max(best, value_at(mask, scene.size_at(x, y)->box_at(x, y), options));
      }
    }
    ASSERT_EQ(located.size(), 1u);
    // The grid's origin is not a whole pixel off the twin's, but rounding a part's edge may differ by a pixel.
    EXPECT_NEAR(value_at(mask, located[0].box, options), best, 0.02);
    EXPECT_GT(geometry::iou(located[0].box, truth), 0.75);
    ++found;
  }
  EXPECT_EQ(found, 6);
}

TEST(FitPeople, GroupsAreSplitIntoWholeBodies) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    const double height = 60;
    const int people = 2 + static_cast<int>(seed % 2);
    cv::Mat mask = cv::Mat::zeros(kFitImage, CV_8UC1);
    std::vector<Box> truth;
    for (int i = 0; i < people; ++i) {
      truth.push_back(bodies::person(50 + i * bodies::uniform(random, 17, 20), bodies::uniform(random, 100, 112), height));
      bodies::draw(mask, truth.back(), bodies::uniform(random, 0, 1));
    }
    const auto located = fit_people(bodies::runs(mask), {}, scene_of(height));
    ASSERT_EQ(located.size(), truth.size());
    for (const Box& one : truth) EXPECT_GT(best_iou(located, one), 0.6);
  }
}

TEST(FitPeople, KnownPeopleKeepTheirPlacesWhereOneHidesHalfOfTheOther) {
  const Box front = bodies::person(80, 120, 60), behind = bodies::person(90, 112, 60);
  cv::Mat mask = cv::Mat::zeros(kFitImage, CV_8UC1);
  bodies::draw(mask, front);
  bodies::draw(mask, behind);
  const std::array<Box, 2> known = {Box{front.left - 2, front.top, front.width, front.height},
                                    Box{behind.left + 2, behind.top + 1, behind.width, behind.height}};
  const auto located = fit_people(bodies::runs(mask), known, scene_of(60));
  ASSERT_EQ(located.size(), 2u);
  for (const Located& one : located) {
    ASSERT_GE(one.known, 0);
    EXPECT_GT(geometry::iou(one.box, one.known == 0 ? front : behind), 0.7);
    EXPECT_GT(one.detected, 0.8);
  }
  EXPECT_NE(located[0].known, located[1].known);
}

TEST(FitPeople, KnownOccluderCausesNoAmbiguity) {
  const Box truth = bodies::person(80, 120, 60);
  const cv::Rect sign(60, 76, 40, 28);
  cv::Mat mask = cv::Mat::zeros(kFitImage, CV_8UC1);
  bodies::draw(mask, truth);
  mask(sign).setTo(0);
  FitScene scene = scene_of(60);
  EXPECT_TRUE(fit_people(bodies::runs(mask), {}, scene).empty());
  scene.hidden = [&](double x, double y) { return sign.contains(cv::Point(static_cast<int>(x), static_cast<int>(y))); };
  const auto located = fit_people(bodies::runs(mask), {}, scene);
  ASSERT_EQ(located.size(), 1u);
  EXPECT_GT(geometry::iou(located[0].box, truth), 0.8);
}

TEST(FitPeople, APersonCutByTheBorderHasAWholeBody) {
  const Box truth = bodies::person(4, 120, 60);
  cv::Mat mask = cv::Mat::zeros(kFitImage, CV_8UC1);
  bodies::draw(mask, truth);
  const auto located = fit_people(bodies::runs(mask), {}, scene_of(60));
  ASSERT_EQ(located.size(), 1u);
  EXPECT_GT(geometry::iou(located[0].box, truth), 0.6);
}

TEST(FitPeople, NothingComesOfNothing) {
  EXPECT_TRUE(fit_people({}, {}, scene_of(60)).empty());
  const std::array<PixelRun, 1> pixel = {PixelRun{80, 100, 101}};
  EXPECT_TRUE(fit_people(pixel, {}, scene_of(60)).empty());
  const FitScene unknown{kFitImage, [](double, double) { return std::optional<PersonSize>(); }};
  cv::Mat mask = cv::Mat::zeros(kFitImage, CV_8UC1);
  bodies::draw(mask, bodies::person(80, 120, 60));
  EXPECT_TRUE(fit_people(bodies::runs(mask), {}, unknown).empty());
}

}  // namespace
}  // namespace marey::detect::people
