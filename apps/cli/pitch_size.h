#pragma once

#include "marey/pipeline/jobs/ground_size.h"

namespace marey::cli {

using pipeline::jobs::parse_pitch_size;

}  // namespace marey::cli
