#pragma once

#include <cstddef>
#include <vector>

#include "marey/core/recording.h"
#include "marey/reconstruct/keypoints/person_path.h"

namespace marey::pipeline::keypoints {

/// Adds a keypoint's path from the recording's instant `first` on: two cameras' half-lines measure, gaps of up to `longest`
/// instants between such are filled, and nothing is said where the place is barely known.
void add_path(const std::vector<reconstruct::keypoints::TrajectoryPoint>& path, std::size_t first, std::size_t longest,
              TrackColumns& track);

/// Adds a keypoint as each instant has it by itself.
void add_instants(const reconstruct::keypoints::PersonTrack& person, std::size_t point, TrackColumns& track);

}  // namespace marey::pipeline::keypoints
