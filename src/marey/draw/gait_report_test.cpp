#include "marey/draw/gait_report.h"

#include <gtest/gtest.h>

namespace marey::draw {
namespace {

GaitReport::Panel knee() {
  GaitReport::Panel panel{.title = "knee flexion", .unit = "°", .sides = {}, .reference = {}};
  panel.sides[0].now = {.mean = {0, 60, 5}, .deviation = {1, 2, 1}};
  panel.sides[0].cycles = {{0, 58, 5}, {0, 62, 5}};
  return panel;
}

std::size_t count(const std::string& text, const std::string& wanted) {
  std::size_t found = 0;
  for (std::size_t at = text.find(wanted); at != std::string::npos; at = text.find(wanted, at + 1)) ++found;
  return found;
}

TEST(GaitReport, TheLastPerCentEndsWithinItsPanel) {
  GaitReport report;
  report.legs.push_back(knee());
  const std::string html = to_html(report);
  const std::size_t label = html.find(">100 %<");
  ASSERT_NE(label, std::string::npos);
  const std::string element = html.substr(html.rfind("<text", label), label - html.rfind("<text", label));
  EXPECT_NE(element.find("text-anchor=\"end\""), std::string::npos) << element << ": about its middle it would be cut off";
  EXPECT_NE(html.find(">75<"), std::string::npos);
}

TEST(GaitReport, HasASheetForEachPartThatItHas) {
  GaitReport report;
  report.legs.push_back(knee());
  EXPECT_EQ(count(to_html(report), "class=\"sheet\""), 4U)
      << "summary, left and right, left, quality: nothing of the right is known";
  report.legs[0].sides[1] = report.legs[0].sides[0];
  report.trunk.push_back(knee());
  EXPECT_EQ(count(to_html(report), "class=\"sheet\""), 6U);
}

TEST(GaitReport, DrawsBandsOnlyWhereThereAreDeviations) {
  GaitReport report;
  report.legs.push_back(knee());
  const std::size_t with = count(to_html(report), "<polygon");
  report.legs[0].reference = {.mean = {0, 55, 4}, .deviation = {5, 5, 5}};
  EXPECT_EQ(count(to_html(report), "<polygon"), with + 2) << "on the sheets of both sides and of the left";
  report.legs[0].reference.deviation.clear();
  report.legs[0].sides[0].now.deviation.clear();
  EXPECT_EQ(count(to_html(report), "<polygon"), 0U) << "one cycle, one person";
}

TEST(GaitReport, ShowsScoresAndWhatTheyMean) {
  GaitReport report;
  report.legs.push_back(knee());
  EXPECT_EQ(to_html(report).find("Gait Profile Score"), std::string::npos) << "without a control group";
  report.scores.push_back({.name = "knee flexion",
                           .unit = "",
                           .mean = {7.25, std::nullopt},
                           .deviation = {1.0, std::nullopt},
                           .before = {9.5, std::nullopt},
                           .reference = 4.4,
                           .reference_deviation = 1.1});
  report.overall_score = 6.3;
  const std::string html = to_html(report);
  for (const char* text : {"Gait Profile Score of both sides: 6.3°", "7.2 ± 1.0", "4.4 ± 1.1", ">9.5<"})
    EXPECT_NE(html.find(text), std::string::npos) << text;
}

TEST(GaitReport, StatesDifferencesOfSidesInPerCent) {
  GaitReport report;
  report.figures.push_back({.name = "step length",
                            .unit = "m",
                            .mean = {0.55, 0.45},
                            .deviation = {},
                            .before = {},
                            .reference = {},
                            .reference_deviation = {}});
  const std::string html = to_html(report);
  EXPECT_NE(html.find(">+20.0<"), std::string::npos);
  EXPECT_EQ(html.find("control group<"), std::string::npos) << "a column without a figure";
}

}  // namespace
}  // namespace marey::draw
