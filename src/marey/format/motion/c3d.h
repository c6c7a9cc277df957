#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>

#include "marey/format/format.h"

namespace marey::format::motion {

/// What stands among a C3D file's points: places alone, or also angles, forces and whatever else is not a place, which then is as
/// wrong as if its numbers were lengths.
enum class C3dPoints { locations, all };

/// Reads the points of a C3D file: PC, DEC and SGI, integer and real, and the matrices of its ROTATION group as bodies' poses. What
/// stands beside them (`FileInfo::beside`) is reported, not read. A point's camera mask becomes CameraId 0 to 6, its residual
/// `residual_m`. A point whose fourth word is 0 is `filled`, unless no point of the file has another one: then the file does not
/// state, and all are `measured`. Points at exactly (0, 0, 0) that cannot be positions (c3d_zeros.h) are missing. `up` is the axis
/// that is up in the file, nothing: as it says; it is only noted for what stands beside. A file that is cut off is read as far as
/// it goes, with a warning. Throws Error for what is not a C3D file, and for one that ends before its first frame does.
std::unique_ptr<FileReader> open_c3d(const std::string& path, C3dPoints points = C3dPoints::locations,
                                     const std::optional<UpAxis>& up = {});
/// The same of bytes in memory, which must outlive the reader; `name` stands for the path in messages.
std::unique_ptr<FileReader> read_c3d(std::span<const std::byte> bytes, const std::string& name);

/// Writes points as a PC's floats, in mm, bodies' poses behind them, and what an analysis found (`WritePlan::found`): angles among
/// the points, in degrees, and events. Analog channels and the groups of parameters that belong to them come from the C3D file that
/// was read (`FileInfo::beside`), frame by frame, by index. A track without label is called by its id. The plan's `up` is only
/// said, nothing is turned. Throws Error if analog channels are of another rate.
std::unique_ptr<Sink> create_c3d(const std::string& path, const WritePlan& plan);

}  // namespace marey::format::motion
