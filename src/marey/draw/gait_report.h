#pragma once

#include <array>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace marey::draw {

/// One page that a browser shows without anything else: angles over the gait cycle with their bands, left and right, and the walk's
/// figures.
struct GaitReport {
  struct Panel {
    std::string title;  ///< "knee flexion"
    std::vector<std::pair<double, double>> left,
        right;  ///< mean and deviation, degrees, evenly from a strike to the next; empty if not known
  };
  struct Figure {
    std::string name, unit;
    std::array<std::optional<double>, 2> mean, deviation;  ///< left, right
  };
  struct Event {
    std::string side, kind;
    double time_s = 0, deviation_s = 0;
  };

  std::string title;
  std::vector<std::string> notes;  ///< what the curves omit
  std::vector<Panel> panels;
  std::vector<Figure> figures;
  std::vector<Event> events;
};

std::string to_html(const GaitReport& report);

}  // namespace marey::draw
