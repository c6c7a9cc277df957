// All jobs whose options are described, by name: for generated documentation and for front ends that list them.
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "marey/pipeline/jobs/option.h"

namespace marey::pipeline::jobs {

/// "track people", "track keypoints", "track markers", "track ground", ….
std::vector<std::string> job_names();

/// Calls `use` with the table of the job's default value; the table is valid during the call. Throws Error, with the names, if
/// there is no such job.
void with_table(std::string_view job, const std::function<void(Table&)>& use);

}  // namespace marey::pipeline::jobs
