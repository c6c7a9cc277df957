// A recording's tracks while operations are applied to them: taken out of their columns when an operation first wants them, and
// put back at the end. Operations that name two tracks of fifty touch two; a fill of all of them waits for who asks for one.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "marey/core/recording.h"
#include "marey/edit/operation.h"

namespace marey::edit {

class Tracks {
 public:
  struct Row {
    std::int32_t at = 0;  ///< which of the recording's instants
    Sample sample;
  };
  using Rows = std::vector<Row>;  ///< by growing instant
  /// A track as it was recorded.
  using Load = std::function<TrackColumns(TrackId)>;

  /// The instants and tracks of a recording; `load` gives a track's columns when they are wanted first.
  Tracks(std::vector<Recording::TimeStep> time_steps, const std::vector<TrackName>& names, Load load);

  std::span<const Recording::TimeStep> time_steps() const { return time_steps_; }
  /// By id, without those that an operation has used up.
  std::vector<TrackName> names() const;
  bool has(TrackId track) const { return tracks_.contains(track); }
  /// Throws Error if there is no such track.
  const TrackName& name(TrackId track) const;
  Rows& rows(TrackId track);
  /// An id that no track has had.
  TrackId unused_id() const;
  /// Whether an operation has changed it.
  bool changed(TrackId track) const;

  /// Throws Error if a track is missing, or two tracks that are joined are both there at one instant.
  void apply(const Operation& operation);

  /// The track's columns now.
  TrackColumns columns(TrackId track, int dimensions);

 private:
  struct Entry {
    TrackName name;
    std::optional<Rows> rows;  // nothing until they are wanted
    bool changed = false;
    std::vector<FilledGap> due = {};  // fills that keep their places, for when the rows are wanted
    int dimensions = 0;               // of the columns that the rows were in
  };

  Entry& entry(TrackId track);
  /// The rows of `rows` within these frames.
  std::span<Row> within(Rows& rows, const std::optional<FrameRange>& frames) const;
  void swap(const Operation& operation);
  void split(const Operation& operation);
  void join(const Operation& operation);
  void remove(const Operation& operation);
  void fill(const Operation& operation);
  void filter(const Operation& operation);

  std::vector<Recording::TimeStep> time_steps_;
  Load load_;
  std::map<TrackId, Entry> tracks_;
  TrackId last_id_{};
};

}  // namespace marey::edit
