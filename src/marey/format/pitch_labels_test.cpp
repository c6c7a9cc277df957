#include "marey/format/pitch_labels.h"

#include <gtest/gtest.h>

#include "marey/core/error.h"

namespace marey::format {
namespace {

const cv::Size kPicture(961, 541);

std::string refused_labels(const std::string& text) {
  try {
    parse_pitch_labels(text, "frame.json", kPicture);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(PitchLabels, OfOnePictureAndOfMany) {
  const std::string one =
      R"({"Side line top": [{"x": 0, "y": 0.5}, {"x": 1.0, "y": 0.25}], "Line unknown": [], "Circle left": []})";
  const auto pictures = parse_pitch_labels(one, "folder/00012.json", kPicture);
  ASSERT_EQ(pictures.size(), 1u);
  EXPECT_EQ(pictures[0].name, "00012");
  ASSERT_EQ(pictures[0].elements.size(), 1u);
  EXPECT_EQ(pictures[0].elements[0].element, geometry::pitch_element_named("Side line top"));
  EXPECT_EQ(pictures[0].elements[0].points[1], Vector<2>(960, 135));
  const auto many = parse_pitch_labels(R"({"a": )" + one + R"(, "b": )" + one + "}", "labels.json", kPicture);
  ASSERT_EQ(many.size(), 2u);
  EXPECT_EQ(many[1].name, "b");
}

TEST(PitchLabels, WhatIsNoneSaysWhereAndWhy) {
  EXPECT_EQ(refused_labels("{"), "frame.json: is no JSON: it breaks off or is wrong at byte 2");
  EXPECT_EQ(refused_labels("[]"), "frame.json: is no labels of a pitch: it must be an object of elements by name");
  EXPECT_EQ(refused_labels(R"({"Tramline": [{"x": 0, "y": 0}]})"),
            "frame.json: element \"Tramline\": is no element of a pitch; the names are those of SoccerNet's camera calibration");
  EXPECT_EQ(refused_labels(R"({"Middle line": [{"x": 480, "y": 0}]})"),
            "frame.json: element \"Middle line\": a point's \"x\" must be a number, a share of the picture between 0 and 1");
  EXPECT_EQ(refused_labels(R"({"Middle line": [3]})"),
            "frame.json: element \"Middle line\": a point must be an object with \"x\" and \"y\"");
  EXPECT_EQ(refused_labels(R"({"Middle line": 3})"), "frame.json: element \"Middle line\": must be a list of points");
}

}  // namespace
}  // namespace marey::format
