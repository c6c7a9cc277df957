#pragma once

#include <algorithm>
#include <span>

#include "marey/core/track.h"
#include "marey/geometry/similarity2.h"

namespace marey::pipeline {

/// How far the camera moved the picture, beside how tall people are in it.
class CameraSpan {
 public:
  void see(const geometry::Similarity2& view_from_scene, std::span<const Track<2>> tracks) {
    for (const Track<2>& track : tracks) {
      if (!track.box) continue;
      farthest_ = std::max(farthest_, (track.position - view_from_scene.inverse() * track.position).norm());
      heights_ += track.box->height;
      ++people_;
    }
  }
  bool moved() const { return people_ > 0 && farthest_ > kMoved * heights_ / people_; }
  double farthest() const { return farthest_; }  // px

 private:
  static constexpr double kMoved = 1;  // heights of the people; what a camera that stands still is taken to drift by is less

  double farthest_ = 0, heights_ = 0;
  double people_ = 0;
};

}  // namespace marey::pipeline
