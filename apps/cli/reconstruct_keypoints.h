#pragma once

#include <string>

#include "marey/pipeline/keypoints/keypoints_in_space.h"

#include "json_value.h"

// What `marey reconstruct --targets keypoints` reports.
namespace marey::cli {

Json keypoints_json(const pipeline::keypoints::KeypointsSummary& summary, const std::string& out);
/// On standard error.
void print_keypoints_summary(const pipeline::keypoints::KeypointsSummary& summary, const std::string& out);

}  // namespace marey::cli
