// From views of a wand, or of people's body points, to static cameras roughly right.
//
// Begins with the two cameras whose common views fix their relation best (many, and from different directions), and places what
// they saw; then always the camera that sees most of what is placed is set by it, so that cameras without a common view are chained
// by the others. A wand's length gives the scale. After each camera all is adjusted together.
// Cost: a pair's RANSAC for the most promising pairs, then one resection and one small bundle a camera.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "marey/calibrate/bundle/bundle.h"
#include "marey/calibrate/line_placement.h"

namespace marey::calibrate {

struct Growth {
  bundle::Bundle bundle;  ///< body i is instant i; those not placed have no observations
  bundle::BundleResult fit;
};

/// How refusals name what the cameras saw, and what helps.
struct GrowthSubject {
  const char* name = "the wand";
  const char* more = "wave it longer";
  const char* everywhere = "move it through the whole volume, up and down, near and far, and turn it";
  const char* shared = "wave the wand where it and another camera both see it";
};

/// In the frame of the bundle's first camera; a single point's scale is arbitrary. `table` has all of the line's markers, or
/// nothing. Throws Error, with the cause and what to do, where cameras cannot be related: one place, a plane, a line of other
/// proportions.
Growth grow_rig(const std::vector<StartingCamera>& cameras, const MarkerLine& line, const MarkTable& table, std::uint64_t seed,
                const GrowthSubject& subject = {});

/// At how many instants two cameras both see the markers, by camera and camera.
std::vector<std::vector<int>> shared_views(const MarkTable& table, std::size_t cameras);

/// Refuses cameras that share too few instants, directly or indirectly, to become one rig.
void require_connected(const std::vector<std::string>& names, const std::vector<std::vector<int>>& shared, int minimum);

}  // namespace marey::calibrate
