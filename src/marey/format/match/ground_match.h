#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "marey/core/recording.h"
#include "marey/format/format.h"
#include "marey/geometry/pitch.h"

namespace marey::format::match {

/// A half, or a half of extra time.
struct GroundPeriod {
  int number = 1;
  std::int32_t first_frame = 0, last_frame = 0;
};

/// Of people on the ground as a file's user has it, 25 frames a second until that is known.
RecordingHeader ground_header(const std::string& name);

/// A recording, with what match formats contain beyond it. Its time is its frame over the rate, if the file contains no other.
struct GroundMatch {
  Recording recording{ground_header({})};  ///< an instant a frame
  std::vector<TrackId> order;         ///< in which the file names its people, and line-ups list them; people not in it follow by id
  geometry::PitchSize pitch;          ///< as the file says, or as was given to the reader
  std::vector<GroundPeriod> periods;  ///< in order; empty if the file does not know any
  std::string home, away;             ///< names of the teams; empty if the file does not know them
  std::vector<std::string> warnings;  ///< one sentence each
};

/// Turns coordinates between the corner below on the left with y upwards (`Format::from_corner`) and another frame, either way:
/// `y_down` has y grow downwards from the upper side; `centred` counts from the middle of the pitch.
struct GroundFrame {
  bool y_down = false;
  bool centred = false;
};
Recording from_corner(Recording recording, const geometry::PitchSize& pitch, const GroundFrame& frame);
Recording to_corner(Recording recording, const geometry::PitchSize& pitch, const GroundFrame& frame);

/// A format whose places and metadata stand in two files.
struct TwoFiles {
  GroundMatch (*parse)(std::string_view text, const std::string& name, std::string_view metadata, const std::string& metadata_name);
  bool (*is)(const Beginning& file);           ///< either of the two
  bool (*is_metadata)(std::string_view text);  ///< by its beginning
  std::vector<std::string> endings;            ///< of the file with the places
  bool needs_metadata = true;
};

/// Reads such a pair, of which either may be named: the other one is found beside it under a like name, or by the options. Throws
/// Error where it is not there and is needed.
GroundMatch read_two_files(const std::string& path, const TwoFiles& format, const ReadOptions& options);

/// Whether each field of a line of text is a number.
bool all_numbers(const std::vector<std::string_view>& fields);

// Of text in memory; the texts' `name`s are what messages call them.
GroundMatch parse_mot_world(std::string_view text, const std::string& name, double rate_hz);
GroundMatch parse_metrica(std::string_view home, const std::string& home_name, std::string_view away, const std::string& away_name,
                          const geometry::PitchSize& pitch);
GroundMatch parse_tracab(std::string_view text, const std::string& name, std::string_view metadata,
                         const std::string& metadata_name);
GroundMatch parse_epts(std::string_view text, const std::string& name, std::string_view metadata, const std::string& metadata_name);
GroundMatch parse_soccernet(std::string_view text, const std::string& name, const ReadOptions& options);
GroundMatch parse_sportec(std::string_view text, const std::string& name, std::string_view metadata,
                          const std::string& metadata_name);
GroundMatch parse_statsperform(std::string_view text, const std::string& name, const geometry::PitchSize& pitch);

}  // namespace marey::format::match
