// A measured walk as the page that a lab prints.
#pragma once

#include <string>

#include "marey/pipeline/bodies/measure_gait.h"

namespace marey::pipeline::bodies {

/// HTML; names of files appear without their folders.
void write_gait_report(const std::string& path, const std::string& recording, const GaitMeasure& measure);

}  // namespace marey::pipeline::bodies
