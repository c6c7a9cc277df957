#pragma once

#include <string>
#include <vector>

namespace marey::cli {

/// `marey calibrate pitch --elements`: a camera for each image with labelled elements.
struct PitchElements {
  std::vector<std::string> files;
  std::string resolution = "960x540";
  std::string out, cameras;
  std::string size = "105x68";
  bool json = false, quiet = false;
};

/// WIDTHxHEIGHT in px. Throws WrongUsage for what is not one.
void check_resolution(const std::string& text);

void run_pitch_elements(const PitchElements& command);

}  // namespace marey::cli
