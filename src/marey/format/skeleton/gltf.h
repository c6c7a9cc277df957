#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "marey/core/sink.h"
#include "marey/format/format.h"

namespace marey::format::skeleton {

/// What goes into a .glb file.
enum class GlbContent {
  scene,          ///< skeletons, markers, and the rig's cameras
  bones,          ///< skeletons alone
  vrm_animation,  ///< the same, whose bones have VRM's names and its rest pose, as the file says (VRMC_vrm_animation 1.0)
};

/// Writes a recording in space as glTF 2.0 in one binary file (.glb): y up, metres. Of bodies that form a skeleton a node a
/// segment, its motion as an animation, and a stick figure (an octahedron a bone) that is skinned to them, because programs show no
/// skeleton without a mesh; a small octahedron a marker, without size while it is not known; cameras with their angles of view.
/// Needs all of it, so that memory grows with the length. `begin` throws Error if the recording is not in space, or has no skeleton
/// for `bones`.
std::unique_ptr<Sink> create_glb(const std::string& path, GlbContent content = GlbContent::scene);

/// What the description of a .glb file says, the one who wrote it. Throws Error, with `name` for the file, where it is not one.
std::vector<Fact> facts_of_glb(std::string_view bytes, const std::string& name);

}  // namespace marey::format::skeleton
