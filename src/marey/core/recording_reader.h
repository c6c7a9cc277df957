#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "marey/core/instant.h"
#include "marey/core/recording.h"
#include "marey/core/sink.h"

namespace marey {

/// A recording that is read instant by instant: a take, another system's file, or one that is in memory. Units and axes are
/// Marey's.
class RecordingReader {
 public:
  virtual ~RecordingReader() = default;

  virtual const RecordingHeader& header() const = 0;
  /// The tracks that it may name, by id, as far as they are known by now.
  virtual std::vector<TrackName> tracks() const = 0;
  virtual std::vector<Edit> edits() const { return {}; }
  virtual std::optional<std::int64_t> head() const { return std::nullopt; }
  /// From the first instant to the last; nothing if only reading would reveal it. For progress.
  virtual std::optional<std::int64_t> instant_count() const { return std::nullopt; }

  /// The next instant, by growing index; nothing at the end. `Instant::named` holds only what `tracks` did not have before. Throws
  /// Error where the file is not what its beginning promised.
  virtual std::optional<Instant> next() = 0;

  /// What is doubtful in the file, one sentence each; complete when all of it was read.
  virtual std::vector<std::string> warnings() const { return {}; }
};

/// Reads a recording in memory, which must outlive it.
class MemoryReader : public RecordingReader {
 public:
  explicit MemoryReader(const Recording& recording) : recording_(&recording), instants_(recording) {}

  const RecordingHeader& header() const override { return recording_->header; }
  std::vector<TrackName> tracks() const override;
  std::vector<Edit> edits() const override { return recording_->edits; }
  std::optional<std::int64_t> head() const override { return recording_->head; }
  std::optional<std::int64_t> instant_count() const override;
  std::optional<Instant> next() override;

 private:
  const Recording* recording_;
  InstantsOf instants_;
};

/// What a recording holds, counted. A take file brings it, so that its instants need not be read for it.
struct RecordingSummary {
  /// One track over the whole recording.
  struct TrackCount {
    TrackName name;
    std::optional<std::int64_t> first_index, last_index;  ///< where it has its first and last sample
    std::array<std::int64_t, 4> by_provenance{};

    std::int64_t of(Provenance provenance) const { return by_provenance[static_cast<std::size_t>(provenance)]; }
    std::int64_t samples() const { return by_provenance[0] + by_provenance[1] + by_provenance[2] + by_provenance[3]; }
    void add(std::int64_t index, Provenance provenance);
  };

  std::int64_t instants = 0, detected = 0, samples = 0;
  std::optional<std::int64_t> first_index, last_index;  ///< nothing if there is no instant
  std::optional<Timestamp> first_time, last_time;
  std::vector<TrackCount> tracks;  ///< by id
  bool complete = false;           ///< false while it is being written, and where writing was cut off
};

/// Reads all of a recording to count what is in it.
RecordingSummary summary_of(RecordingReader& reader);

/// Reads all of a recording into memory.
Recording read_all(RecordingReader& reader);

/// Hands a recording on to a sink, from `begin` to `finish`: its tracks are named with the first instant. `goes_on` is asked after
/// each instant with how many there were; where it says no, the sink is not finished. False in that case.
bool replay(RecordingReader& reader, Sink& sink, const std::function<bool(std::int64_t instants)>& goes_on = {});

}  // namespace marey
