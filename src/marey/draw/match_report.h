#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "marey/core/appearance.h"
#include "marey/core/geometry.h"
#include "marey/draw/page.h"
#include "marey/draw/pitch_frame.h"

namespace marey::draw {

/// One page that a browser shows without anything else: how far and fast players ran, where each person was, and where each team
/// was in each half. Steps do not know each other, so that the caller says what stands in the table, and how the paths ran.
struct MatchReport {
  struct Person {
    int number = 0;  ///< as videos and images have it
    std::string name, team;
    std::optional<Appearance> appearance = {};                   ///< what the team is drawn in; else it is given a colour
    std::vector<std::string> cells;                              ///< of its row, after number, name and team
    std::vector<std::vector<Vector<2>>> paths;                   ///< m on the pitch
    std::vector<std::vector<std::pair<double, double>>> speeds;  ///< s, m/s; a line a path, as many as that has places
    std::vector<std::vector<bool>> detected;                     ///< of each of them whether it is known: else it is not drawn
    std::vector<std::pair<double, double>> sprints;              ///< s: when each began and ended
    int heat_columns = 0, heat_rows = 0;                         ///< cells along x and y
    double heat_cell_m = 2;
    std::vector<double> heat;  ///< seconds in each, by rows
  };
  /// A part of the match whose territories stand side by side.
  struct Period {
    std::string name;
    double begin_s = 0, end_s = 0;
  };

  std::string title, lead;           ///< what it is of, and in a sentence what is in it
  std::vector<std::string> notes;    ///< what is doubtful
  PitchFrame pitch;                  ///< in the frame of the paths
  std::vector<std::string> columns;  ///< of the table of people, after number, name and team
  std::vector<std::string> groups;   ///< of these columns, as PageTable has them
  std::vector<Person> people;
  std::vector<Period> periods;    ///< none: the whole of it
  std::vector<PageTable> tables;  ///< others, such as of teams
};

std::string to_html(const MatchReport& report);

/// The fewest cells, the fullest first, in which `share` of all seconds were spent: by cell, whether it is one of them. Of equal
/// cells the first.
std::vector<bool> fullest_cells(const std::vector<double>& seconds, double fraction);

}  // namespace marey::draw
