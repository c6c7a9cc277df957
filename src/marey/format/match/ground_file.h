#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "marey/core/recording.h"
#include "marey/core/sink.h"
#include "marey/files/whole_file.h"
#include "marey/format/match/ground_match.h"

namespace marey::format::match {

/// People on the ground as CSV: frame,time,id,label,team,x,y,vx,vy,state,cameras. Frames count from 0; s, m, m/s; one row a person
/// and instant, by frame and id; state is measured, filled, predicted or solved (core/provenance.h; older files have `observed` for
/// measured); cameras are the names of those that saw the person, a space between. Where no velocity is known all are written as 0.
/// With a ball, whose label is "ball", two columns more, z,vz, have its height in m and how fast it rises; where it is known how
/// well places are, three more, xx,xy,yy, have their covariance in m². A writer must be reported of either within the first
/// megabyte. Where y grows downwards (core/ground_transform.h), a column y_down has 1 in each row.
///
/// Reading asks for id, x, y and frame or time only, found by the header in any order, so that other tools' files may be brought.
/// Without time it is frame / rate_hz; without frame they are numbered by the median time between instants. Velocities that are
/// missing are not known, nor are any where all are 0. The recording's rate is that of most of its steps; its rig, where cameras
/// are named, has their names alone. A file that has boxes too (left, top, width, height) is one of tracks in an image: its frame
/// of reference says that it is in px. Throws Error, with the line, where something is not as it should be.
Recording read_ground(const std::string& path, double rate_hz = 25);

/// The same from text; `name` is what messages call it.
Recording parse_ground(std::string_view text, const std::string& name, double rate_hz = 25);

/// The same, with the people in the order in which the file names them.
GroundMatch read_ground_match(const std::string& path, const ReadOptions& options);

/// Whether a file begins as such a CSV does, or as one of tracks in an image, which has boxes too.
bool is_ground_csv(const Beginning& file, bool with_boxes);

/// Whether it has the columns that GroundWriter writes, so that its y grows upwards where no y_down says otherwise.
bool is_own_ground_csv(const Beginning& file);

/// Writes such a file as it comes, so that memory does not grow with its length.
class GroundWriter : public Sink {
 public:
  /// Throws Error if nothing can be written there.
  explicit GroundWriter(const std::string& path) : path_(path), file_(path) {}

  std::string name() const override { return path_; }
  /// Throws Error for a recording that is not of the ground in m. Cameras are the rig's.
  SinkRequirements begin(const RecordingHeader& header) override;
  void write(const Instant& instant) override;
  void finish() override;

 private:
  struct Fields {
    std::string label, team;  // quoted where they must be
    bool ball = false;
  };

  /// Columns that not every file has, in the order in which they came to be known.
  enum class Extra { y_down, heights, covariances };

  static const char* empty_of(Extra extra);
  static const char* columns_of(Extra extra);
  void add_columns(Extra extra);
  void write_extra(Extra extra, const Sample& sample, bool ball);
  void flush();

  std::string path_;
  WholeFile file_;
  std::vector<Extra> extras_;
  bool head_written_ = false;
  std::vector<std::string> cameras_;
  std::map<TrackId, Fields> fields_;
  std::string text_, observed_by_;
};

/// Writes the file, atomically. Throws Error if that cannot be.
void write_ground(const Recording& recording, const std::string& path);

}  // namespace marey::format::match
