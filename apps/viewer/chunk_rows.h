// Stretches of a recording in the bytes that are sent (wire.h), read again: for one track's course, and where an edit has changed
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

/// Adds the rows that one track has in a stretch.
void gather_rows(const std::string& segment, TrackId track, const WireColumns& columns, CourseColumns& course);

/// Whether the stretch has just these rows of these tracks. `first` is the place of its first instant in the recording, where the
/// tracks' `at` counts from 0.
bool has_tracks(const std::string& segment, const WireColumns& columns, std::int64_t first,
                const std::vector<TrackColumns>& tracks);
/// The stretch with these tracks in the place of what was there of them; all else is as it was, byte by byte. Rows come by
/// track.
std::string with_tracks(const std::string& segment, const WireColumns& columns, std::int64_t first,
                        const std::vector<TrackColumns>& tracks);
/// Rows and poses.
std::int64_t row_count(const std::string& segment);

/// When an instant of a stretch was, s. `instant` counts from the stretch's first.
double time_in(const std::string& segment, std::size_t instant);

}  // namespace marey::viewer
