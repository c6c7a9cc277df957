// Kinds of clips on which calibration of a PTZ camera is hard, each by what broadcasts show.
#pragma once

#include <span>
#include <string_view>

#include "marey/simulate/match/ptz_match.h"

namespace marey::simulate::match {

/// Names of the scenes: plain, whip (thrown pans), thin (narrow, pale lines), wet, worn (paint missing), extra (another sport's
/// lines), low (television of few bits: blurred and noisy), all (a little of everything).
std::span<const std::string_view> ptz_scene_names();

/// Throws Error, with the names, if there is no scene of that name.
PtzMatchOptions ptz_scene(std::string_view name);

}  // namespace marey::simulate::match
