// One clock for all cameras. Instants follow each other at the rate of the fastest camera, from the first frame of the earliest;
// each camera contributes the frame that lies nearest to the instant, if that is less than half a frame away.
//
// A camera that is out of step by a part of a frame saw the markers somewhere else than they are at the instant: its blobs are
// moved along the line between the frames before and after, each blob to the one of the other frame that is its nearest and to
// which it is the nearest. What has no such partner is left out: nobody knows where it was. A camera that stops, drops frames, or
// is slower gives nothing to the instants it has no frame for; the others go on. Memory: a few frames a camera. Threads: cameras
// are asked for frames side by side; what comes out does not depend on them.
#pragma once

#include <deque>
#include <optional>
#include <vector>

#include "marey/pipeline/blob_feed.h"
#include "marey/pipeline/stage_times.h"

namespace marey::pipeline {

/// All that is known of one instant.
struct Instant {
  std::int64_t index = 0;
  Timestamp time{};
  std::vector<Observation<2>> seen;  ///< of all cameras, in their order
  int cameras = 0;                   ///< that have a frame
};

class Instants {
 public:
  /// `rate_hz`: of the instants; nothing: of the fastest camera.
  Instants(std::vector<std::unique_ptr<BlobFeed>> feeds, std::optional<double> rate_hz);

  double rate_hz() const { return rate_hz_; }
  std::size_t cameras() const { return lanes_.size(); }

  /// The next instant; nothing when all cameras have ended. Valid until the next call.
  const Instant* next();

  const StageTimes& decoding() const { return decoding_; }
  const StageTimes& detecting() const { return detecting_; }
  /// Frames that camera `number` gave, and how many instants it had nothing for.
  std::int64_t frames(std::size_t number) const { return lanes_[number].frames; }
  std::int64_t missed(std::size_t number) const { return lanes_[number].missed; }
  std::vector<std::string> warnings() const;

 private:
  struct Lane {
    std::unique_ptr<BlobFeed> feed;
    std::deque<SeenBlobs> frames_waiting;
    bool ended = false;
    std::int64_t frames = 0, missed = 0;
  };

  void fill(Timestamp until);
  void take(Lane& lane, Timestamp now);
  void add_moved(const SeenBlobs& nearest, const SeenBlobs& other, Timestamp now);

  std::vector<Lane> lanes_;
  double rate_hz_ = 0;
  std::optional<Timestamp> start_;
  Instant instant_;
  std::int64_t next_ = 0;
  StageTimes decoding_, detecting_;
  std::vector<int> partner_;
};

}  // namespace marey::pipeline
