#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "marey/format/format.h"

namespace marey::format::motion {

// Tables that hold points over time. All throw Error, `path:line: what`, for what is not one of them.

/// Tidy: one row a point, with a header. `frame` (from 0), `x`, `y`, `z` (m) and one of `id` and `label` must be there; `time` (s),
/// `state` (measured, filled or predicted), `cameras`, `residual_px` and `residual_mm` may be; other columns are skipped. Rows
/// in any order.
std::unique_ptr<FileReader> open_tidy_csv(const std::string& path);
std::unique_ptr<FileReader> read_tidy_csv(std::string_view text, const std::string& name);
/// `frame,time,id,label,x,y,z,state,cameras,residual_px,residual_mm`: one row a point.
std::unique_ptr<Sink> create_tidy_csv(const std::string& path);

/// As OptiTrack's Motive exports: markers' positions are read, rotations and errors skipped.
std::unique_ptr<FileReader> open_motive_csv(const std::string& path);
std::unique_ptr<FileReader> read_motive_csv(std::string_view text, const std::string& name);
/// The same layout, in m as Motive's default is.
std::unique_ptr<Sink> create_motive_csv(const std::string& path, const WritePlan& plan);

/// As Vicon's Nexus exports: the part that begins with "Trajectories".
std::unique_ptr<FileReader> open_nexus_csv(const std::string& path);
std::unique_ptr<FileReader> read_nexus_csv(std::string_view text, const std::string& name);

/// As Qualisys Track Manager exports: 3D (markers) and 6DOF (rigid bodies), with the columns of frame and time or without.
std::unique_ptr<FileReader> open_qualisys_tsv(const std::string& path);
std::unique_ptr<FileReader> read_qualisys_tsv(std::string_view text, const std::string& name);
/// The same as its MAT export has it.
std::unique_ptr<FileReader> open_qualisys_mat(const std::string& path);
std::unique_ptr<FileReader> read_qualisys_mat(std::string_view bytes, const std::string& name);

}  // namespace marey::format::motion
