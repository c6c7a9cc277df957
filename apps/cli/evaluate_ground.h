#pragma once

#include <string>

namespace marey::cli {

/// `marey evaluate --distance`: judges places on the ground and prints what came out, as JSON on request. Throws Error.
void evaluate_ground_files(const std::string& truth, const std::string& tracks, double distance, bool json, bool quiet);

}  // namespace marey::cli
