#include "marey/draw/gait_report.h"

#include <gtest/gtest.h>

namespace marey::draw {
namespace {

TEST(GaitReport, TheLastPerCentEndsWithinItsPanel) {
  GaitReport report;
  report.panels.push_back({.title = "knee flexion", .left = {{0, 1}, {60, 2}, {5, 1}}, .right = {}});
  const std::string html = to_html(report);
  const std::size_t label = html.find(">100 %<");
  ASSERT_NE(label, std::string::npos);
  const std::string element = html.substr(html.rfind("<text", label), label - html.rfind("<text", label));
  EXPECT_NE(element.find("text-anchor=\"end\""), std::string::npos) << element << ": about its middle it would be cut off";
  EXPECT_NE(html.find(">75<"), std::string::npos);
}

}  // namespace
}  // namespace marey::draw
