#pragma once

#include <deque>
#include <map>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include <opencv2/core/types.hpp>

#include "marey/core/instant.h"
#include "marey/core/keypoints.h"
#include "marey/core/time.h"

namespace marey::draw {

/// The part of the image with a person's head, px: round the points of the face where at least two are known, with the upper part
/// of the box where there is one; nothing without both. Generous: hair and chin are in it.
std::optional<cv::Rect2f> head_of(const Sample& sample, const std::optional<KeypointSet>& keypoints);

/// Heads that are to be unrecognisable in each frame: where people are, and for `hold` before a track begins and after it ends
/// where it began and ended, for that is when a detector has just not found them yet, or lost them. Frames are therefore given back
/// later than they come. Cost: heads of frames within 2 `hold`.
class HeadsOverTime {
 public:
  explicit HeadsOverTime(Duration hold) : hold_(hold) {}

  void add(Timestamp now, std::span<const Sample> samples, const std::optional<KeypointSet>& keypoints);
  /// Of the earliest frame not given yet, once the frames of the next `hold` are known; `at_end`: of the earliest in any case.
  std::optional<std::vector<cv::Rect2f>> next(bool at_end);

 private:
  struct FrameHeads {
    Timestamp time{};
    std::vector<std::pair<TrackId, cv::Rect2f>> heads;
  };

  Duration hold_;
  std::deque<FrameHeads> frames_;                             // not given yet
  std::map<TrackId, std::pair<Timestamp, cv::Rect2f>> last_;  // of each track up to the frame given last
};

}  // namespace marey::draw
