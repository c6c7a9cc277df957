// Body points of a track within a chunk as bytes: for each row a uint32 with the length of what follows, 0 where it has none; then
// the presence of the person, a float32; then for each point of the recording's set a byte, 1 where it is known, and float32: x, y,
// the covariance's upper triangle, visibility, presence, 0 where it is not.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

#include "marey/core/recording.h"
#include "marey/format/take/column_codec.h"

namespace marey::format::take {

/// `blob` stays empty if no row has any.
void encode_keypoints(const TrackColumns& track, Bytes& blob);

/// Puts them into `track`, whose rows begin at `first`. Throws as `decoder` does.
void decode_keypoints(std::span<const std::byte> blob, const ColumnDecoder& decoder, std::size_t first, TrackColumns& track);

/// A set of body points as JSON: {"name", "points": ["nose", …], "bones": [[0, 1], …], "mirrored": [0, …]}.
std::string keypoint_set_text(const KeypointSet& set);

/// Throws Error, "where: is damaged (…)", for what is not one.
KeypointSet keypoint_set_of(std::string_view text, const std::string& where);

}  // namespace marey::format::take
