#pragma once

#include <string>
#include <string_view>

#include "marey/core/rig.h"

namespace marey::format::rig {

/// Reads a rig file (docs/rig.md). Sources and detections with a relative path lie beside the rig file: they come out as a path
/// from where the program runs. A world whose y is up is turned so that its z is, (x, y, z) becoming (x, −z, y).
/// Throws Error with every problem of the file, one line each, `path:LINE: what; what to do`.
Rig read_rig(const std::string& path);

/// The same from text. `name` is what messages call the file; `folder` is where relative sources lie ("" leaves them as they are).
Rig parse_rig(std::string_view text, const std::string& name, const std::string& folder = {});

/// The text of a rig file, numbers to 12 digits. Sources are written from `folder` where they have a relative path or lie in
/// it ("" leaves them as they are).
std::string rig_text(const Rig& rig, const std::string& folder = {});

/// Writes a rig file, atomically. Throws Error if that cannot be.
void write_rig(const Rig& rig, const std::string& path);

}  // namespace marey::format::rig
