#include "marey/pipeline/live/live_node.h"

#include "marey/core/error.h"
#include "marey/format/rig/rig_file.h"
#include "marey/source/live/node.h"

namespace marey::pipeline::live {
namespace {

source::live::Connect open_node(const source::live::Address& address, const source::live::Opening& /*opening*/) {
  const source::live::NodeAddress location = source::live::node_address(address);
  if (location.camera.empty()) throw Error("{}: stands for all cameras of that node; add /CAMERA for one of them", address.text);
  return source::live::connect_node(location);
}

/// With what the node knows of them: their calibration too.
Rig cameras_of_node(const source::live::Address& address) {
  const source::live::NodeAddress location = source::live::node_address(address);
  Rig rig;
  if (location.camera.empty()) {
    rig = format::rig::parse_rig(source::live::query_rig_of_node(location), location.node());
    for (RigCamera& camera : rig.cameras) {
      camera.source = location.node() + "/" + camera.name;
      camera.exposure_ms = camera.gain = camera.threshold = std::nullopt;  // it is set there
    }
  } else {
    rig.cameras.emplace_back().source = address.text;
  }
  return rig;
}

}  // namespace

source::live::Kind node_kind() {
  return {.schemes = {"node"},
          .form = "node:HOST:7780/CAMERA",
          .meaning = "a camera of another computer, where marey node runs; all of them without /CAMERA",
          .open = open_node,
          .cameras = cameras_of_node};
}

}  // namespace marey::pipeline::live
