#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "marey/core/appearance.h"
#include "marey/core/geometry.h"
#include "marey/geometry/pitch.h"

namespace marey::draw {

/// One page that a browser shows without anything else: who ran how far and how fast, where each person was. Steps do not know each
/// other, so that the caller says what stands in the table, and how the paths ran.
struct MatchReport {
  struct Person {
    std::string name, team;
    std::optional<Appearance> appearance = {};                   ///< what the team is drawn in; else it is given a colour
    std::vector<std::string> cells;                              ///< of its row, after name and team
    std::vector<std::vector<Vector<2>>> paths;                   ///< m on the pitch
    std::vector<std::vector<std::pair<double, double>>> speeds;  ///< s, m/s; a line a path
    int heat_columns = 0, heat_rows = 0;                         ///< cells along x and y
    double heat_cell_m = 2;
    std::vector<double> heat;  ///< seconds in each, by rows
  };
  struct Table {
    std::string title;
    std::vector<std::string> head;
    std::vector<std::vector<std::string>> rows;
  };

  std::string title;
  geometry::PitchSize pitch;
  Vector<2> corner = Vector<2>::Zero();  ///< m: the pitch's, in the frame of the paths
  std::vector<std::string> columns;      ///< of the table of people, after name and team
  std::vector<Person> people;
  std::vector<Table> tables;  ///< others, such as of teams
};

std::string to_html(const MatchReport& report);

}  // namespace marey::draw
