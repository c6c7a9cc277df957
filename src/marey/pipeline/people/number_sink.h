#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "marey/core/sink.h"
#include "marey/detect/shirts/number_votes.h"
#include "marey/files/whole_file.h"

namespace marey::pipeline::people {

/// The shirt numbers of tracked people, read twice a second of each in each camera that shows the person large enough and in front
/// of all others, as CSV: `id,number,probability,readings,time`, a row for each track of which digits were legible. `number` is the
/// likeliest, `time` (s) that of its clearest reading.
class NumberSink final : public Sink {
 public:
  /// Throws Error if the file cannot be written, or the network is not there.
  explicit NumberSink(const std::string& path);

  std::string name() const override { return path_; }
  SinkRequirements begin(const RecordingHeader& header) override;
  void write(const Instant& instant) override;
  void finish() override;

 private:
  struct Track {
    detect::shirts::NumberVotes votes;
    std::map<CameraId, Timestamp> read_at;  // when each camera's image of the person was read last
  };

  void collect(const Frame& frame, const Instant& instant, std::vector<TrackId>& tracks,
               std::vector<detect::shirts::ShirtView>& views);
  bool is_due(TrackId track, CameraId camera, Timestamp time);

  std::string path_;
  WholeFile file_;
  detect::shirts::ShirtNetwork network_;
  bool by_boxes_ = false;
  std::optional<KeypointSet> keypoints_;
  std::map<TrackId, Track> tracks_;
};

}  // namespace marey::pipeline::people
