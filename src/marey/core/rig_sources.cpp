#include "marey/core/rig_sources.h"

#include <set>

#include "marey/core/error.h"

namespace marey {

void set_sources(Rig& rig, std::span<const std::string> pairs) {
  std::set<std::string> given;
  for (const std::string& pair : pairs) {
    const auto sign = pair.find('=');
    if (sign == std::string::npos || sign == 0 || sign + 1 == pair.size()) {
      throw Error("\"{}\" is not a source; write CAMERA=FILE with one of the rig's cameras: {}", pair, camera_names(rig));
    }
    RigCamera& camera = camera_named(rig, pair.substr(0, sign));
    if (!given.insert(camera.name).second) throw Error("camera \"{}\" is given two sources; keep one of them", camera.name);
    const std::string file = pair.substr(sign + 1);
    const bool text = file.ends_with(".txt") || file.ends_with(".csv");
    camera.source = text ? "" : file;
    camera.detections = text ? file : "";
  }
}

}  // namespace marey
