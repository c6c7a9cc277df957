#pragma once

#include <string>

namespace marey::cli {

/// `marey evaluate --distance`: evaluates places on the ground, or in space, and prints what came out, as JSON on request. Throws
/// Error.
void evaluate_positions(const std::string& truth, const std::string& tracks, double distance, bool json, bool quiet);

}  // namespace marey::cli
