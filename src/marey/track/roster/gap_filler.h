// Gaps in a marker's path, filled while the take is recorded: frames wait for as long as the longest gap that is filled. What the
// tracker expected in the gap (its motion, or where its companions went) is bent by a cubic so that it meets the marker's place and
// velocity where it is seen again: with a tracker that knows only straight motion that is the cubic through both ends.
// A marker that is not back by then leaves a gap; on request its first part holds what was predicted, marked so.
// Cost: one sum a gap and frame. Memory: the frames that wait.
#pragma once

#include <deque>
#include <map>
#include <span>
#include <vector>

#include "marey/core/instant.h"
#include "marey/core/track.h"

namespace marey::track::roster {

class GapFiller {
 public:
  /// Gaps of up to `longest` frames are filled; of others the first `predicted` frames are reported as they were expected (≤
  /// longest).
  GapFiller(int longest, int predicted) : longest_(longest), predicted_(predicted) {}

  /// The frame with its measured points, and what the tracker says of the markers that it does not have.
  void add(Instant frame, std::span<const Track<3>> expected);

  /// The next frame that nothing more can be added to; nothing if it has to wait.
  std::optional<Instant> next();
  /// From here on no frame waits: the recording has ended.
  void finish() { ended_ = true; }

 private:
  struct Guess {
    Timestamp time{};
    Vector<3> position = Vector<3>::Zero(), velocity = Vector<3>::Zero();
    Matrix<3> covariance = Matrix<3>::Identity();
  };
  struct Gap {
    std::int64_t first = 0;  // frames from the beginning: the first without the marker
    Timestamp detected{};    // when it was seen last
    std::vector<Guess> guesses;
  };

  void close(Gap& gap, const Guess& end, TrackId track);
  Instant* frame_at(std::int64_t number);

  int longest_, predicted_;
  bool ended_ = false;
  std::int64_t added_ = 0;
  std::deque<Instant> waiting_;
  std::map<TrackId, Gap> gaps_;
  std::map<TrackId, Timestamp> last_observed_;
};

}  // namespace marey::track::roster
