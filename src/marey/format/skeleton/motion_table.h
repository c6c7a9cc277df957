// .mot and .sto: OpenSim's tables, a row a time. Coordinates by name; angles in degrees where the head says inDegrees=yes.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "marey/core/skeleton.h"

namespace marey::format::skeleton {

/// A table as it stands.
struct MotionTable {
  std::string title;
  std::optional<bool> in_degrees;                        ///< nothing if the head does not specify
  std::vector<std::string> columns;                      ///< without "time"
  std::vector<double> times;                             ///< s
  std::vector<std::vector<std::optional<double>>> rows;  ///< as wide as `columns`; nothing for NaN and blanks
};

/// Throws Error, with the line.
MotionTable parse_motion_table(std::string_view text, const std::string& name);
MotionTable read_motion_table(const std::string& path);

/// The skeleton's coordinates out of a table; those that it does not have rest. `in_degrees` is what the table does not specify.
SkeletonMotion motion_of(const MotionTable& table, const Skeleton& skeleton, bool in_degrees);

/// A .mot or .sto file of a motion, angles in degrees; the file appears atomically.
void write_motion_table(const std::string& path, const Skeleton& skeleton, const SkeletonMotion& motion);
/// The same of any columns: `rows` as wide as `columns`, nothing is written as NaN.
void write_motion_table(const std::string& path, const MotionTable& table);

}  // namespace marey::format::skeleton
