#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "marey/core/recording.h"

#include "web_server.h"
#include "wire.h"

namespace marey::viewer {

/// Where things are, without the few that are far from all others.
struct Extent {
  Vector<3> low = Vector<3>::Zero(), high = Vector<3>::Zero();
};

/// The part of a recording that is known so far.
struct RecordingState {
  struct TimeChunk {
    double first_s = 0;
    std::int64_t instants = 0, rows = 0;
    int version = 0;  ///< grows whenever its bytes become others
  };
  struct Course {
    TrackName name;
    std::int64_t rows = 0, measured = 0;
    double first_s = 0, last_s = 0;
    std::int64_t first_instant = 0, last_instant = 0;  ///< counted from 0
    int version = 0;                                   ///< grows with `put`
  };

  std::vector<TimeChunk> segments;
  std::vector<Course> tracks;  ///< by id; those that have a row
  std::int64_t instants = 0;
  double last_s = 0;
  std::optional<Extent> extent;
  std::vector<std::string> warnings;
  bool complete = false;
};

/// A recording as the page takes it: in chunks of a second or so, each of them the bytes that are sent. Thirty minutes of fifty
/// markers at 100 Hz are 190 MB. One thread adds, others ask in the meantime.
class StoredRecording {
 public:
  StoredRecording(const RecordingHeader& header, const std::vector<TrackName>& tracks);

  void add(const Instant& instant);
  /// No more will come.
  void finish(std::vector<std::string> warnings);
  /// After `finish`, from one thread: these tracks in the place of their previous rows; one without rows is there no more. Their
  /// `at` counts the instants that were added.
  void put(const std::vector<TrackColumns>& tracks);
  /// Likewise these bodies' poses, of the instants at which the bodies were.
  void put_poses(const std::vector<BodyColumns>& bodies);

  RecordingState state() const;
  /// Null where there is no such chunk yet.
  Bytes segment(std::size_t number) const;
  /// One track's course, of kind 4: the header's first number is its rows n; then float64 time[n]; float32 x[n], y[n], and z[n]
  /// with flag 1; uint8 state[n] as in a chunk.
  std::string course(TrackId track) const;

 private:
  void close_segment();
  void replace_segment(std::size_t number, Bytes bytes);
  RecordingState::Course course_of(const TrackColumns& track, int version) const;
  void sample(const Vector<3>& position);
  std::optional<Extent> extent() const;

  WireColumns columns_;
  std::vector<Instant> open_;  // the chunk that is being filled
  std::int64_t open_rows_ = 0, added_ = 0;

  mutable std::mutex mutex_;  // for what follows
  RecordingState state_;
  std::map<TrackId, RecordingState::Course> courses_;
  std::vector<Bytes> segments_;
  std::vector<Vector<3>> sampled_;  // every `sampled_each_`th position
  std::int64_t sampled_each_ = 1, until_next_ = 0;
};

}  // namespace marey::viewer
