#include "marey/draw/page.h"

#include <gtest/gtest.h>

#include "support/text.h"

namespace marey::draw {
namespace {

bool has(const std::string& html, const std::string& part) {
  return html.find(part) != std::string::npos;
}

std::string body_of(const PageTable& table) {
  Page page("title");
  page.add(table);
  const std::string html = page.html();
  return html.substr(html.find("<body>"), html.find("<script>") - html.find("<body>"));
}

TEST(Page, LeavesOutEmptyColumnsAndEmptyTables) {
  const std::string html = body_of({.title = "People", .head = {"no.", "name", "km"}, .rows = {{"1", "", "2.5"}, {"2", "", ""}}});
  EXPECT_FALSE(has(html, "name"));
  EXPECT_EQ(test::count_of("<td", html), 4u);
  EXPECT_EQ(body_of({.title = "The ball", .head = {"team"}, .rows = {}}).find("The ball"), std::string::npos);
}

TEST(Page, NumbersHaveBarsAndTextsColours) {
  const PageTable table{.title = "t",
                        .head = {"team", "mean", "left"},
                        .rows = {{"white", "5", "1.5 ± 0.2"}, {"<b>", "10", "–"}},
                        .colours = {{"white", "#fff"}}};
  const std::string html = body_of(table);
  EXPECT_TRUE(has(html, R"(style="--w:50%" data-label="mean">5<)")) << html;
  EXPECT_TRUE(has(html, R"(<td class="n" data-label="left">1.5 ± 0.2<)")) << "one number has no bar: " << html;
  EXPECT_TRUE(has(html, R"(<td class="n" data-label="left">–<)")) << html;
  EXPECT_TRUE(has(html, R"(<i style="--c:#fff"></i>white)")) << html;
  EXPECT_TRUE(has(html, "&lt;b&gt;"));
}

TEST(Page, AGroupStandsOverItsColumnsAndInTheirLabels) {
  PageTable table{.title = "t", .head = {"name", "0-2", "2-4", "seen"}, .rows = {{"a", "1", "2", "3"}}};
  table.groups = {"", "metres", "metres"};
  const std::string html = body_of(table);
  EXPECT_TRUE(has(html, R"(colspan="2">metres<)")) << html;
  EXPECT_TRUE(has(html, "data-label=\"metres: 0\u20112\">1<")) << "a range is not broken: " << html;
  EXPECT_FALSE(has(html, "<table class"));
  table.head.insert(table.head.end(), {"a", "b", "c"});
  table.rows.front().insert(table.rows.front().end(), {"1", "1", "1"});
  EXPECT_TRUE(has(body_of(table), "<table class=\"cards\"")) << "cards on a phone";
}

TEST(Page, ChartsHaveTitlesTicksAndLegends) {
  const LineChart chart{.title = "Distance", .x_label = "recording", .y_label = "km", .lines = {{"Kim", {{1, 9}, {40, 10}}}}};
  Page page("title");
  page.add(std::vector{chart});
  const std::string html = page.html();
  for (const char* part : {"Distance, km", ">1<", ">37<", ">recording<", "</i>Kim"}) EXPECT_TRUE(has(html, part)) << part;
  EXPECT_FALSE(has(html, ">2<")) << "not more ticks than fit";
}

}  // namespace
}  // namespace marey::draw
