// Skeletons in files: BVH, ASF/AMC, OpenSim's models, Vicon's VSK, and our own skeleton.toml; and motions of them, as tables of
// angles.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "marey/core/segment_mass.h"
#include "marey/core/skeleton.h"
#include "marey/format/format.h"

namespace marey::format::skeleton {

/// What files do not specify themselves.
struct SkeletonOptions {
  double unit_m = 0.01;   ///< of a BVH file: how many metres its unit has
  UpAxis up = UpAxis::y;  ///< of a BVH, ASF or VSK file
  double rate_hz = 120;   ///< of an AMC file, which does not specify
};

/// A skeleton from a file, in metres and with z up.
struct SkeletonFile {
  Skeleton skeleton;
  std::optional<SkeletonMotion> motion;  ///< of BVH, where it has one
  double unit_m = 1;                     ///< what one unit of the file is: an AMC file's are its ASF's
  std::vector<SegmentMass> masses;       ///< one a segment; empty if the file has none. OpenSim's models have them
  std::vector<std::string> warnings;     ///< one sentence each: what was omitted, what is doubtful
  std::string unused = {};               ///< of an OpenSim model, what moves nothing here: "92 muscles, 4 wrapping surfaces"
};

/// Known by its content. Throws Error, with the file and the line where there is one.
SkeletonFile read_skeleton(const std::string& path, const SkeletonOptions& options = {});

SkeletonFile parse_bvh(std::string_view text, const std::string& name, const SkeletonOptions& options = {});
SkeletonFile parse_asf(std::string_view text, const std::string& name, const SkeletonOptions& options = {});
/// `asf` is what the frames move. Throws Error for bones that it has not, and for rows that do not fit it.
SkeletonMotion parse_amc(std::string_view text, const std::string& name, const SkeletonFile& asf,
                         const SkeletonOptions& options = {});
/// OpenSim's model, version 2 to 4: bodies, joints (Weld, Pin, Slider, Universal, Ball, Gimbal, Planar, Free, Custom), coordinates,
/// couplers and markers. What it has besides moves nothing or is named in a warning; joints of other kinds are refused.
SkeletonFile parse_osim(std::string_view text, const std::string& name);
/// Vicon's skeleton of a person, with its markers.
SkeletonFile parse_vsk(std::string_view text, const std::string& name, const SkeletonOptions& options = {});
SkeletonFile parse_toml(std::string_view text, const std::string& name);

/// As parse_toml reads it: every joint, coordinate, marker.
std::string to_toml(const Skeleton& skeleton);

/// Turns world's y to z, as all of Marey has it: (x, y, z) with y up becomes (x, −z, y).
Matrix<3> z_up_from(UpAxis up);

}  // namespace marey::format::skeleton
