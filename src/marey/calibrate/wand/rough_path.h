#pragma once

#include <iterator>
#include <map>
#include <vector>

#include <Eigen/Geometry>

#include "marey/calibrate/board/board_graph.h"
#include "marey/calibrate/board/board_rig.h"

namespace marey::calibrate::wand {

/// The board's path as its views alone have it: for the start of the control poses.
class RoughPath {
 public:
  RoughPath(const std::vector<std::vector<board::PosedView>>& poses, const std::vector<board::BoardRigPose>& cameras) {
    for (std::size_t c = 0; c < poses.size(); ++c) {
      const Rigid3 world_from_camera = cameras[c].camera_from_world.inverse();
      for (const board::PosedView& view : poses[c])
        path_.emplace(view.time_s + cameras[c].offset_s, world_from_camera * view.camera_from_board);
    }
  }

  double begin() const { return path_.begin()->first; }

  Rigid3 at(double time_s) const {
    const auto after = path_.lower_bound(time_s);
    if (after == path_.end()) return path_.rbegin()->second;
    if (after == path_.begin()) return after->second;
    const auto before = std::prev(after);
    const double fraction = (time_s - before->first) / (after->first - before->first);
    const Eigen::Quaterniond from(before->second.rotation), to(after->second.rotation);
    return {from.slerp(fraction, to).toRotationMatrix(),
            (1 - fraction) * before->second.translation + fraction * after->second.translation};
  }

 private:
  std::map<double, Rigid3> path_;
};

}  // namespace marey::calibrate::wand
