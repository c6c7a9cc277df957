#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "marey/core/sink.h"
#include "marey/format/format.h"

namespace marey::format::skeleton {

/// Writes the bodies of a recording that form a skeleton as glTF 2.0 in one binary file (.glb): y up, metres, a node a segment, its
/// motion as an animation, and a stick figure (an octahedron a bone) that is skinned to them, because programs show no skeleton
/// without a mesh. Needs all of it, so that memory grows with the length.
/// `vrm_animation`: bones have VRM's names and its rest pose, and the file says so (VRMC_vrm_animation 1.0).
std::unique_ptr<Sink> create_glb(const std::string& path, bool vrm_animation = false);

/// What the description of a .glb file says, the one who wrote it. Throws Error, with `name` for the file, where it is not one.
std::vector<Fact> facts_of_glb(std::string_view bytes, const std::string& name);

}  // namespace marey::format::skeleton
