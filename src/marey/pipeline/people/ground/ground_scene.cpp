#include "marey/pipeline/people/ground/ground_scene.h"

namespace marey::pipeline::people::ground {

bool GroundScene::in_view(const Vector<2>& position, Timestamp time) const {
  if (!area.holds(position)) return false;
  for (int i = 0; i < views->cameras(); ++i) {
    const GroundView& view = views->view_at(CameraId{i}, time);
    const auto pixel = view.pixel(position);
    if (pixel && cv::Rect2d({-0.5, -0.5}, cv::Size2d(view.size())).contains({pixel->x(), pixel->y()})) return true;
  }
  return false;
}

}  // namespace marey::pipeline::people::ground
