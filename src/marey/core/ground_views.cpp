#include "marey/core/ground_views.h"

#include <algorithm>
#include <utility>

#include "marey/core/error.h"

namespace marey {

GroundViews::GroundViews(std::vector<GroundView> views) {
  for (GroundView& view : views) cameras_.push_back({std::move(view), {}});
}

const GroundView& GroundViews::view_at(CameraId camera, Timestamp time) const {
  const OneCamera& one = cameras_.at(static_cast<std::size_t>(number(camera)));
  const auto later = std::upper_bound(one.rotations.begin(), one.rotations.end(), time,
                                      [](Timestamp t, const Turn& turn) { return t < turn.from; });
  return later == one.rotations.begin() ? one.first : std::prev(later)->view;
}

void GroundViews::turn(CameraId camera, Timestamp from, const GroundView& view) {
  OneCamera& one = cameras_.at(static_cast<std::size_t>(number(camera)));
  if (!one.rotations.empty() && from <= one.rotations.back().from)
    throw Error("camera {} is turned at {} s after it was turned at {} s; turns are reported in the order of time", number(camera),
                seconds(from), seconds(one.rotations.back().from));
  one.rotations.push_back({from, view});
}

std::shared_ptr<GroundViews> ground_views(std::vector<GroundView> views) {
  return std::make_shared<GroundViews>(std::move(views));
}

}  // namespace marey
