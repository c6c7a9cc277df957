#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "marey/draw/page.h"

namespace marey::draw {

/// One page that a browser shows and prints without anything else, a sheet of A4 for each part: a summary, left against right, the
/// left side, the right side, trunk and arms, quality. Arrays of two are left and right.
struct GaitReport {
  /// Evenly from a strike of the foot to its next. Deviations are as many as means, or none.
  struct Curve {
    std::vector<double> mean, deviation;
  };
  struct Side {
    Curve now, before;                        ///< empty if not known
    std::vector<std::vector<double>> cycles;  ///< each by itself
  };
  struct Panel {
    std::string title, unit;  ///< "knee flexion", "°"
    std::array<Side, 2> sides;
    Curve reference;
  };
  /// A figure of the walk, or a score in degrees.
  struct Figure {
    std::string name, unit;
    std::array<std::optional<double>, 2> mean, deviation, before;
    std::optional<double> reference, reference_deviation;
  };
  struct Event {
    std::string side, kind;
    double time_s = 0, deviation_s = 0;
  };

  std::string title;
  std::vector<std::string> lead;  ///< the measurement, and its comparisons
  std::vector<Figure> figures;
  std::vector<Figure> scores;  ///< Movement Analysis Profile; the last is the sides' Gait Profile Score
  std::optional<double> overall_score, overall_before;
  std::vector<Panel> legs, trunk, forces;  ///< forces: the ground's, joint moments, powers
  std::vector<Panel> muscles;
  std::array<std::optional<double>, 2> off_percent;  ///< where the foot leaves the ground
  std::vector<std::string> warnings;
  std::vector<std::string> quality;  ///< sentences
  std::vector<PageTable> tables;     ///< of the quality
  std::vector<Event> events;
};

std::string to_html(const GaitReport& report);

}  // namespace marey::draw
