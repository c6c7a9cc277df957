// What a page of the viewer writes to change something.
#include <cmath>

#include "fuzz.h"
#include "viewer/page_command.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace marey::viewer;
  const std::string_view line = marey::fuzz::text_of(data, size);
  const auto command = page_command(line);
  if (!command) return 0;
  if (const auto* camera_control = std::get_if<SetCameraControl>(&*command)) {
    marey::fuzz::check(std::isfinite(camera_control->value) && camera_control->value >= 0 &&
                       number(camera_control->camera) < kMaxCameras);
  } else if (const auto* masks = std::get_if<ChangeMasks>(&*command)) {
    const cv::Rect box = masks->part ? masks->part->box() : cv::Rect();
    marey::fuzz::check(box.x >= 0 && box.y >= 0 && box.width >= 0 && box.height >= 0);
  } else if (const auto* name = std::get_if<NameTrack>(&*command)) {
    marey::fuzz::check(name->label.size() <= kMaxName && name->label.find('\n') == std::string::npos);
  }
  return 0;
}
