#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "marey/core/geometry.h"
#include "marey/core/ids.h"
#include "marey/core/instant.h"
#include "marey/core/rig.h"
#include "marey/core/time.h"

namespace marey {

/// What one camera saw at one instant: a blob's centre.
struct TakeObservation {
  CameraId camera{};
  Vector<2> pixel = Vector<2>::Zero();  ///< px
  double sigma = 0;                     ///< standard deviation of each coordinate, px; 0 where unknown
  double area = 0;                      ///< px²; 0 where unknown
  std::optional<TrackId> track;         ///< whose it was found to be; nothing for a ghost, or before reconstruction

  bool operator==(const TakeObservation&) const = default;
};

/// One marker at one instant. A marker that is missing has no point.
struct TakePoint {
  TrackId track{};
  Vector<3> position = Vector<3>::Zero();  ///< m, world
  std::optional<Matrix<3>> covariance;     ///< of `position`, m²
  Provenance provenance = Provenance::measured;
  CameraMask cameras = 0;             ///< whose rays it is made of; none where they are unknown
  std::optional<double> residual_px;  ///< RMS distance between the point's projections and what was seen
  std::optional<double> residual_m;   ///< the same in space, as other systems' files have it

  bool operator==(const TakePoint&) const = default;
};

/// One instant of a take.
struct TakeFrame {
  std::int64_t index = 0;  ///< counts from 0 at the beginning of the recording; a cut of one may begin later
  Timestamp time{};        ///< by the rig's clock
  std::vector<TakeObservation> observations;
  std::vector<TakePoint> points;  ///< a track at most once

  bool operator==(const TakeFrame&) const = default;
};

/// A marker that was followed. Its label is empty where none was given.
struct TakeTrack {
  TrackId id{};
  std::string label;

  bool operator==(const TakeTrack&) const = default;
};

/// What was changed by hand or by a program after the recording.
struct TakeEdit {
  std::string time;  ///< ISO 8601, UTC; empty where unknown
  std::string what;  ///< one sentence

  bool operator==(const TakeEdit&) const = default;
};

/// What is known of a take before its first frame.
struct TakeHeader {
  std::string name;         ///< free text; by default the file's
  std::string made_by;      ///< program and version, or the system that a file came from
  std::string recorded_at;  ///< ISO 8601, UTC; empty where unknown
  double rate_hz = 0;       ///< frames per second, positive
  std::optional<Rig> rig;   ///< the cameras with their sources; nothing where a file brings points alone
};

/// A whole recording in memory. The world is right-handed, z up, in m. What may be long is better streamed: format/take_file.h.
struct Take {
  TakeHeader header;
  std::vector<TakeTrack> tracks;  ///< by id
  std::vector<TakeFrame> frames;  ///< by index, each at most once
  std::vector<TakeEdit> edits;    ///< in the order they were made
};

/// What a take holds, counted. A take file brings it, so that its frames need not be read for it.
struct TakeSummary {
  /// One marker over the whole take.
  struct TrackCount {
    TakeTrack track;
    std::int64_t first_frame = 0, last_frame = 0;  ///< where it has its first and last point
    std::int64_t measured = 0, filled = 0, predicted = 0;
  };

  std::int64_t frames = 0, observations = 0, points = 0;
  std::optional<std::int64_t> first_frame, last_frame;  ///< indices; nothing where there is no frame
  std::optional<Timestamp> first_time, last_time;
  std::vector<TrackCount> tracks;  ///< by id
  bool complete = false;           ///< false while it is being written, and where writing was cut off
};

}  // namespace marey
