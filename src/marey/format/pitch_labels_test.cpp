#include "marey/format/pitch_labels.h"

#include <gtest/gtest.h>

#include "marey/core/error.h"

namespace marey::format {
namespace {

const cv::Size kImage(961, 541);

std::string refused_labels(const std::string& text) {
  try {
    parse_pitch_labels(text, "frame.json", kImage);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(PitchLabels, OfOnePictureAndOfMany) {
  const std::string one =
      R"({"Side line top": [{"x": 0, "y": 0.5}, {"x": 1.0, "y": 0.25}], "Line unknown": [], "Circle left": []})";
  const auto images = parse_pitch_labels(one, "folder/00012.json", kImage);
  ASSERT_EQ(images.size(), 1u);
  EXPECT_EQ(images[0].name, "00012");
  ASSERT_EQ(images[0].elements.size(), 1u);
  EXPECT_EQ(images[0].elements[0].element, geometry::pitch_element_named("Side line top"));
  EXPECT_EQ(images[0].elements[0].points[1], Vector<2>(960, 135));
  const auto many = parse_pitch_labels(R"({"a": )" + one + R"(, "b": )" + one + "}", "labels.json", kImage);
  ASSERT_EQ(many.size(), 2u);
  EXPECT_EQ(many[1].name, "b");
}

TEST(PitchLabels, ReportsInvalidLabelsWithPosition) {
  EXPECT_EQ(refused_labels("{"), "frame.json: is not JSON: it breaks off or is wrong at byte 2");
  EXPECT_EQ(refused_labels("[]"), "frame.json: does not hold labels of a pitch: it must be an object of elements by name");
  EXPECT_EQ(
      refused_labels(R"({"Tramline": [{"x": 0, "y": 0}]})"),
      "frame.json: element \"Tramline\": is not an element of a pitch; the names are those of SoccerNet's camera calibration");
  EXPECT_EQ(refused_labels(R"({"Middle line": [{"x": 480, "y": 0}]})"),
            "frame.json: element \"Middle line\": a point's \"x\" must be a number, a share of the image between 0 and 1");
  EXPECT_EQ(refused_labels(R"({"Middle line": [3]})"),
            "frame.json: element \"Middle line\": a point must be an object with \"x\" and \"y\"");
  EXPECT_EQ(refused_labels(R"({"Middle line": 3})"), "frame.json: element \"Middle line\": must be a list of points");
}

}  // namespace
}  // namespace marey::format
