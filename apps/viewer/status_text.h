#pragma once

#include <string>

#include "live_viewer.h"

namespace marey::viewer {

/// The message "status JSON" by which the page shows cameras and losses (page/src/state.ts).
std::string status_text(const LiveReport& report);

}  // namespace marey::viewer
