#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace marey::draw {

/// One bar, with the interval it is known to.
struct Bar {
  double value = 0;
  std::optional<double> low, high;
};

/// Bars side by side in groups: one group a row of a table, one bar a column.
struct BarChart {
  std::string title;
  std::string value_label;
  std::vector<std::string> series;  ///< what the bars of a group are
  struct Group {
    std::string name;
    std::vector<std::optional<Bar>> bars;  ///< one for each series; nothing if there is no figure
  };
  std::vector<Group> groups;
};

struct LineChart {
  std::string title;
  std::string x_label, y_label;
  bool logarithmic_y = false;  ///< all y must be positive then
  struct Line {
    std::string name;
    std::vector<std::pair<double, double>> points;  ///< in the order of x
  };
  std::vector<Line> lines;
};

/// A self-contained SVG image that a browser shows.
std::string to_svg(const BarChart& chart);
std::string to_svg(const LineChart& chart);

/// A part of a page (draw/page.h), which is its paper and writes title and legend: it is read on a phone too. x are whole numbers.
std::string part_svg(const LineChart& chart);
/// The CSS colour of the line of that index.
const char* line_colour(std::size_t index);

}  // namespace marey::draw
