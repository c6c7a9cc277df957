#pragma once

#include <string>
#include <vector>

#include "marey/format/match/ground_match.h"

namespace marey::format::match {

/// Writes PATH's two files (epts_writer.cpp); the reader stands beside, with the format's row.
std::vector<std::string> write_epts(const GroundMatch& match, const std::string& path);

}  // namespace marey::format::match
