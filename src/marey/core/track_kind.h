// What a track is a track of.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

namespace marey {

/// A recording's tracks have its header's kind, unless they are given one of their own. Labels are free text: they do not imply a
/// kind.
enum class TrackKind : std::uint8_t {
  unspecified,  ///< the source does not specify it
  person,
  ball,  ///< among people on the ground: its positions have heights, theirs do not
  marker,
  keypoint,  ///< a point of a body
};

/// As files and clients have them, in the order of the enumeration.
inline constexpr std::array<std::string_view, 5> kTrackKindNames{"", "person", "ball", "marker", "keypoint"};

constexpr std::string_view to_string(TrackKind kind) {
  return kTrackKindNames[static_cast<std::size_t>(kind)];
}

/// The reverse; std::nullopt for any other text.
inline std::optional<TrackKind> track_kind_of(std::string_view name) {
  const auto found = std::find(kTrackKindNames.begin(), kTrackKindNames.end(), name);
  if (found == kTrackKindNames.end()) return std::nullopt;
  return static_cast<TrackKind>(found - kTrackKindNames.begin());
}

/// The label that Marey gives the ball, and by which files without kinds mark it.
inline constexpr std::string_view kBallLabel = "ball";

/// For positions on the ground from files without kinds: the ball is labelled `ball` and has no team.
inline TrackKind kind_by_label(std::string_view label, std::string_view team) {
  return label == kBallLabel && team.empty() ? TrackKind::ball : TrackKind::unspecified;
}

}  // namespace marey
