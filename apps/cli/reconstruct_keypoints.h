#pragma once

#include <string>

#include "marey/pipeline/keypoints/keypoints_in_space.h"

#include "command_line.h"
#include "json_value.h"
#include "people_options.h"

// What `marey reconstruct --targets keypoints` takes and tells.
namespace marey::cli {

/// `people` is for cameras with videos.
void add_keypoint_options(Command& command, pipeline::keypoints::KeypointsInSpaceOptions& options, PeopleFlags& people);

Json keypoints_json(const pipeline::keypoints::KeypointsSummary& summary, const std::string& out);
/// On standard error.
void print_keypoints_summary(const pipeline::keypoints::KeypointsSummary& summary, const std::string& out);

}  // namespace marey::cli
