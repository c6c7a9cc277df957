// What a recording's boxes are like: how far a box lies beside the person, how its sides err and drift, how hard people
// accelerate. Learned while they are followed, from targets that were seen in frames at equal distances.
//
// The second difference of a place over h seconds has a variance of 6 R + 2/3 q h³, where the place errs by R and the velocity is a
// Wiener process of density q; the first difference of a side's logarithm has 2 R + d h, where that drifts as a random walk. Taken
// over two distances, both unknowns follow. A detector's errors last for some frames, and so do poses: over 0.2 and 0.5 s both
// count as errors of the box, which is what following needs; over one frame only what is new in each box does, which says how much
// of a box is to be trusted when it is written.
// Differences do not know which filter followed the target; one that went over to another person shows in few of them, and each
// counts at most as `kOutlier` typical ones. Cost: a few operations a target and frame.
#pragma once

#include <array>
#include <cstddef>

#include "marey/core/geometry.h"

namespace marey::track::image {

/// Lengths in heights of the box.
struct BoxNoiseLevels {
  double location = 0.05;      ///< standard deviation of a box's centre, each axis
  double acceleration = 0.15;  ///< square root of the density of white acceleration, heights/s^1.5
  double size = 0.2;           ///< standard deviation of the logarithm of a box's width and height
  double drift = 0.15;         ///< what that logarithm changes by in a second
};

/// The last boxes of one target.
class BoxTrail {
 public:
  static constexpr std::size_t kLength = 33;  ///< frames

  /// Takes in the observation of it in the next frame: a box in px, or nothing (an empty one).
  void add(const Box& box);

  struct Entry {
    bool detected = false;
    Vector<2> centre = Vector<2>::Zero();    ///< px
    Vector<2> log_size = Vector<2>::Zero();  ///< of width and height, px
  };
  /// The frame this many before the last one added; null where the target was not seen in it or that is too long ago.
  const Entry* back(std::size_t frames) const;

 private:
  std::array<Entry, kLength> entries_;
  std::size_t next_ = 0;
};

struct LastingFractions;

class BoxNoise {
 public:
  /// `first` counts until more is known.
  explicit BoxNoise(const BoxNoiseLevels& first = {}) : first_(first) {}

  /// Takes in a target that was seen in the last frame of its trail; frames are `dt` s apart.
  void observe_frame(const BoxTrail& trail, double dt);

  /// What a box errs by beside the body, a detector's lasting errors and poses included.
  BoxNoiseLevels levels() const { return levels(Trust::slow); }
  /// What of it is new in every frame.
  BoxNoiseLevels levels_of_a_frame() const { return levels_of_a_frame(Trust::slow); }
  /// Time from frame to frame of what was taken in, s; 0 before.
  double frame_time() const { return dt_; }

 private:
  friend LastingFractions lasting_fractions(const BoxNoise& noise);

  /// How soon the recording's own differences outweigh the first levels: slowly for tracking, where too little noise loses people;
  /// soon and in proportion for written boxes, whose noise may be a hundredth of the first level.
  enum class Trust { slow, soon };

  /// Squares of differences over a number of frames, of places and of sizes.
  class Differences {
   public:
    void add(const BoxTrail& trail, std::size_t frames, double dt, const BoxNoiseLevels& first);
    double location(const BoxNoiseLevels& first, double span, Trust trust) const;
    double size(const BoxNoiseLevels& first, double span, Trust trust) const;

   private:
    struct MeanSquare {
      double value = 0, count = 0;
      void add(double square, double first);
      double with(double first) const;
      double recording_weight() const;
      double soon_with(double first) const;
    };
    MeanSquare location_, size_;
  };
  BoxNoiseLevels solved(const Differences& shorter, double near, const Differences& longer, double far, Trust trust) const;
  BoxNoiseLevels levels(Trust trust) const;
  BoxNoiseLevels levels_of_a_frame(Trust trust) const;

  BoxNoiseLevels first_;
  double dt_ = 0;
  Differences frame_, two_frames_, near_, far_;
};

/// How much of a box's errors is there in the next frame too: the person's pose, or a habit of the detector. In [0, 1].
struct LastingFractions {
  double location = 0, size = 0;
};
LastingFractions lasting_fractions(const BoxNoise& noise);

/// The box to write of a target that filters have at `filtered` and that was `seen`: as much nearer to the observation as errors
/// last.
Box written_box(const Box& filtered, const Box& detected, const LastingFractions& fractions);

}  // namespace marey::track::image
