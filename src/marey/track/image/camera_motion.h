// How the camera's pan, tilt, zoom and roll move the image, read off the people in it.
//
// What people have in common moved the camera, or moves as if: the image's increment since the frame before is a similarity.
// Every pair of an expected and a seen person of one size proposes a shift. The likeliest one, by all people and by what the camera
// did before, says who is who; a weighted least-squares fit with robust weights gives shift, zoom and roll. How fast the camera
// moves, and how unsteadily, is learned as it goes: a static camera still learns that it does, and is left there, while one
// that pans is expected to continue. Between a static camera and one that moves there is no threshold.
// Cost a frame: pairs × people, bounded by taking the largest people only.
#pragma once

#include <span>
#include <vector>

#include "marey/core/geometry.h"
#include "marey/geometry/similarity2.h"

namespace marey::track::image {

/// Where one target is expected in the image, or one thing was seen, with its height: px.
struct Sighting {
  Vector<2> location = Vector<2>::Zero();
  double size = 1;
  double variance = 1;  ///< of an expected place beside where it is seen, for each axis, px²
};

class CameraMotion {
 public:
  /// Continues for `dt` s as the camera did; then `view_from_scene` says where the scene is expected.
  void predict(double dt);

  /// Corrects the prediction, by where people were expected under it and observed, px of the image. Fewer than three
  /// people change nothing.
  void correct(std::span<const Sighting> expected, std::span<const Sighting> detected);

  /// From the image of the first frame, continued to all sides, to that of now.
  const geometry::Similarity2& view_from_scene() const { return view_from_scene_; }
  /// The same `dt` s later, if the camera continues as it did.
  geometry::Similarity2 view_from_scene(double dt) const;

 private:
  /// In a step, or in a second.
  struct Increment {
    Vector<2> shift = Vector<2>::Zero();  // px, of the people's middle
    double zoom = 0;                      // of the logarithm of the scale
    double roll = 0;                      // rad
  };
  struct Pair;
  struct Fit {
    Increment increment;
    double shift_variance = 0, turn_variance = 0;
  };

  std::vector<Pair> pairs_under(const Vector<2>& shift, std::span<const Sighting> expected,
                                std::span<const Sighting> detected) const;
  Vector<2> likeliest_shift(std::span<const Sighting> expected, std::span<const Sighting> detected) const;
  Fit fitted(std::span<const Pair> pairs, const Vector<2>& middle, const Vector<2>& shift) const;
  void learn(const Fit& fit);

  geometry::Similarity2 view_from_scene_;
  Vector<2> middle_ = Vector<2>::Zero();  // of the people, as they were last seen
  double dt_ = 0;
  Increment rate_;
  double size_ = 1;             // of the people, px: the mean
  double shift_unrest_ = 4e-4;  // variance of a step's shift about what is predicted, per axis, in squared sizes
  double turn_unrest_ = 1e-6;   // the same for zoom and roll
};

}  // namespace marey::track::image
