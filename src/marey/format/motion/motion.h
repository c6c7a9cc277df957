#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "marey/core/take.h"

namespace marey::format::motion {

/// Files of 3D points over time that Marey reads and writes. See docs/formats.md for what each of them can hold.
enum class MotionFormat { take, c3d, trc, csv, motive, nexus };

/// Which axis a file's world has up. Inside Marey it is always z; (x, y, z) with y up becomes (x, −z, y).
enum class UpAxis { y, z };

/// What is known of a recording before its first frame.
struct MotionInfo {
  TakeHeader header;
  std::vector<TakeTrack> tracks;            ///< by id; those that a frame may name
  std::vector<TakeEdit> edits;              ///< a take's
  std::optional<std::int64_t> frame_count;  ///< from the first frame to the last; nothing where only reading would tell
  std::optional<UpAxis> up;                 ///< what the file itself says of its world, where it says anything
};

/// A recording, read frame by frame. Units and axes are Marey's.
class MotionReader {
 public:
  virtual ~MotionReader() = default;
  virtual const MotionInfo& info() const = 0;
  /// The next frame, by growing index; nothing at the end. Throws Error where the file is not what its beginning promised.
  virtual std::optional<TakeFrame> next() = 0;
  /// What is doubtful in the file, one sentence each.
  virtual std::vector<std::string> warnings() const { return {}; }
};

/// What a writer must know beforehand, because its format says it before the first frame.
struct MotionPlan {
  MotionInfo info;
  std::int64_t first_frame = 0, last_frame = -1;  ///< indices; last < first where there are none
  double farthest_m = 0;                          ///< the largest coordinate by amount
  bool tells_measured = false;                    ///< some point is filled or predicted, or brings a residual or its cameras
};

/// Writes a recording frame by frame; the file is there whole or not at all (a take: as it grows).
class MotionWriter {
 public:
  virtual ~MotionWriter() = default;
  /// Frames by growing index, within the plan. Throws Error where the place is full.
  virtual void write(const TakeFrame& frame) = 0;
  virtual void finish() = 0;
};

/// Reads all of a recording to find what a writer must know. Throws Error, with `name` for the file, where millions of frames are
/// missing, which most formats would have to write out: a slip in a frame's number would fill the disk.
MotionPlan plan_of(MotionReader& reader, const std::string& name);

/// Reads all of a recording to count what is in it.
TakeSummary summary_of(MotionReader& reader);

/// `take, c3d, trc, csv, motive, nexus`.
std::string motion_format_names();
std::string_view motion_format_name(MotionFormat format);
/// Throws Error for a name that is none of them.
MotionFormat parse_motion_format(std::string_view name);
/// By its first bytes; nothing where it is none of them. Throws Error where the file cannot be read.
std::optional<MotionFormat> motion_format_of_content(const std::string& path);
/// By its ending, as in a name that is to be written.
std::optional<MotionFormat> motion_format_of_name(std::string_view path);

/// `up` is the file's axis; a take has z up and is never turned. Throws Error for what cannot be read.
std::unique_ptr<MotionReader> open_motion(const std::string& path, MotionFormat format, UpAxis up = UpAxis::z);
std::unique_ptr<MotionWriter> create_motion(const std::string& path, MotionFormat format, const MotionPlan& plan,
                                            UpAxis up = UpAxis::z);

}  // namespace marey::format::motion
