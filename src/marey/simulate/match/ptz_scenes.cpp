#include "marey/simulate/match/ptz_scenes.h"

#include <array>

#include <fmt/ranges.h>

#include "marey/core/error.h"

namespace marey::simulate::match {
namespace {

constexpr std::array<std::string_view, 13> kPtzScenes{"plain", "whip", "thin",   "wet",    "worn",   "extra", "low",
                                                      "near",  "mats", "junior", "screen", "hockey", "all"};
constexpr double kSomeWhips = 0.15, kManyWhips = 0.5;  // a second

}  // namespace

std::span<const std::string_view> ptz_scene_names() {
  return kPtzScenes;
}

PtzMatchOptions ptz_scene(std::string_view name) {
  PtzMatchOptions options;
  options.operates.whips = kSomeWhips;
  if (name == "plain") {
    options.operates.whips = 0;
  } else if (name == "whip") {
    options.operates.whips = kManyWhips, options.exposure = 0.02;
  } else if (name == "thin") {
    options.paint.width = 0.07, options.paint.contrast = 0.35;
  } else if (name == "wet") {
    options.paint.wet = 1, options.paint.contrast = 0.6;
  } else if (name == "worn") {
    options.paint.missing = 0.45;
  } else if (name == "extra") {
    options.paint.extra = 14;
  } else if (name == "low") {
    options.degradation = {1.3, 0.5, 5, 1.2, 0, 8}, options.noise = 4, options.paint.contrast = 0.6;
  } else if (name == "near") {
    options.operates.width = 19, options.paint.width = 0.07, options.paint.contrast = 0.35;
  } else if (name == "mats") {
    options.paint.mats = true, options.paint.mowing = 1.8, options.paint.width = 0.08, options.paint.contrast = 0.45;
  } else if (name == "junior") {
    options.paint.junior = 2, options.paint.width = 0.08, options.paint.contrast = 0.5;
  } else if (name == "hockey") {
    options.paint.hockey = true;
  } else if (name == "screen") {
    options.screen = 6, options.degradation = {1.0, 0.4, 3, 1.2, 0, 8}, options.noise = 3;
  } else if (name == "all") {
    options.paint = {0.09, 0.5, 0.25, 6, 0.5};
    options.operates.whips = 0.3, options.exposure = 0.015;
  } else {
    throw Error("{} is not a scene; scenes are {}", name, fmt::join(kPtzScenes, ", "));
  }
  return options;
}

}  // namespace marey::simulate::match
