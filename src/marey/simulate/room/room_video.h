#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include <opencv2/core/mat.hpp>
#include <opencv2/core/types.hpp>

#include "marey/core/source.h"
#include "marey/simulate/room/room.h"

namespace marey::simulate::room {

struct RoomVideoOptions {
  double marker_radius = 0.007;  ///< m
  double image_noise = 0.7;      ///< standard deviation of the pixels, grey levels
};

/// What camera `index` of a room videos: grey frames with the markers as discs at their exact places, the pixels bring the noise.
std::unique_ptr<Source> video_room(const RoomOptions& room, std::size_t index, const RoomVideoOptions& options = {});

/// The image of what camera `index` sees (RoomScene::seen_by) at a time by the rig's clock; `draw` is that of the noise.
cv::Mat draw_room(const RoomScene& scene, std::size_t index, double time_s, const std::vector<RoomBlob>& detected,
                  std::uint64_t draw, const RoomVideoOptions& options = {});

/// What `draw_room` draws, for images that are kept in memory: the spots alone, over one field of noise that lies elsewhere in
/// each image. They take about a hundredth of what the images would.
class RoomSpots {
 public:
  RoomSpots(const RoomScene& scene, std::size_t index, const RoomVideoOptions& options = {});

  struct Drawn {
    std::vector<cv::Rect> locations;   ///< in the image; those of spots that touch overlap
    std::vector<std::uint8_t> pixels;  ///< of all places, row by row
    cv::Point noise;                   ///< where the image lies in the field of noise
  };
  /// Arguments as of `draw_room`. May be called from several threads.
  Drawn draw(double time_s, const std::vector<RoomBlob>& detected, std::uint64_t draw) const;
  cv::Mat image(const Drawn& drawn) const;

 private:
  const RoomScene& scene_;
  std::size_t index_;
  RoomVideoOptions options_;
  cv::Size size_;
  cv::Mat field_;
};

/// By how many cameras each marker can be seen in a frame, in the order of the labels.
std::vector<int> cameras_that_observe(const RoomScene& scene, const RoomFrame& frame);

}  // namespace marey::simulate::room
