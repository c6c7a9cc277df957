// A chunk of a take, in memory: rows gathered until they are written, rows read at once, and what short chunks are joined in.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "marey/core/recording.h"

namespace marey::format::take {

/// What one camera saw, in columns, by instant of the chunk.
struct ObservedColumns {
  std::vector<std::int32_t> at;  ///< of the chunk's instants; several rows may have the same
  std::vector<double> x, y;      ///< px
  OptionalColumn sigma{1}, area{1};
  std::vector<std::uint64_t> track;  ///< 0: of no track

  std::size_t size() const { return at.size(); }
  /// All of one instant.
  void add(std::int32_t instant, std::span<const ImageObservation> points);
  ImageObservation point(CameraId camera, std::size_t row) const;
  /// `offset` is added to the instants.
  void append(const ObservedColumns& other, std::int32_t offset);
  void clear();
};

/// `at` counts its own instants.
struct Chunk {
  std::vector<Recording::TimeStep> time_steps;
  std::map<TrackId, TrackColumns> tracks;
  std::map<CameraId, ObservedColumns> detected;
  std::map<BodyId, BodyColumns> bodies;
  std::size_t bytes = 0;  ///< about what it takes in the file

  bool empty() const { return time_steps.empty(); }
  /// `ball` has heights whatever the others have.
  void add(const Instant& instant, int dimensions, std::optional<TrackId> ball = {});
  /// What another one holds, whose instants are later.
  void append(const Chunk& other);
  TrackColumns& track(TrackId id, int dimensions);
  void clear();
};

/// Whether reading would take it.
bool is_sound(const ImageObservation& point);

/// Why reading would refuse it; nothing if it is sound.
std::optional<std::string> problem_of(const Sample& sample);
std::optional<std::string> problem_of(const ImageObservation& point);
std::optional<std::string> problem_of(const BodyPose& pose);

}  // namespace marey::format::take
