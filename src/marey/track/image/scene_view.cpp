#include "marey/track/image/scene_view.h"

namespace marey::track::image {

void SceneView::track_camera(double dt, std::span<const Sighting> expected, std::span<const Observation<2>> detected,
                             double min_score) {
  camera_.predict(dt);
  const geometry::Similarity2& view_from_scene = camera_.view_from_scene();
  const double scale = view_from_scene.scale();
  expected_.clear();
  for (const Sighting& person : expected)
    expected_.push_back({view_from_scene * person.location, scale * person.size, scale * scale * person.variance});
  sightings_.clear();
  for (const Observation<2>& one : detected) {
    if (one.box && !one.box->empty() && one.score >= min_score) sightings_.push_back({one.box->centre(), one.box->height});
  }
  camera_.correct(expected_, sightings_);
}

std::span<const Observation<2>> SceneView::in_scene(std::span<const Observation<2>> detected) {
  const geometry::Similarity2 scene_from_view = camera_.view_from_scene().inverse();
  in_scene_.assign(detected.begin(), detected.end());
  for (Observation<2>& one : in_scene_) {
    one.value = scene_from_view * one.value;
    if (one.covariance) one.covariance = scene_from_view.turn * *one.covariance * scene_from_view.turn.transpose();
    if (one.box) one.box = scene_from_view * *one.box;
  }
  return in_scene_;
}

}  // namespace marey::track::image
