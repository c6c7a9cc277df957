// What in an image may be the ball: small, round and brighter than the scene behind it, of the size that a ball has there.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <vector>

#include <opencv2/core.hpp>

#include "marey/core/frame.h"
#include "marey/core/geometry.h"

namespace marey::detect::ball {

/// The radius of a ball that lies on the ground and is seen at a pixel, px; nothing if no ground is seen.
using BallSize = std::function<std::optional<double>(const Vector<2>& pixel)>;

/// First guesses; how often the ball is found with them, and false things: docs/ball.md.
struct BallDetectorOptions {
  double contrast = 14;       ///< grey levels that it is brighter than the scene, at least
  double white = 185;         ///< grey level of a ball
  double min_light = 0.15;    ///< of the light that a ball on the ground adds to the image: less is noise,
  double max_light = 16;      ///< more is not a ball, however near it flies
  double size_spread = 0.35;  ///< deviation of the logarithm of the radius, of balls that are smaller than on the ground there,
  double flown_spread = 0.9;  ///< and of those that are larger, for they fly nearer: from a low stand twice as near and more
  double track_hz = 4;        ///< grey levels a second by which the scene is followed
  int maximum = 60;           ///< candidates in a frame, the best
};

struct BallCandidate {
  Vector<2> centre = Vector<2>::Zero();  ///< px: of its light
  double sigma = 0.5;                    ///< px, of each coordinate
  double radius = 0;                     ///< px: of a white disc of as much light
  double score = 0;                      ///< logarithm of how much likelier a ball appears so than anything else that is found
  double local_clutter = 0;              ///< 0 … 1: of what is round it, up to some radii away, the share that is not the scene
};

class BallDetector {
 public:
  BallDetector(BallSize size, const BallDetectorOptions& options = {}) : size_(std::move(size)), options_(options) {}

  /// Learns the empty scene: the median of these. Without it the first frame is the scene.
  void prime(std::span<const Frame> samples);

  /// Frames in order.
  std::vector<BallCandidate> detect(const Frame& frame);

 private:
  void adapt_scene(const cv::Mat& luma, Timestamp time);
  std::optional<BallCandidate> assess(const cv::Mat& blobs, int blob, const cv::Rect& box) const;
  double local_clutter(const cv::Rect& box, double radius) const;

  BallSize size_;
  BallDetectorOptions options_;
  cv::Mat scene_;  // CV_8UC1
  cv::Mat added_;  // CV_8UC1: by how much the frame is brighter
  cv::Mat other_;  // CV_32SC1: integral of where it is brighter or darker
  std::optional<Timestamp> tracked_;
};

}  // namespace marey::detect::ball
