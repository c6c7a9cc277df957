// Skeletons as other programs have them: what bones are called, how they stand at rest, and how BVH files are turned.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "marey/core/recording.h"
#include "marey/core/sink.h"
#include "marey/format/skeleton/bvh.h"

namespace marey::format::skeleton {

/// How the arms are at rest.
enum class ArmsAtRest {
  sideways,  ///< a T
  lowered,   ///< an A: 45° below a T
  metarig,   ///< as Blender's human metarig has them, 28 to 33° below a T, elbows back
};

/// One program's convention.
struct RigScheme {
  std::string_view name;   ///< "mixamo"
  std::string_view title;  ///< "Mixamo"
  ArmsAtRest arms = ArmsAtRest::sideways;
  double unit_m = 0.01;  ///< of BVH
  UpAxis up = UpAxis::y;
  std::string_view order = "ZYX";
  std::string_view root = {};  ///< of a bone on the floor, on which the hips hang; empty: none
};

/// Throws Error, with the known ones, for another name.
const RigScheme& rig_scheme(std::string_view name);

/// "mixamo, unreal, …".
std::string rig_scheme_names();

/// What the scheme calls a segment of Marey's or OpenSim's human skeleton, or one that it knows by another program's name; `label`
/// itself if it is not one of these.
std::string rig_bone_name(const RigScheme& scheme, const std::string& label);

/// How bones are written. What is empty is as the scheme has it, else as BvhDialect has it.
struct BoneOutput {
  std::string rig_names;  ///< the scheme; empty: bones as the skeleton has them
  std::optional<double> bvh_unit_m = {};
  std::optional<UpAxis> bvh_up = {};
  std::string bvh_order = {};
};

/// Whether a file of this name holds bones alone: .bvh and .glb.
bool is_bone_file(const std::string& path);

/// The sink of such a file. Throws Error for an unknown scheme or order.
std::unique_ptr<Sink> create_bones(const std::string& path, const BoneOutput& output);

/// Gives `inner` the same motion by the scheme's bones: named as there, facing −y, with the scheme's pose where nothing is turned.
/// Joints are where they were. Bodies without a skeleton, and bones that it does not know, keep their names. `begin` throws
/// Error if a skeleton has no legs by which up and left are known.
std::unique_ptr<Sink> with_rig_scheme(std::unique_ptr<Sink> inner, const RigScheme& scheme);

}  // namespace marey::format::skeleton
