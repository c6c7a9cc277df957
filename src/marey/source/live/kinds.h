// The register of live sources: what a rig or a command line may name, and how each kind is connected. A new kind is one row.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "marey/core/rig.h"
#include "marey/source/live/address.h"
#include "marey/source/live/connection.h"
#include "marey/source/live/found_camera.h"

namespace marey::source::live {

/// What every source of a run is opened with.
struct Opening {
  std::shared_ptr<LiveTime> time;
  std::function<Timestamp()> begin;  ///< when videos and simulations begin: the same for all of them
  std::optional<double> rate_hz;     ///< what the rig says
};

struct Kind {
  std::vector<std::string_view> schemes;
  std::string_view form;  ///< how it is written, for the help: "v4l2:/dev/video0?size=640x480&rate=30"
  std::string_view meaning;
  /// How a camera of this name is connected; it need not be there yet. Throws Error for a name that cannot be meant.
  std::function<Connect(const Address&, const Opening&)> open;
  /// The cameras that one name stands for, each with a source of its own; empty if it always stands for one.
  std::function<Rig(const Address&)> cameras = {};
};

/// All kinds that need nothing from other rooms.
std::vector<Kind> camera_kinds();

/// All cameras that are plugged in or answer now, of the kinds that can be asked.
std::vector<FoundCamera> find_cameras();

/// The one of this scheme. Throws Error, with those that there are, where this build has none.
const Kind& kind_of(std::span<const Kind> kinds, const Address& address);

}  // namespace marey::source::live
