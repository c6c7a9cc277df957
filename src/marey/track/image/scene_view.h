// The scene as a tracker of people sees it, whatever the camera does.
#pragma once

#include <span>
#include <vector>

#include "marey/core/observation.h"
#include "marey/track/image/camera_motion.h"

namespace marey::track::image {

/// Follows the camera by the people in the picture, and puts what is seen into coordinates that stand still.
class SceneView {
 public:
  /// Goes on by `dt` s. `expected`: people as they are expected in the scene; of those seen, in the picture, the ones with a box
  /// and a score of at least `least_score` count.
  void follow_camera(double dt, std::span<const Sighting> expected, std::span<const Observation<2>> seen, double least_score);

  /// What is seen in the picture, in coordinates of the scene. Valid until the next call.
  std::span<const Observation<2>> in_scene(std::span<const Observation<2>> seen);

  /// Those seen who counted, px of the picture. Valid until the next call of follow_camera.
  std::span<const Sighting> sightings() const { return sightings_; }

  const geometry::Similarity2& view_from_scene() const { return camera_.view_from_scene(); }
  /// As it will be `dt` s later.
  geometry::Similarity2 view_from_scene(double dt) const { return camera_.view_from_scene(dt); }

 private:
  CameraMotion camera_;
  std::vector<Sighting> expected_, sightings_;  // px of the picture
  std::vector<Observation<2>> in_scene_;
};

}  // namespace marey::track::image
