// Which blobs of one camera may be the same thing as which of another: the two half-lines must lie in one half-plane bounded by
// the line through both camera centres. Every half-line has a number on that pencil of half-planes; the numbers of both cameras
// are sorted, and those that agree within the noise are partners. The lens needs no second thought: it is in the half-lines.
// Cost: sorting both cameras' rays. Reference: Hartley & Zisserman, "Multiple View Geometry", 2004, 9.1.
#pragma once

#include <vector>

#include "marey/reconstruct/frame_rays.h"

namespace marey::reconstruct {

/// Two rays that meet before both cameras, as far as noise lets that be decided.
struct EpipolarPair {
  int a = 0, b = 0;                        ///< rays
  Vector<3> position = Vector<3>::Zero();  ///< about where they meet, m
  double crossing_sine = 1;                ///< of the angle at which they meet
};

class EpipolarMatcher {
 public:
  EpipolarMatcher(const Camera& a, int number_a, const Camera& b, int number_b);

  int a() const { return a_; }
  int b() const { return b_; }
  /// How well pairs of the two give depth: the sine of the angle at which their axes meet, 0 where they face along one line.
  double quality() const { return quality_; }

  /// Appends the partners among the rays that are not `taken`, within `sigmas` standard deviations, in the order of camera a's rays
  /// on the pencil.
  void match(const FrameRays& frame, std::span<const char> taken, double sigmas, std::vector<EpipolarPair>& pairs);

 private:
  struct Entry {
    double plane;         // number on the pencil, in [-2, 2)
    double tolerance;     // its standard deviation
    double along, aside;  // cosine and sine of the angle to the line of centres
    int ray;
  };

  void list(const FrameRays& frame, std::span<const char> taken, int camera, std::vector<Entry>& entries) const;

  int a_, b_;
  Vector<3> along_ = Vector<3>::UnitX(), aside_ = Vector<3>::UnitY(), up_ = Vector<3>::UnitZ();
  double baseline_ = 0;  // m
  double quality_ = 0;
  std::vector<Entry> of_a_, of_b_;
};

}  // namespace marey::reconstruct
