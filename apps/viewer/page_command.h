// What pages may ask to be changed of a live run, out of the lines that they write. A line comes from an untrusted client: what is
// not exactly one of these is nothing.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <variant>

#include "marey/core/ids.h"
#include "marey/core/mask.h"

namespace marey::viewer {

inline constexpr int kMaxCameras = 64;
inline constexpr std::size_t kMaxName = 64;  // bytes

/// One of a camera's dials: "dial CAMERA NAME VALUE".
struct SetCameraControl {
  CameraId camera{};
  std::string name;  ///< "exposure", "gain"
  double value = 0;  ///< finite, from 0 to 1e6
};

/// "threshold CAMERA VALUE", or "auto".
struct SetThreshold {
  CameraId camera{};
  std::optional<double> level;  ///< grey level, which the camera may refuse; nothing: automatic
};

/// "mask CAMERA X Y WIDTH HEIGHT", or of a polygon "mask CAMERA X Y X Y X Y …", and "unmask …", px of the camera's image; "unmask
/// CAMERA all"; "lit CAMERA".
struct ChangeMasks {
  enum class What { add, remove, remove_all, learn_lit } what{};
  CameraId camera{};
  std::optional<Mask> part = {};  ///< to `add` and `remove`
};

/// "name TRACK LABEL", the label being the rest of the line; none takes the track's name away.
struct NameTrack {
  TrackId track{};
  std::string label;  ///< UTF-8 without control characters, `kMaxName` at most
};

/// "save": into the rig file.
struct SaveRig {};

using PageCommand = std::variant<SetCameraControl, SetThreshold, ChangeMasks, NameTrack, SaveRig>;

std::optional<PageCommand> page_command(std::string_view line);

}  // namespace marey::viewer
