// How cameras are, as programs print it and send it to the page.
#pragma once

#include <cstdint>
#include <string>

#include "marey/core/camera_health.h"

#include "json_value.h"

namespace marey::cli {

/// Of a summary: the state, `count` under the name `counted`, and the losses.
Json health_json_of(const CameraHealth& health, const char* counted, std::int64_t count);
/// Of the viewer's page (page/src/state.ts).
Json page_json_of(const CameraHealth& health);
/// "cam1    1200 frames, 0 lost, 3 damaged, 0 overrun", the name and `count` in columns; `counted` is "frames" or "frames sent".
std::string health_line_of(const CameraHealth& health, std::int64_t count, const char* counted);
/// Of a status line: its name with `now` while it gives frames, else with its state.
std::string short_line_of(const CameraHealth& health, const std::string& now);

}  // namespace marey::cli
