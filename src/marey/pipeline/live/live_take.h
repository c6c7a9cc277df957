// A take played as live cameras: what each of them found, when it found it.
#pragma once

#include "marey/source/live/kinds.h"

namespace marey::pipeline::live {

/// `videos` plays videos; beside them the kind that is returned plays takes, NAME.marey, each camera that saw something one source.
source::live::Kind with_takes(source::live::Kind videos);

}  // namespace marey::pipeline::live
