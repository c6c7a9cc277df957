// What the cameras' keypoint files show at one instant of the rig's clock.
#pragma once

#include <deque>
#include <optional>
#include <vector>

#include "marey/core/keypoint_sequence.h"
#include "marey/core/rig.h"
#include "marey/core/time.h"

namespace marey::pipeline::keypoints {

/// One camera's keypoints and its clock: frame k was exposed at k / rate_hz + offset_s by the rig's.
struct KeypointCamera {
  KeypointSequence sequence;
  double rate_hz = 0, offset_s = 0;

  double first_s() const { return offset_s; }
  double last_s() const { return offset_s + (static_cast<double>(sequence.frames.size()) - 1) / rate_hz; }
};

/// The keypoints of people in one image, brought to an instant between two frames: each point on the straight line between the two
/// where both show it, else as the nearer one has it. People are the same whose points lie nearest to each other. `share` in [0, 1]
/// of the distance from the earlier to the later frame.
std::vector<Keypoints<2>> between_frames(const std::vector<Keypoints<2>>& earlier, const std::vector<Keypoints<2>>& later,
                                         double fraction);

/// All cameras' people at even instants.
class KeypointFrames {
 public:
  /// The instants follow each other by the first camera's rate while two cameras at least have frames, or the only one has. The
  /// cameras must outlive it.
  explicit KeypointFrames(const std::vector<std::optional<KeypointCamera>>& cameras);

  std::size_t size() const { return size_; }
  double rate_hz() const { return rate_hz_; }
  double time_s(std::size_t instant) const { return first_s_ + static_cast<double>(instant) / rate_hz_; }
  /// The people of a camera; none where it has no frame.
  const std::vector<Keypoints<2>>& at(std::size_t instant, std::size_t camera) const {
    return *people_[instant * cameras_ + camera];
  }

 private:
  std::size_t cameras_ = 0, size_ = 0;
  double rate_hz_ = 0, first_s_ = 0;
  std::vector<const std::vector<Keypoints<2>>*> people_;  // by instant, then camera
  std::deque<std::vector<Keypoints<2>>> moved_;
};

}  // namespace marey::pipeline::keypoints
