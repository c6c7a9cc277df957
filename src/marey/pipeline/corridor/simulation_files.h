#pragma once

#include <cstdint>
#include <string>

#include "marey/core/hooks.h"
#include "marey/simulate/markers/marker_scene.h"
#include "marey/simulate/people/people_video.h"

namespace marey::pipeline::corridor {

// All of these throw Stopped where they are asked to end, and leave nothing that is begun behind.

/// Videos a scene into an H.264 file, barely compressed. Throws Error if it cannot be written.
void video_markers(const marey::simulate::markers::MarkerScene& scene, const std::string& path, const Hooks& hooks = {});

/// Writes a scene into a folder, which must exist: video.mp4, and its truth as truth.csv: `frame,time,label,x,y,visible`, 0-based
/// frames, s, px. Throws Error if a file cannot be written.
void write_markers(const marey::simulate::markers::MarkerScene& scene, const std::string& folder, const Hooks& hooks = {});

/// Videos people into a folder, which must exist:
///   video.mp4          H.264, barely compressed
///   truth.txt          MOTChallenge truth: the box of each whole person, cut at the image's border; the ninth column is the
///                      share that can be seen
///   rig.toml           the exact camera, its video as its source
///   positions.csv      frame,time,id,team,x,y,foot_x,foot_y,visible: 0-based frames, s, m on the ground, px
///   silhouettes.jsonl  an object a person and frame: frame, id, size [height, width], and the silhouettes `whole` and `visible`
///                      within the image as COCO's run lengths (column by column, background first)
/// Throws Error if a file cannot be written.
void video_people(const marey::simulate::people::PeopleVideo& video, const std::string& folder, const Hooks& hooks = {});

}  // namespace marey::pipeline::corridor
