#include "marey/detect/people/people_ends.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

namespace marey::detect::people {
namespace {

/// A figure of two legs, a trunk and a head on a lawn, sharpened as a camera does, with the shadow under its shoes; and its
/// silhouette as a background model sees it: whatever differs at all.
struct DrawnFigure {
  Image frame, scene;
  Box box;    ///< of the silhouette
  Box truth;  ///< of the figure
  std::vector<PixelRun> runs;
};

struct FigureColour {
  double y, cb, cr;
};

void fill(cv::Mat& plane, const Box& box, double value) {
  for (int row = 0; row < plane.rows; ++row) {
    for (int column = 0; column < plane.cols; ++column) {
      const double tall = std::clamp(std::min(row + 1.0, box.bottom()) - std::max<double>(row, box.top), 0.0, 1.0);
      const double wide = std::clamp(std::min(column + 1.0, box.right()) - std::max<double>(column, box.left), 0.0, 1.0);
      float& pixel = plane.at<float>(row, column);
      pixel += static_cast<float>(tall * wide * (value - pixel));
    }
  }
}

DrawnFigure draw(double height, double halo, std::mt19937& random) {
  const auto uniform = [&](double low, double high) { return std::uniform_real_distribution(low, high)(random); };
  const int rows = static_cast<int>(height) + 24, columns = static_cast<int>(0.4 * height) + 24;
  const double top = 10 + uniform(0, 1), left = 10 + uniform(0, 1), width = 0.36 * height;
  const double grass = uniform(85, 125);
  const bool white = uniform(0, 1) < 0.5;
  const FigureColour shirt = white ? FigureColour{210, 128, 128} : FigureColour{60, 165, 110}, skin{140, 115, 148};
  const FigureColour hair{uniform(25, 45), 128, 128};
  const double bright = uniform(0, 1) < 0.5 ? 215 : 30;
  const FigureColour shoe{bright, 128, 128};
  cv::Mat planes[3] = {cv::Mat(rows, columns, CV_32F, cv::Scalar(grass)), cv::Mat(rows, columns, CV_32F, cv::Scalar(118)),
                       cv::Mat(rows, columns, CV_32F, cv::Scalar(120))};
  DrawnFigure drawn;
  const auto image_of = [&] {
    cv::Mat whole[3];
    for (int k = 0; k < 3; ++k) {
      cv::Mat noise(rows, columns, CV_32F), level;
      for (int i = 0; i < rows * columns; ++i) noise.at<float>(i / columns, i % columns) = static_cast<float>(uniform(-2, 2));
      cv::GaussianBlur(planes[k], level, {}, 0.8);
      if (k == 0) {
        cv::Mat wide;
        cv::GaussianBlur(level, wide, {}, 2);
        level = (1 + halo) * level - halo * wide;
      } else {
        cv::GaussianBlur(level, level, {}, 2);
        noise *= 0.5;
      }
      level += noise;
      level.convertTo(whole[k], CV_8U);
      if (k > 0) cv::resize(whole[k], whole[k], {(columns + 1) / 2, (rows + 1) / 2}, 0, 0, cv::INTER_AREA);
    }
    return Image(whole[0], whole[1], whole[2], Image::Range::limited);
  };
  drawn.scene = image_of();
  const auto part = [&](double from_x, double from_y, double to_x, double to_y, const FigureColour& colour) {
    const Box box{left + from_x * width, top + from_y * height, (to_x - from_x) * width, (to_y - from_y) * height};
    fill(planes[0], box, colour.y), fill(planes[1], box, colour.cb), fill(planes[2], box, colour.cr);
  };
  part(0.0, 0.985, 1.0, 1.0 + 2 / height, {0.85 * grass, 119, 121});  // shadow, two pixels below the soles
  part(0.35, 0.0, 0.65, 0.07, hair);
  part(0.35, 0.07, 0.65, 0.13, skin);
  part(0.1, 0.13, 0.9, 0.5, shirt);
  for (const double leg : {0.1, 0.6}) {
    part(leg, 0.5, leg + 0.3, 0.7, skin);
    part(leg, 0.7, leg + 0.3, 0.95, shirt);
    part(leg, 0.95, leg + 0.3, 1.0, shoe);
  }
  drawn.frame = image_of();
  drawn.truth = {left, top, width, height};
  int first_row = rows, last_row = 0, first = columns, last = 0;
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      const auto differs = [&](const cv::Mat& a, const cv::Mat& b, int y, int x, int by) {
        return std::abs(a.at<std::uint8_t>(y, x) - b.at<std::uint8_t>(y, x)) > by;
      };
      const bool other = differs(drawn.frame.luma(), drawn.scene.luma(), row, column, 8) ||
                         differs(drawn.frame.cb(), drawn.scene.cb(), row / 2, column / 2, 6) ||
                         differs(drawn.frame.cr(), drawn.scene.cr(), row / 2, column / 2, 6);
      if (!other) continue;
      if (!drawn.runs.empty() && drawn.runs.back().row == row && drawn.runs.back().end == column) {
        ++drawn.runs.back().end;
      } else {
        drawn.runs.push_back({row, column, column + 1});
      }
      first_row = std::min(first_row, row), last_row = std::max(last_row, row);
      first = std::min(first, column), last = std::max(last, column);
    }
  }
  drawn.box = {static_cast<double>(first), static_cast<double>(first_row), static_cast<double>(last + 1 - first),
               static_cast<double>(last_row + 1 - first_row)};
  return drawn;
}

TEST(PeopleEnds, ABodyEndsAtItsSolesAndNotAtItsHalo) {
  std::mt19937 random(33);
  for (const double halo : {0.0, 0.45, 0.7}) {
    for (const double height : {24.0, 40.0, 60.0, 100.0, 200.0}) {
      SilhouetteExcess excess;
      double low = 0, low_before = 0, high = 0, worst = 0;
      constexpr int kCases = 100;
      for (int i = 0; i < kCases; ++i) {
        const DrawnFigure drawn = draw(height, halo, random);
        const BodyEnds ends = find_ends(drawn.runs, drawn.box, {drawn.frame, drawn.scene, {}});
        excess.learn(drawn.box, ends);
        const Box body = excess.without(drawn.box, ends);
        low += (body.bottom() - drawn.truth.bottom()) / kCases;
        low_before += (drawn.box.bottom() - drawn.truth.bottom()) / kCases;
        high += (drawn.truth.top - body.top) / kCases;
        worst = std::max(worst, std::abs(body.bottom() - drawn.truth.bottom()));
      }
      EXPECT_GT(low_before, 1.3) << "halo " << halo << ", " << height << " px";
      const bool hard = halo > 0.5 || height < 30 || height > 150;  // halo and shadow add up; shoes of one pixel
      EXPECT_LT(std::abs(low), hard ? 1.2 : 0.5) << "halo " << halo << ", " << height << " px, seed 33";
      EXPECT_LT(std::abs(high), 1.0) << "halo " << halo << ", " << height << " px, seed 33";
      EXPECT_LT(worst, 3.5) << "halo " << halo << ", " << height << " px, seed 33";
    }
  }
}

TEST(PeopleEnds, LeavesLowContrastEndUnmeasured) {
  std::mt19937 random(1);
  const DrawnFigure drawn = draw(60, 0.45, random);
  const BodyEnds ends = find_ends(drawn.runs, drawn.box, {drawn.scene, drawn.scene, {}});
  EXPECT_FALSE(ends.top);
  EXPECT_FALSE(ends.bottom);
  SilhouetteExcess excess;
  excess.learn(drawn.box, ends);
  EXPECT_EQ(excess.without(drawn.box, ends), drawn.box) << "nothing was learned";
}

TEST(PeopleEnds, PartsAtTheBorderAndTinyBoxesDoNoHarm) {
  std::mt19937 random(2);
  const DrawnFigure drawn = draw(60, 0.45, random);
  const cv::Size size = drawn.frame.size();
  for (const Box& box : {Box{-10, -10, 30, 40}, Box{0, 0, 1, 1}, Box{5, double(size.height) - 3, 30, 60}, Box{500, 500, 10, 20},
                         Box{3, 3, 9, 5}, Box{0, 0, double(size.width), double(size.height)}}) {
    const cv::Rect part = part_for_ends(box, size);
    EXPECT_EQ(part & cv::Rect({}, size), part);
    if (part.empty()) continue;
    EXPECT_EQ(part.x % 2, 0);
    EXPECT_EQ(part.y % 2, 0);
    const BodyEnds ends = find_ends(drawn.runs, box, {drawn.frame.part(part), drawn.scene.part(part), part.tl()});
    SilhouetteExcess excess;
    excess.learn(box, ends);
    EXPECT_GT(excess.without(box, ends).height, 0);
  }
}

TEST(PeopleEnds, UsesLearnedEndIfUnmeasured) {
  SilhouetteExcess excess;
  const Box box{100, 100, 30, 80};
  for (int i = 0; i < 200; ++i) excess.learn(box, {102.0 + (i % 10 == 0 ? 8 : 0), 177.0 - (i % 10 == 0 ? 8 : 0)});
  EXPECT_NEAR(excess.above(), 2, 0.3);
  EXPECT_NEAR(excess.below(), 3, 0.3);
  const Box typical = excess.without(box, {});
  EXPECT_NEAR(typical.top, 102, 0.3);
  EXPECT_NEAR(typical.bottom(), 177, 0.3);
  EXPECT_NEAR(excess.without(box, {100.0, 160.0}).bottom(), 176, 0.5) << "a measurement far off is not trusted whole";
}

}  // namespace
}  // namespace marey::detect::people
