#include "marey/pipeline/take/ground_orientation.h"

#include <algorithm>

#include <fmt/format.h>

#include "marey/core/error.h"
#include "marey/core/ground_transform.h"
#include "marey/format/match/ground_file.h"
#include "marey/format/register.h"
#include "marey/format/rig/rig_file.h"

namespace marey::pipeline::take {
namespace {

/// Whether the world of some camera is known, which is right-handed.
bool has_world(const Rig& rig) {
  return rig.ground_from_world || std::any_of(rig.cameras.begin(), rig.cameras.end(),
                                              [&](const RigCamera& camera) { return camera.ground_view(rig.ground).has_value(); });
}

bool format_states_it(const std::string& path) {
  if (path == "-") return false;
  const format::Format& format = format::format_to_read(path, format::Contents(format::Content::ground));
  return format.from_corner || format::match::is_own_ground_csv(format::beginning_of(path));
}

}  // namespace

bool rig_has_y_down(const std::string& path) {
  const Rig rig = format::rig::read_rig(path);
  if (!rig.ground_from_world) throw Error("{}: says nothing of the ground; `marey calibrate pitch` makes a rig that does", path);
  return is_reflection(*rig.ground_from_world);
}

std::optional<std::string> orientation_unknown(const std::string& path, const RecordingHeader& header) {
  if (header.frame.kind != FrameOfReference::Kind::user_ground || (header.rig && has_world(*header.rig)) || format_states_it(path))
    return std::nullopt;
  return fmt::format(
      "{}: does not specify whether y grows upwards or downwards; it is drawn upwards. If the pitch looks mirrored, give --y-down, "
      "or "
      "--rig with the rig that the recording was made with",
      path);
}

}  // namespace marey::pipeline::take
