// How a position of a track came about.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

namespace marey {

/// One meaning in every job and format, live and offline.
enum class Provenance : std::uint8_t {
  measured,   ///< from what cameras observed at this instant
  filled,     ///< interpolated in a gap, between observations before and after it
  predicted,  ///< extrapolated by a motion model from earlier observations
  solved,     ///< from a rigid body or a skeleton that was fitted to observations
};

/// As text files and streams have them, in the order of the enumeration.
inline constexpr std::array<std::string_view, 4> kProvenanceNames{"measured", "filled", "predicted", "solved"};

constexpr std::string_view to_string(Provenance provenance) {
  return kProvenanceNames[static_cast<std::size_t>(provenance)];
}

/// The reverse; std::nullopt for any other text. `observed` is read as `measured`: older track files have it.
std::optional<Provenance> provenance_of(std::string_view name);

}  // namespace marey
