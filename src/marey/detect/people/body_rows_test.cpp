#include "marey/detect/people/body_rows.h"

#include <cmath>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

namespace marey::detect::people {
namespace {

constexpr double kGrassLevel = 95, kGrassChroma = 120;  // levels

/// A body in an upright box of an enlarged picture, scaled down by kFine: edges lie where they are told to, to a share of a pixel.
constexpr int kFine = 8;

struct DrawnBody {
  double top = 40.5, left_sole = 120.5, right_sole = 120.5;  ///< rows of its edges, px
  double shirt = 220, sock = 210, shoe = 30;                 ///< levels
  double line = 0;                                           ///< level of a line of paint below the feet; 0 for none
};

struct SeenBody {
  Picture picture;
  cv::Mat mask;
  Box box;
};

void fill_part(cv::Mat& fine, double left, double top, double right, double bottom, double level) {
  const auto at = [](double value) { return static_cast<int>(std::lround((value + 0.5) * kFine)); };
  fine(cv::Rect(cv::Point(at(left), at(top)), cv::Point(at(right), at(bottom))) & cv::Rect({0, 0}, fine.size())).setTo(level);
}

/// As a camera that sharpens shows it, and a mask of whatever differs from the empty scene by more than noise.
SeenBody seen_body(const DrawnBody& body) {
  const cv::Size size(120, 170);
  cv::Mat scene(size * kFine, CV_32FC1, cv::Scalar(kGrassLevel));
  const double lower = std::max(body.left_sole, body.right_sole), height = lower - body.top;
  if (body.line > 0) fill_part(scene, 0, lower + 5, size.width, lower + 9, body.line);
  cv::Mat fine = scene.clone();
  const double width = 0.3 * height, middle = 60, shoe = 0.06 * height;
  fill_part(fine, middle - 0.08 * height, body.top, middle + 0.08 * height, body.top + 0.15 * height, 40);
  fill_part(fine, middle - width / 2, body.top + 0.15 * height, middle + width / 2, body.top + 0.55 * height, body.shirt);
  for (const double side : {-1.0, 1.0}) {
    const double sole = side < 0 ? body.left_sole : body.right_sole, inner = middle + side * 0.04 * height,
                 outer = middle + side * width / 2;
    fill_part(fine, std::min(inner, outer), body.top + 0.5 * height, std::max(inner, outer), sole - shoe, body.sock);
    fill_part(fine, std::min(inner, outer), sole - shoe, std::max(inner, outer), sole, body.shoe);
  }
  const auto filmed = [&](const cv::Mat& sharp) {
    cv::Mat small, wide;
    cv::resize(sharp, small, size, 0, 0, cv::INTER_AREA);
    cv::GaussianBlur(small, small, {}, 1.0);
    cv::GaussianBlur(small, wide, {}, 2.0);
    small = 1.45 * small - 0.45 * wide;
    small.convertTo(small, CV_8U);
    return small;
  };
  const cv::Mat luma = filmed(fine);
  cv::Mat mask;
  cv::absdiff(luma, filmed(scene), mask);
  cv::threshold(mask, mask, 6, 255, cv::THRESH_BINARY);
  const cv::Rect tight = cv::boundingRect(mask);
  const cv::Mat chroma((size.height + 1) / 2, (size.width + 1) / 2, CV_8UC1, cv::Scalar(kGrassChroma));
  return {Picture(luma, chroma, chroma, Picture::Range::limited),
          mask,
          {double(tight.x), double(tight.y), double(tight.width), double(tight.height)}};
}

TEST(BodyRows, EndWhereTheBodyDoesNotWhereItsHaloDoes) {
  for (const double height : {30.0, 60.0, 110.0}) {
    for (const double shoe : {30.0, 230.0}) {
      if (height < 40 && shoe < kGrassLevel) continue;  // two pixels of shoe, which the sock's blur drowns
      for (const double part : {0.0, 0.3, 0.7}) {
        SCOPED_TRACE(fmt::format("{} px tall, shoe {}, {} px", height, shoe, part));
        DrawnBody body;
        body.shoe = shoe;
        body.left_sole = body.right_sole = body.top + height + part;
        const SeenBody one = seen_body(body);
        EXPECT_GT(one.box.foot().y() - body.left_sole, 0.6) << "the scene shows no halo";
        const auto rows = find_body_rows(one.picture, one.mask, one.box, 0.2);
        ASSERT_TRUE(rows);
        EXPECT_NEAR(rows->sole, body.left_sole, 0.5);
        EXPECT_NEAR(rows->stand, body.left_sole, 0.5);
        EXPECT_NEAR(rows->head, body.top, 0.5);
      }
    }
  }
}

TEST(BodyRows, APersonStandsBetweenTheFeet) {
  DrawnBody body;
  body.left_sole = 126.5;
  const SeenBody one = seen_body(body);
  const auto rows = find_body_rows(one.picture, one.mask, one.box, 0.2);
  ASSERT_TRUE(rows);
  EXPECT_NEAR(rows->sole, 126.5, 0.5);
  EXPECT_NEAR(rows->stand, 123.5, 0.5);
}

TEST(BodyRows, AFootInTheAirDoesNotCount) {
  DrawnBody body;
  body.left_sole = 126.5;
  const SeenBody one = seen_body(body);
  const auto rows = find_body_rows(one.picture, one.mask, one.box, 0.04);
  ASSERT_TRUE(rows);
  EXPECT_NEAR(rows->stand, 126.5, 0.5) << "on flat ground a foot is not so far behind the other";
}

TEST(BodyRows, ALineOfPaintBelowTheFeetIsNoGround) {
  DrawnBody body;
  body.line = 200;
  const SeenBody one = seen_body(body);
  const auto rows = find_body_rows(one.picture, one.mask, one.box, 0.2);
  ASSERT_TRUE(rows);
  EXPECT_NEAR(rows->stand, 120.5, 0.5);
}

TEST(BodyRows, AreNotToldWhereABodyIsCutOrHidden) {
  const SeenBody one = seen_body({});
  EXPECT_TRUE(find_body_rows(one.picture, one.mask, one.box, 0.2));
  cv::Mat legless = one.mask.clone();
  legless.rowRange(105, legless.rows).setTo(0);
  EXPECT_FALSE(find_body_rows(one.picture, legless, one.box, 0.2)) << "a board hides the legs";
  const cv::Rect upper(0, 0, one.mask.cols, 100);
  EXPECT_FALSE(
      find_body_rows(one.picture.part(upper), one.mask(upper), {one.box.left, one.box.top, one.box.width, 100 - one.box.top}, 0.2))
      << "the picture's border cuts it";
}

TEST(BodyRows, AreNotToldWithoutContrast) {
  SeenBody one = seen_body({});
  const Picture plain(cv::Mat(one.mask.size(), CV_8UC1, cv::Scalar(kGrassLevel)));
  EXPECT_FALSE(find_body_rows(plain, one.mask, one.box, 0.2));
}

}  // namespace
}  // namespace marey::detect::people
