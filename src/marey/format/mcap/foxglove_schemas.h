// The messages of Foxglove that are written here, as protobuf descriptors (FileDescriptorSet): what a reader needs to understand
// them without knowing them. Names, numbers and types are those of Foxglove's published schemas (MIT).
#pragma once

#include <string>
#include <string_view>

namespace marey::format::mcap {

/// Serialised, of one of "foxglove.PointCloud", "foxglove.FrameTransforms", "foxglove.SceneUpdate" with all that it refers to.
const std::string& foxglove_descriptors();

}  // namespace marey::format::mcap
