// From views of a wand to static cameras roughly right.
//
// Begins with the two cameras whose common views fix their relation best (many, and from different directions), and places what
// they saw; then always the camera that sees most of what is placed is set by it, so that cameras without a common view are chained
// by the others. The wand's length gives the scale. After each camera all is adjusted together.
// Cost: a pair's RANSAC for the most promising pairs, then one resection and one small bundle a camera.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "marey/calibrate/bundle/bundle.h"
#include "marey/calibrate/wand/wand_placement.h"

namespace marey::calibrate {

struct Growth {
  bundle::Bundle bundle;  ///< body i is instant i; those not placed have no observations
  bundle::BundleResult fit;
};

/// In the frame of the bundle's first camera; a single light's scale is arbitrary. `table` has all of the wand's markers, or
/// nothing. Throws Error, with the cause and what to do, where cameras cannot be related: one place, a plane, a wand of other
/// proportions.
Growth grow_rig(const std::vector<wand::WandCamera>& cameras, const wand::WandShape& wand, const wand::WandTable& table,
                std::uint64_t seed);

/// At how many instants two cameras both see the wand, by camera and camera.
std::vector<std::vector<int>> shared_views(const wand::WandTable& table, std::size_t cameras);

/// Refuses cameras that share too few instants, directly or indirectly, to become one rig.
void require_connected(const std::vector<std::string>& names, const std::vector<std::vector<int>>& shared, int minimum);

}  // namespace marey::calibrate
