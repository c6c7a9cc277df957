#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "marey/core/recording.h"
#include "marey/geometry/pitch.h"

namespace marey::format::match {

/// Files of people on the ground that Marey reads and writes. See docs/formats.md for what each can hold.
enum class GroundFormat {
  csv,           ///< ours, one row a person and instant (ground_file.h)
  mot,           ///< MOTChallenge text with world coordinates
  metrica,       ///< Metrica's pair of CSV files
  tracab,        ///< .dat with its metadata XML
  epts,          ///< FIFA EPTS: metadata XML with its text
  soccernet,     ///< SoccerNet's game state, JSON
  sportec,       ///< DFL's positional XML; read only
  statsperform,  ///< MA25 text; read only
};

/// A half, or a half of extra time.
struct GroundPeriod {
  int number = 1;
  std::int32_t first_frame = 0, last_frame = 0;
};

/// Of people on the ground as a file's user has it, 25 frames a second until that is known.
RecordingHeader ground_header(const std::string& name);

/// A recording, with what formats of matches tell beyond it.
///
/// In csv and mot coordinates are as they stand. In all others they are metres from the corner of the pitch that is below on the
/// left when it is seen from above with the home stand at the bottom: x to the right, y upwards. A recording's time is its frame
/// over the rate.
struct GroundMatch {
  Recording recording{ground_header({})};  ///< an instant a frame
  std::vector<TrackId> order;         ///< in which the file names its people, and line-ups list them; who is in it not, by id behind
  geometry::PitchSize pitch;          ///< as the file says, or as was given to the reader
  std::vector<GroundPeriod> periods;  ///< in order; empty where the file does not know any
  std::string home, away;             ///< names of the teams; empty where the file does not know them
  std::vector<std::string> warnings;  ///< one sentence each
};

struct GroundReadOptions {
  std::string metadata;       ///< the file that belongs to it; empty: beside it, under a like name
  geometry::PitchSize pitch;  ///< where the file does not tell
  double rate_hz = 25;        ///< where the file does not tell
};

/// `ground, mot, metrica, …`: ours is "ground", for "csv" are points.
std::string ground_format_names();
std::string_view ground_format_name(GroundFormat format);
/// Throws Error for a name that is none of them.
GroundFormat parse_ground_format(std::string_view name);
/// By the first bytes; nothing where it is none of them, or cannot be read.
std::optional<GroundFormat> ground_format_of_content(const std::string& path);
/// By the ending of a name that is to be written: _home.csv, .dat, .xml, .json; nothing for others.
std::optional<GroundFormat> ground_format_of_name(std::string_view path);

/// Reads a recording of any of these. Of two files that belong together either may be named. The ball is left out. Throws Error
/// with the file, and the line where there is one.
GroundMatch read_ground_any(const std::string& path, const GroundReadOptions& options = {});
/// The same of a format that is known.
GroundMatch read_ground_as(const std::string& path, GroundFormat format, const GroundReadOptions& options = {});

/// Writes one, whole or not at all, with its second file beside it where the format has two. Returns what a user should know of
/// what the format could not hold, one sentence each. Throws Error where it cannot hold the recording at all: none holds one that is
/// not of the ground in m.
std::vector<std::string> write_ground_as(const GroundMatch& match, const std::string& path, GroundFormat format);

/// Turns coordinates between the corner below on the left with y upwards and another frame, either way: `y_down` has y grow
/// downwards from the upper side; `centred` counts from the middle of the pitch.
struct GroundFrame {
  bool y_down = false;
  bool centred = false;
};
Recording from_corner(Recording recording, const geometry::PitchSize& pitch, const GroundFrame& frame);
Recording to_corner(Recording recording, const geometry::PitchSize& pitch, const GroundFrame& frame);

// One file each. The texts' `name`s are what messages call them.
GroundMatch parse_mot_world(std::string_view text, const std::string& name, double rate_hz);
GroundMatch parse_metrica(std::string_view home, const std::string& home_name, std::string_view away, const std::string& away_name,
                          const geometry::PitchSize& pitch);
GroundMatch parse_tracab(std::string_view text, const std::string& name, std::string_view metadata,
                         const std::string& metadata_name);
GroundMatch parse_epts(std::string_view text, const std::string& name, std::string_view metadata, const std::string& metadata_name);
GroundMatch parse_soccernet(std::string_view text, const std::string& name, const GroundReadOptions& options);
GroundMatch parse_sportec(std::string_view text, const std::string& name, std::string_view metadata,
                          const std::string& metadata_name);
GroundMatch parse_statsperform(std::string_view text, const std::string& name, const geometry::PitchSize& pitch);

void write_mot_world(const GroundMatch& match, const std::string& path);
std::vector<std::string> write_metrica(const GroundMatch& match, const std::string& path);
std::vector<std::string> write_tracab(const GroundMatch& match, const std::string& path);
std::vector<std::string> write_epts(const GroundMatch& match, const std::string& path);
std::vector<std::string> write_soccernet(const GroundMatch& match, const std::string& path);

}  // namespace marey::format::match
