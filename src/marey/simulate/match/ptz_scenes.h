// Kinds of clips on which calibration of a PTZ camera is hard, each by what broadcasts show.
#pragma once

#include <span>
#include <string_view>

#include "marey/simulate/match/ptz_match.h"

namespace marey::simulate::match {

/// Names of the scenes: plain, whip (thrown pans), thin (narrow, pale lines), wet, worn (paint missing), extra (another sport's
/// lines), low (television of few bits: blurred and noisy), near (a goal area fills the image, thin lines), mats (mats with white
/// edges beside the pitch, mown stripes with shining seams), junior (children's pitches across both halves, as bright), screen
/// (recorded by hand off a screen), hockey (another sport: no football camera is to be found there), all (a little of everything).
std::span<const std::string_view> ptz_scene_names();

/// Throws Error, with the names, if there is no scene of that name.
PtzMatchOptions ptz_scene(std::string_view name);

}  // namespace marey::simulate::match
