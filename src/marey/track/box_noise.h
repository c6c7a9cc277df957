// What a recording's boxes are like: how far a box lies beside the person, how its sides err and drift, how hard people
// accelerate. Learned while they are followed, from targets that were seen in frames at equal distances.
//
// The second difference of a place over h seconds is 6 R + 2/3 q h³ for a place that errs by R and a velocity that is a Wiener
// process of density q; the first difference of a side's logarithm over h is 2 R + d h where that drifts as a random walk. Taken
// over one frame and over several, both unknowns follow. Differences do not know which filter followed the target, and one that
// went over to somebody else shows in few of them: each counts as much as an outlier does, at most.
// Cost: a few operations a target and frame.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "marey/core/geometry.h"

namespace marey::track {

/// Lengths in heights of the box.
struct BoxNoiseLevels {
  double place = 0.05;          ///< standard deviation of a box's centre, each axis
  double acceleration = 0.15;   ///< square root of the density of white acceleration, heights/s^1.5
  double size = 0.2;            ///< standard deviation of the logarithm of a box's width and height
  double drift = 0.15;          ///< what that logarithm changes by in a second
};

/// The last boxes of one target.
class BoxTrail {
 public:
  static constexpr std::size_t kLength = 33;  // frames

  struct Entry {
    bool seen = false;
    Vector<2> centre = Vector<2>::Zero();  // px
    float log_width = 0, log_height = 0;
  };

  void add(const Entry& entry) {
    entries_[next_++ % kLength] = entry;
  }
  /// The frame so many before the last one added, where the target was seen in it.
  const Entry* back(std::size_t frames) const {
    if (frames >= kLength || frames >= next_) return nullptr;
    const Entry& entry = entries_[(next_ - 1 - frames) % kLength];
    return entry.seen ? &entry : nullptr;
  }

 private:
  std::array<Entry, kLength> entries_;
  std::size_t next_ = 0;
};

class BoxNoise {
 public:
  /// `first` counts until more is known.
  explicit BoxNoise(const BoxNoiseLevels& first) : first_(first) {}

  /// Takes in a target that was seen in the last frame of its trail; frames are `dt` s apart.
  void see(const BoxTrail& trail, double dt);

  BoxNoiseLevels levels() const;

 private:
  /// A mean of squares in which an outlier counts no more than `kOutlier` times the mean.
  struct MeanSquare {
    double value = 0, count = 0;
    void add(double square, double first);
    double with_prior(double first) const;
  };
  std::size_t far(double dt) const;

  BoxNoiseLevels first_;
  double dt_ = 0;
  MeanSquare place_near_, place_far_, size_near_, size_far_;
};

}  // namespace marey::track
