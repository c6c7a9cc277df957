// Outlines of a track within a chunk as bytes: for each row a uint32 with the length of what follows, 0 where it has none; then
// state, order, number of control points, flags (1: with a silhouette, 2: with deviations), a byte each but the number, a uint16,
// and 3 of 0; then float32: control points, their deviations, centre, velocity, scale rate, the three's deviations, silhouette.
#pragma once

#include <cstddef>
#include <span>

#include "marey/core/recording.h"
#include "marey/format/take/column_codec.h"

namespace marey::format::take {

/// `blob` stays empty if no row has one.
void encode_outlines(const TrackColumns& track, Bytes& blob);

/// Puts them into `track`, whose rows begin at `first`. Throws as `decoder` does.
void decode_outlines(std::span<const std::byte> blob, const ColumnDecoder& decoder, std::size_t first, TrackColumns& track);

}  // namespace marey::format::take
