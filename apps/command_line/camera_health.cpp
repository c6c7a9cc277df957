#include "camera_health.h"

#include <fmt/format.h>

namespace marey::cli {

Json health_json_of(const CameraHealth& health, const char* counted, std::int64_t count) {
  return {{"state", to_string(health.state)},
          {counted, count},
          {"lost", health.lost},
          {"damaged", health.damaged},
          {"overrun", health.overrun}};
}

Json page_json_of(const CameraHealth& health) {
  return {{"state", to_string(health.state)}, {"rate", health.rate_hz}, {"frames", health.frames}, {"dropped", health.dropped()}};
}

std::string health_line_of(const CameraHealth& health, std::int64_t count, const char* counted) {
  return fmt::format("{:<12} {:>7} {}, {} lost, {} damaged, {} overrun", health.name, count, counted, health.lost, health.damaged,
                     health.overrun);
}

std::string short_line_of(const CameraHealth& health, const std::string& now) {
  return fmt::format("{} {}", health.name, health.gives_frames() ? now : std::string(to_string(health.state)));
}

}  // namespace marey::cli
