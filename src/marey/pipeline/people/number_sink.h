#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "marey/core/sink.h"
#include "marey/core/track_names.h"
#include "marey/detect/shirts/number_votes.h"
#include "marey/files/whole_file.h"
#include "marey/pipeline/corridor/run.h"

namespace marey::pipeline::people {

/// The shirt numbers of tracked people, read twice a second of each in each camera that shows the person large enough and in front
/// of all others, as CSV: `id,number,probability,readings,time`, a row for each track of which digits were legible. `number` is the
/// likeliest, `time` (s) that of its clearest reading. From the instant on at which a number has kDecisiveNumber or more, sinks
/// that draw have it behind the track's name ("12 no. 10").
class NumberSink final : public Sink {
 public:
  /// `drawn`: sinks that are given every instant behind this one. Throws Error if the file cannot be written, or the network is
  /// not there.
  explicit NumberSink(const std::string& path, std::vector<std::unique_ptr<Sink>> drawn = {});

  std::string name() const override { return name_; }
  SinkRequirements begin(const RecordingHeader& header) override;
  void write(const Instant& instant) override;
  void finish() override;

 private:
  struct Track {
    detect::shirts::NumberVotes votes;
    std::map<CameraId, Timestamp> read_at;  // when each camera's image of the person was read last
    std::string shown;                      // empty: not decided
  };

  void collect(const Frame& frame, const Instant& instant, std::vector<TrackId>& tracks,
               std::vector<detect::shirts::ShirtView>& views);
  bool is_due(TrackId track, CameraId camera, Timestamp time);
  std::vector<TrackId> read(const Instant& instant);
  std::string label_with_number(const TrackName& name) const;
  Instant with_numbers(const Instant& instant, const std::vector<TrackId>& changed);

  std::string name_;  // with those of the sinks that draw
  WholeFile file_;
  detect::shirts::ShirtNetwork network_;
  bool by_boxes_ = false;
  std::optional<KeypointSet> keypoints_;
  std::map<TrackId, Track> tracks_;
  corridor::Sinks drawn_;
  TrackNames names_;
};

}  // namespace marey::pipeline::people
