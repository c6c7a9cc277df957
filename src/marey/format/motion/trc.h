#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "marey/format/format.h"

namespace marey::format::motion {

/// Reads a TRC file, as OpenSim, Cortex and others write it: with tabs or commas, its unit as it says (mm where it does not). Blank
/// cells are missing points. Throws Error, `path:line: what`, for what is not a TRC and for what is cut off.
std::unique_ptr<FileReader> open_trc(const std::string& path);
/// The same of text in memory, which must outlive the reader.
std::unique_ptr<FileReader> read_trc(std::string_view text, const std::string& name);

/// Writes a TRC file as OpenSim reads it: tabs, mm, frames from 1. A track without label is called by its id.
std::unique_ptr<Sink> create_trc(const std::string& path, const WritePlan& plan);

}  // namespace marey::format::motion
