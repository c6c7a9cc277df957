#include "marey/detect/people/people_hidden.h"

#include <gtest/gtest.h>

namespace marey::detect::people {
namespace {

TEST(StaticOccluders, APoleThatPeoplePassBehindIsLearnedAndForgotten) {
  StaticOccluders hidden;
  EXPECT_FALSE(hidden.at(100, 100));
  const cv::Rect pole(95, 0, 12, 200);
  for (int frame = 0; frame < 60; ++frame) {
    const Box person{60.0 + frame, 60, 30, 80};
    cv::Mat mask = cv::Mat::zeros(200, 200, CV_8UC1);
    mask(cv::Rect(60 + frame, 60, 30, 80)).setTo(255);
    mask(pole).setTo(0);
    hidden.note(person, mask);
  }
  EXPECT_TRUE(hidden.at(100, 100));
  EXPECT_FALSE(hidden.at(88, 100));
  EXPECT_FALSE(hidden.at(115, 100));
  EXPECT_FALSE(hidden.at(100, 190)) << "no person was there";
  EXPECT_FALSE(hidden.at(-1, 100));
  EXPECT_FALSE(hidden.at(200, 100));

  const cv::Mat all(200, 200, CV_8UC1, cv::Scalar(255));
  for (int frame = 0; frame < 20; ++frame) hidden.note({85, 60, 30, 80}, all);
  EXPECT_FALSE(hidden.at(100, 100)) << "the pole is gone";
}

TEST(StaticOccluders, BoxesBeyondThePictureAndEmptyMasksDoNoHarm) {
  StaticOccluders hidden;
  hidden.note({0, 0, 10, 10}, {});
  const cv::Mat pixel(1, 1, CV_8UC1, cv::Scalar(0));
  hidden.note({-50, -50, 100, 100}, pixel);
  hidden.note({500, 500, 100, 100}, pixel);
  EXPECT_FALSE(hidden.at(0, 0));
}

}  // namespace
}  // namespace marey::detect::people
