#include "marey/format/pitch_points.h"

#include <filesystem>

#include <gtest/gtest.h>

#include "marey/core/error.h"

#include "support/data.h"

namespace marey::format {
namespace {

TEST(PitchPoints, CsvWithAndWithoutAHeader) {
  const auto plain = parse_pitch_clicks("0,68,128.5,1141\n52.5, 34, 2796.7 ,876\r\n", "clicks.csv");
  ASSERT_EQ(plain.points.size(), 2u);
  EXPECT_EQ(plain.points[1].ground, Vector<2>(52.5, 34));
  EXPECT_EQ(plain.points[1].pixel, Vector<2>(2796.7, 876));
  const auto named = parse_pitch_clicks("name,u,v,x,y\ncorner,128.5,1141,0,68\n", "clicks.csv");
  ASSERT_EQ(named.points.size(), 1u);
  EXPECT_EQ(named.points[0].ground, Vector<2>(0, 68));
  EXPECT_EQ(named.points[0].pixel, Vector<2>(128.5, 1141));
}

TEST(PitchPoints, CvatPointsAndLines) {
  const auto clicks = parse_pitch_clicks(
      R"xml(<annotations><image id="0"><points label="(16.5,0)" points="1912.70,773.00"/>)xml"
      R"xml(<polyline label="(0,0)-(105,0)" points="10.5,20.5;30.5,40.5"/><box label="ball"/></image></annotations>)xml",
      "clicks.xml");
  ASSERT_EQ(clicks.points.size(), 1u);
  EXPECT_EQ(clicks.points[0].ground, Vector<2>(16.5, 0));
  EXPECT_LT((clicks.points[0].pixel - Vector<2>(1912.2, 772.5)).norm(), 1e-12);
  ASSERT_EQ(clicks.lines.size(), 1u);
  EXPECT_EQ(clicks.lines[0].to, Vector<2>(105, 0));
  EXPECT_EQ(clicks.lines[0].pixels[1], Vector<2>(30, 40));
}

TEST(PitchPoints, ReportsUnreadableLine) {
  const auto message = [](const char* text) {
    try {
      parse_pitch_clicks(text, "clicks");
      return std::string();
    } catch (const Error& error) {
      return std::string(error.what());
    }
  };
  EXPECT_NE(message("0,0,1,2\n0,0,one,2\n").find("clicks:2:"), std::string::npos);
  EXPECT_NE(message("0,0,1\n").find("clicks:1:"), std::string::npos);
  EXPECT_NE(message("0,0,1,nan\n").find("clicks:1:"), std::string::npos);
  EXPECT_NE(message("a,b,c,d\n0,0,1,2\n").find("header"), std::string::npos);
  EXPECT_NE(message("").find("not one point"), std::string::npos);
  EXPECT_NE(message("<annotations><image/>").find("not XML"), std::string::npos);
  EXPECT_NE(message("<annotations></annotations>").find("no <image>"), std::string::npos);
  EXPECT_NE(message(R"xml(<a><image><points label="corner" points="1,2"/></image></a>)xml").find("\"corner\""), std::string::npos);
}

TEST(PitchPoints, ARealExport) {
  const std::string left = test::data("football/left_keypoints.xml"), right = test::data("football/right_keypoints.xml");
  if (!std::filesystem::exists(left)) GTEST_SKIP() << left << " is not here";
  EXPECT_EQ(read_pitch_clicks(left).points.size(), 38u);
  EXPECT_EQ(read_pitch_clicks(right).points.size(), 39u);
}

}  // namespace
}  // namespace marey::format
