// The scene as a tracker of people sees it, whatever the camera does.
#pragma once

#include <span>
#include <vector>

#include "marey/core/observation.h"
#include "marey/track/image/camera_motion.h"

namespace marey::track::image {

/// Follows the camera by the people in the image, and puts the observations into coordinates that stand still.
class SceneView {
 public:
  /// Continues by `dt` s. `expected`: people as they are expected in the scene; of those seen, in the image, the ones with a box
  /// and a score of at least `min_score` count.
  void track_camera(double dt, std::span<const Sighting> expected, std::span<const Observation<2>> detected, double min_score);

  /// The observations in the image, in coordinates of the scene. Valid until the next call.
  std::span<const Observation<2>> in_scene(std::span<const Observation<2>> detected);

  /// Those seen who counted, px of the image. Valid until the next call of track_camera.
  std::span<const Sighting> sightings() const { return sightings_; }

  const geometry::Similarity2& view_from_scene() const { return camera_.view_from_scene(); }
  /// As it will be `dt` s later.
  geometry::Similarity2 view_from_scene(double dt) const { return camera_.view_from_scene(dt); }

 private:
  CameraMotion camera_;
  std::vector<Sighting> expected_, sightings_;  // px of the image
  std::vector<Observation<2>> in_scene_;
};

}  // namespace marey::track::image
