#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "marey/core/recording_reader.h"
#include "marey/core/sink.h"

namespace marey::format::motion {

/// Files of 3D points over time that Marey reads and writes. See docs/formats.md for what each of them can hold.
enum class MotionFormat { take, c3d, trc, csv, motive, nexus };

/// Which axis a file's world has up. Inside Marey it is always z; (x, y, z) with y up becomes (x, −z, y).
enum class UpAxis { y, z };

/// What is known of a recording before its first instant.
struct MotionInfo {
  RecordingHeader header;
  std::vector<TrackName> tracks;            ///< by id; those that an instant may name
  std::vector<Edit> edits;                  ///< a take's
  std::optional<std::int64_t> head;         ///< of the edits
  std::optional<std::int64_t> frame_count;  ///< from the first frame to the last; nothing where only reading would tell
  std::optional<UpAxis> up;                 ///< what the file itself says of its world, where it says anything
};

/// A file of motion, read instant by instant. Units and axes are Marey's.
class MotionReader : public RecordingReader {
 public:
  virtual const MotionInfo& info() const = 0;

  const RecordingHeader& header() const override { return info().header; }
  std::vector<TrackName> tracks() const override { return info().tracks; }
  std::vector<Edit> edits() const override { return info().edits; }
  std::optional<std::int64_t> head() const override { return info().head; }
  std::optional<std::int64_t> instant_count() const override { return info().frame_count; }
};

/// What a writer must know beforehand, because its format says it before the first frame.
struct MotionPlan {
  MotionInfo info;
  std::int64_t first_frame = 0, last_frame = -1;  ///< indices; last < first where there are none
  double farthest_m = 0;                          ///< the largest coordinate by amount
  bool tells_measured = false;                    ///< some point is filled or predicted, or brings a residual or its cameras
};

/// A file of points in space, written instant by instant; it is there whole or not at all.
class MotionSink : public Sink {
 public:
  explicit MotionSink(std::string path) : path_(std::move(path)) {}
  std::string name() const override { return path_; }
  /// Throws Error where the recording is not of points in space.
  Wants begin(const RecordingHeader& header) final;

 protected:
  virtual void start(const RecordingHeader& header) = 0;
  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

/// Reads all of a recording to find what a writer must know. Throws Error, with `name` for the file, where millions of frames are
/// missing, which most formats would have to write out: a slip in a frame's number would fill the disk.
MotionPlan plan_of(const MotionInfo& info, RecordingReader& reader, const std::string& name);
MotionPlan plan_of(MotionReader& reader, const std::string& name);

/// `take, c3d, trc, csv, motive, nexus`.
std::string motion_format_names();
std::string_view motion_format_name(MotionFormat format);
/// Throws Error for a name that is none of them.
MotionFormat parse_motion_format(std::string_view name);
/// By its first bytes; nothing where it is none of them. Throws Error where the file cannot be read.
std::optional<MotionFormat> motion_format_of_content(const std::string& path);
/// By its ending, as in a name that is to be written.
std::optional<MotionFormat> motion_format_of_name(std::string_view path);

/// True where a file of this format can be written while it is recorded: takes and tidy CSV. The others begin with what is known
/// only at the end, and are written from a finished recording, whose plan `create_motion` is given.
bool written_while_recording(MotionFormat format);

/// `up` is the file's axis; a take has z up and is never turned. Throws Error for what cannot be read.
std::unique_ptr<MotionReader> open_motion(const std::string& path, MotionFormat format, UpAxis up = UpAxis::z);
/// Instants come within the plan. A take's edits are the plan's.
std::unique_ptr<Sink> create_motion(const std::string& path, MotionFormat format, const MotionPlan& plan, UpAxis up = UpAxis::z);
/// Writes a finished recording.
void write_motion(const std::string& path, MotionFormat format, const Recording& recording, UpAxis up = UpAxis::z);

}  // namespace marey::format::motion
