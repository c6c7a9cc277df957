// Charts of a gait report: a curve over the cycle, and the Movement Analysis Profile.
#pragma once

#include <string>
#include <vector>

#include "marey/draw/gait_report.h"

namespace marey::draw {

inline constexpr const char* kGaitLeft = "#c0392b";
inline constexpr const char* kGaitRight = "#1f77b4";

enum class GaitSides { both, left, right };

/// SVG. Of both sides: means and bands over the reference's band. Of one: its single cycles and the earlier session too.
std::string gait_panel(const GaitReport::Panel& panel, GaitSides sides, const GaitReport& report);

/// Bars of left and right for each score; a grey field is as high as the reference's mean, a line above it reaches one deviation
/// farther.
std::string gait_profile_chart(const GaitReport& report);

}  // namespace marey::draw
