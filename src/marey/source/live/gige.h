// Machine-vision cameras on Ethernet (GigE Vision) and USB (USB3 Vision), by Aravis. An optional part of the build.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "marey/source/live/found_camera.h"
#include "marey/source/live/kinds.h"

namespace marey::source::live {

/// The row of the register; nothing if this build has no Aravis.
std::optional<Kind> gige_kind();

/// Those that answer now; none where this build has no Aravis.
std::vector<FoundCamera> find_gige();

}  // namespace marey::source::live
