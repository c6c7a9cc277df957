// What a user should know of images of a camera that ought to stand, where people found in them are not to be trusted: the
// camera was turned or shook, the video is cut, it shows a screen, what moves leaves its place from one image to the next, or so
// much moves at one place that no person can be distinguished from another. Each sentence names the cause, and what helps.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <opencv2/core.hpp>

#include "marey/core/frame.h"
#include "marey/core/rig.h"
#include "marey/detect/detector.h"
#include "marey/pipeline/people/view_ambiguities.h"

namespace marey::pipeline::people {

class ImageAmbiguities {
 public:
  /// `steadied`: the images were brought to the camera's rest.
  ImageAmbiguities(const RigCamera& camera, bool stabilised) : camera_(camera), view_(camera, stabilised) {}

  /// Images of the beginning, before the first frame, where they can be had.
  void inspect_at_beginning(std::span<const Frame> samples) { view_.inspect_at_beginning(samples); }
  /// Each frame in order. May be at work while `add` is.
  void watch(const Frame& frame) { view_.add(frame); }
  /// The detections of each frame, in order.
  void add(const detect::Detections& detected);

  /// What the frames since the last call showed of the camera, one sentence each.
  std::vector<std::string> news() { return view_.news(); }
  /// One sentence each, with the camera's name where it has one.
  std::vector<std::string> warnings() const;

 private:
  void inspect_at_foreground(const detect::Detections& detected);

  RigCamera camera_;
  ViewAmbiguities view_;
  cv::Mat before_;           // the foreground of the frame before
  std::vector<float> kept_;  // share of each frame's foreground that was foreground in the frame before
  std::int64_t frames_ = 0, crowded_ = 0, covered_ = 0;
  int max_in_one_ = 0;  // boxes that shared one region
};

}  // namespace marey::pipeline::people
