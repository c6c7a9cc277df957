#pragma once

#include <optional>
#include <string>

#include "marey/pipeline/people/people_in_picture.h"

#include "command_line.h"

namespace marey::cli {

/// What `marey track --targets people` and `keypoints` understand beyond what every target needs.
struct PeopleFlags {
  bool keypoints = false;  ///< --targets keypoints
  std::string model = pipeline::keypoints::KeypointOptions{}.model;
  std::string background = std::string(detect::background::AdaptiveOptions::name);
  std::string detector;
  bool without_background = false;
  bool steady = false;  ///< of films; marey track has it
  int every = 1;
  bool outline = false;
  std::optional<int> control_points;
  std::optional<int> order;
  std::optional<int> lines;
};

/// Throws WrongUsage if there is no network that --every and --without-background speak of, or frames are to be skipped without a
/// background model where detections of every frame are needed.
void check_every(const PeopleFlags& flags, bool on_ground);

/// The detector that they choose, wherever people are searched for in pictures.
detect::DetectorOptions detector_options(const PeopleFlags& flags);

void add_people_options(Command& command, PeopleFlags& flags);
void add_keypoint_options(Command& command, PeopleFlags& flags);

/// Throws Error where a flag's value is out of its domain.
pipeline::people::PeopleInPictureOptions people_options(const PeopleFlags& flags, const std::string& filter, bool live);

}  // namespace marey::cli
