// Chunks of a recording in the bytes that are sent (wire.h), read again: for one track's course, and where an edit has changed
// tracks in them.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "marey/core/recording.h"

#include "wire.h"

namespace marey::viewer {

/// One track over time, in columns.
struct CourseColumns {
  std::vector<double> time;  ///< s
  std::array<std::vector<float>, 3> position;
  std::vector<std::uint8_t> state;
};

/// Adds the rows that one track has in a chunk.
void gather_rows(const std::string& segment, TrackId track, const WireColumns& columns, CourseColumns& course);

/// Whether the chunk has just these rows of these tracks. `first` is the place of its first instant in the recording, where the
/// tracks' `at` counts from 0.
bool has_tracks(const std::string& segment, const WireColumns& columns, std::int64_t first,
                const std::vector<TrackColumns>& tracks);
/// The chunk with these tracks in the place of their previous rows; all else is as it was, byte by byte. Rows come by
/// track.
std::string with_tracks(const std::string& segment, const WireColumns& columns, std::int64_t first,
                        const std::vector<TrackColumns>& tracks);
/// The chunk with these bodies' poses in the place of those it has of them; all else is as it was.
std::string with_poses(std::string segment, const WireColumns& columns, std::int64_t first, const std::vector<BodyColumns>& bodies);
/// Rows and poses.
std::int64_t row_count(const std::string& segment);

/// When an instant of a chunk was, s. `instant` counts from the chunk's first.
double time_in(const std::string& segment, std::size_t instant);

}  // namespace marey::viewer
