// Cameras of another computer, by the name of its node.
#pragma once

#include "marey/source/live/kinds.h"

namespace marey::pipeline::live {

/// The row of the register.
source::live::Kind node_kind();

}  // namespace marey::pipeline::live
