// What every format of files says of itself: a row of the register (format/register.h). A format is one file, which ends with its
// row.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "marey/core/recording_reader.h"
#include "marey/core/rig.h"
#include "marey/core/sink.h"
#include "marey/format/auxiliary_data.h"
#include "marey/geometry/pitch.h"

namespace marey::format {

namespace match {
struct GroundMatch;
}

/// What a file holds. The first three are recordings, by their frame of reference.
enum class Content : std::uint8_t {
  image = 1,          ///< tracks in an image
  ground = 2,         ///< people on the ground
  space = 4,          ///< points in space
  rig = 8,            ///< a calibration
  observations = 16,  ///< what cameras saw of markers
  detections = 32,    ///< another program's boxes, which are not tracks yet
  labels = 64,        ///< names of markers
};

/// A set of them.
class Contents {
 public:
  constexpr Contents(Content one) : bits_(static_cast<unsigned>(one)) {}  // NOLINT: one is a set too
  constexpr bool has(Content one) const { return (bits_ & static_cast<unsigned>(one)) != 0; }
  constexpr bool any_of(Contents others) const { return (bits_ & others.bits_) != 0; }
  friend constexpr Contents operator|(Contents a, Contents b) {
    a.bits_ |= b.bits_;
    return a;
  }

 private:
  unsigned bits_;
};
constexpr Contents operator|(Content a, Content b) {
  return Contents(a) | Contents(b);
}
constexpr Contents kRecordings = Content::image | Content::ground | Content::space;

Content content_of(const FrameOfReference& frame);

/// Which axis a file's world has up. Inside Marey it is always z; (x, y, z) with y up becomes (x, −z, y).
enum class UpAxis { y, z };

/// What a reader must be reported where the file does not specify it.
struct ReadOptions {
  std::string metadata;       ///< the file that belongs to a match, or an AMC file's .asf; empty: beside it, under a like name
  geometry::PitchSize pitch;  ///< of a match
  double rate_hz = 25;
  bool as_recorded = false;  ///< of a take: without its edits, which are then reported beside it
  // Of a skeleton's motion, whose joints are the points: its z is up when it is read.
  double skeleton_unit_m = 0.01;   ///< of a BVH file: how many metres its unit has
  UpAxis skeleton_up = UpAxis::y;  ///< the axis that is up in a BVH or ASF file
  double amc_rate_hz = 120;        ///< of an AMC file, which does not specify
  std::optional<UpAxis> up = {};   ///< of points in space, the axis that is up in the file; nothing: as the file says, else z
};

/// The beginning of a file, by which its format is known.
struct Beginning {
  std::string path;
  bool folder = false;  ///< then there are no bytes
  std::string bytes;    ///< the first 64 KiB

  bool is_text() const { return bytes.find('\0') == std::string::npos; }
  std::string_view text() const;        ///< without a byte order mark
  std::string_view first_line() const;  ///< without its ending
  bool has(std::string_view part) const { return bytes.find(part) != std::string::npos; }
};

/// Without bytes of what is neither file nor folder. Throws Error if there is no such file or folder, or it may not be read.
Beginning beginning_of(const std::string& path);

/// The properties of a recording in a file before its first instant.
struct FileInfo {
  RecordingHeader header;
  std::vector<TrackName> tracks;            ///< by id; those that an instant may name
  std::vector<Edit> edits;                  ///< a take's
  std::optional<std::int64_t> head;         ///< of the edits
  std::optional<std::int64_t> frame_count;  ///< from the first frame to the last; nothing if only reading would reveal it
  std::optional<UpAxis> up;                 ///< what the file itself says of its world, where it says anything
  AuxiliaryData auxiliary = {};             ///< of a C3D file
};

/// A file that is read instant by instant. Units and axes are Marey's.
class FileReader : public RecordingReader {
 public:
  virtual const FileInfo& info() const = 0;
  /// What it holds, counted: reads all of it, unless the file brings the figures.
  virtual RecordingSummary summary() { return summary_of(*this); }

  const RecordingHeader& header() const override { return info().header; }
  std::vector<TrackName> tracks() const override { return info().tracks; }
  std::vector<Edit> edits() const override { return info().edits; }
  std::optional<std::int64_t> head() const override { return info().head; }
  std::optional<std::int64_t> instant_count() const override { return info().frame_count; }
};

/// What a writer must know beforehand, because its format says it before the first frame.
struct WritePlan {
  FileInfo info;
  std::int64_t first_frame = 0, last_frame = -1;  ///< indices; last < first if it has no frames
  double farthest_m = 0;                          ///< the largest coordinate by amount
  bool reports_measured = false;                  ///< some point is filled or predicted, or brings a residual or its cameras
  UpAxis up = UpAxis::z;                          ///< of the file's world; instants come turned
  std::optional<MotionFindings> found = {};       ///< for C3D; others hold no such thing
};

/// One thing that is said of a file that holds no recording and no rig: for people, and for programs.
struct Fact {
  std::string name;  ///< "frames"
  std::variant<std::int64_t, double, std::string, std::vector<std::string>> value;
  std::string words = {};  ///< for people, where the value alone would not do
};

/// A row of the register. Functions that are not there say what a format cannot do.
struct Format {
  std::string_view name;     ///< in options and messages: "c3d". Formats of other contents may have it too
  std::string_view title;    ///< "a C3D file"
  std::string_view endings;  ///< of names that are written in it, blanks between: ".yml .yaml"; empty: `--format` alone names it
  Contents holds;
  std::string_view detail;  ///< for the table in docs/formats.md: units, axes, what it keeps and what not

  /// Whether a file is one. Formats are asked in the register's order.
  bool (*is)(const Beginning& file) = nullptr;

  // Reading: one of these. All throw Error with the file, and the line where there is one.
  std::unique_ptr<FileReader> (*open)(const std::string& path, const ReadOptions& options) = nullptr;  ///< instant by instant
  match::GroundMatch (*read)(const std::string& path, const ReadOptions& options) = nullptr;           ///< whole
  Rig (*read_rig)(const std::string& path) = nullptr;
  std::vector<Fact> (*facts)(const std::string& path) = nullptr;  ///< of what is not a recording and no rig

  // Writing: one of these, or none. All throw Error if the format cannot hold it, or it cannot be written.
  std::unique_ptr<Sink> (*create)(const std::string& path, const WritePlan& plan) = nullptr;  ///< instant by instant
  /// Whole; says what a user should know of what the format could not hold.
  std::vector<std::string> (*write)(const match::GroundMatch& match, const std::string& path) = nullptr;
  void (*write_rig)(const Rig& rig, const std::string& path) = nullptr;

  /// It can be written while it is recorded, without a plan; the others begin with values that only the end gives.
  bool while_recording = false;
  /// It holds bodies' poses beside points.
  bool poses = false;
  /// It holds what stands beside points in a C3D file.
  bool auxiliary_data = false;
  /// Its places on the ground count from the corner of the pitch that is below on the left when it is seen from above with the home
  /// stand at the bottom, y upwards; those of others are as the user has them.
  bool from_corner = false;
  /// z is up in it always, or its reader turns it so.
  bool z_up = false;
  /// A skeleton's motion: y is up in it unless the user says otherwise.
  bool skeleton = false;
  /// Files come in pairs: the endings of a name and of the file that is beside it.
  std::vector<std::pair<std::string_view, std::string_view>> companions = {};

  bool is_read() const { return open != nullptr || read != nullptr || read_rig != nullptr || facts != nullptr; }
  bool is_written() const { return create != nullptr || write != nullptr || write_rig != nullptr; }
};

}  // namespace marey::format
