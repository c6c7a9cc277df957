#include "marey/core/time_base.h"

#include <fmt/format.h>

#include "marey/core/error.h"

namespace marey {
namespace {

const RigCamera& camera_of(const TimeBase& base, const Rig& rig) {
  const auto index = static_cast<std::size_t>(number(base.camera));
  if (index >= rig.cameras.size())
    throw Error("times follow the clock of camera {}, and the rig has {} cameras", index + 1, rig.cameras.size());
  return rig.cameras[index];
}

}  // namespace

std::string to_string(const TimeBase& base, const Rig& rig) {
  switch (base.kind) {
    case TimeBase::Kind::unspecified:
      return "an unspecified clock";
    case TimeBase::Kind::rig:
      return "the rig's clock";
    case TimeBase::Kind::camera:
      return fmt::format("the clock of camera \"{}\"", camera_of(base, rig).name);
  }
  return {};
}

Duration rig_time_offset(const TimeBase& base, const Rig& rig) {
  if (base.kind == TimeBase::Kind::unspecified) throw Error("the recording does not specify whose clock its times follow");
  if (base.kind == TimeBase::Kind::rig) return Duration{};
  return duration_from_seconds(camera_of(base, rig).offset_s.value_or(0));
}

}  // namespace marey
