// Cameras of another computer, by the name of its node.
#pragma once

#include <optional>

#include "marey/source/live/kinds.h"

namespace marey::pipeline::live {

/// The row of the register; nothing where this build has no ZeroMQ.
std::optional<source::live::Kind> node_kind();

}  // namespace marey::pipeline::live
