// What a user should know of pictures of a camera that ought to stand, where people found in them are not to be believed: the
// camera was turned or shook, the video is cut, it shows a screen, what moves leaves its place from one picture to the next, or so
// much moves at one place that nobody can be told from another. Each sentence names the cause, and what helps.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <opencv2/core.hpp>

#include "marey/core/frame.h"
#include "marey/core/rig.h"
#include "marey/detect/detector.h"
#include "marey/source/steady/view_watch.h"

namespace marey::pipeline {

class PictureDoubts {
 public:
  /// Each frame in order, with what was seen in it.
  void add(const Frame& frame, const detect::Detections& seen);

  /// One sentence each, with the camera's name where it has one. `shaking` is what was said of the beginning beforehand: it holds
  /// where nothing worse is known. `steadied`: the pictures were brought to the camera's rest.
  std::vector<std::string> warnings(const RigCamera& camera, const std::optional<std::string>& shaking, bool steadied) const;

 private:
  void look_at_foreground(const detect::Detections& seen);

  source::steady::ViewWatch view_;
  cv::Mat before_;           // the foreground of the frame before
  std::vector<float> kept_;  // share of each frame's foreground that was foreground in the frame before
  std::int64_t frames_ = 0, crowded_ = 0, covered_ = 0;
  int most_in_one_ = 0;  // boxes that shared one region
};

/// What to say of what the camera did.
std::vector<std::string> said_of_view(const source::steady::ViewReport& report, const std::optional<std::string>& shaking,
                                      bool steadied);

}  // namespace marey::pipeline
