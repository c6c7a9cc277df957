// Where the floor is, by an L-frame of markers that lies on it.
//
// Blobs that stand still in each view are averaged, rays that meet are made points in space (those that most cameras agree on
// first, each blob used once), and the points are searched for the frame by the distances between its markers. Cost: blobs² a pair
// of cameras, and points to the power of markers, cut short by the distances.
#pragma once

#include <span>
#include <vector>

#include "marey/calibrate/wand/wand_marks.h"
#include "marey/core/rig.h"

namespace marey::calibrate {

struct GroundFound {
  Rigid3 ground_from_world;  ///< ground = scale · (rotation · world + translation)
  double scale = 1;
  double rms_mm = 0;             ///< of the markers' places about the frame's
  std::vector<int> observed_by;  ///< for each marker, how many cameras
};

/// Blobs that stand still, averaged: those in half of the frames at least. px.
std::vector<Vector<2>> still_blobs(std::span<const wand::BlobFrame> frames);

/// `frame`: the markers' places on the ground, m, three at least, not on a line, their distances all of their own. `blobs` by
/// camera of the rig; cameras without a pose are skipped. Where `free_scale`, the frame's size sets the rig's. Throws Error,
/// with the cause and what to do.
GroundFound find_ground(const Rig& rig, std::span<const std::vector<Vector<2>>> blobs, std::span<const Vector<3>> frame,
                        bool free_scale);

/// The floor by a board that lies on it: its first corner is the origin, x runs along its rows, z up from it. `world_from_board`:
/// as each camera that sees it has it, one at least; they are averaged, and `rms_mm` is how far they are apart. Throws Error if
/// that is so far that it must have been moved.
GroundFound ground_under_board(std::span<const Rigid3> world_from_board);

/// The rig with its world moved to the ground.
Rig moved_to_ground(const Rig& rig, const Rigid3& ground_from_world, double scale);

}  // namespace marey::calibrate
