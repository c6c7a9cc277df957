#pragma once

#include <span>
#include <string>
#include <vector>

#include <opencv2/core/mat.hpp>

#include "marey/core/image.h"
#include "marey/core/keypoints.h"
#include "marey/detect/keypoints/person_region.h"
#include "marey/detect/network/inference.h"

namespace marey::detect::keypoints {

/// One person in a region of an image.
struct Body {
  Keypoints<2> keypoints;  ///< of blazepose(), px of the image; all of them, those that are hidden or outside too
  PersonRegion next;       ///< where the person is to be searched for in the next image
};

/// Which pixels of a region show its person.
struct BodyPixels {
  cv::Mat chance;       ///< CV_32FC1, kCrop × kCrop, 0 … 1: over the region's crop
  double presence = 0;  ///< of any person in the region
  PersonRegion region;
};

/// A region of one of several cameras' images.
struct ImageRegion {
  Image image;  ///< colour or grey
  PersonRegion region;
};

/// One of MediaPipe's landmark networks (script/model). Regions are shared out among as many threads as OpenCV has (--threads).
class LandmarkNetwork {
 public:
  /// Throws Error if the file is not there, cannot be loaded, or is another network.
  explicit LandmarkNetwork(const std::string& onnx);

  /// Who is in each region of an image, CV_8UC3, blue first. `Keypoints::presence` says whether there is a person.
  std::vector<Body> find(const cv::Mat& bgr, std::span<const PersonRegion> regions);
  /// The same in regions of several images, which share the threads. Only the pixels in a region are converted.
  std::vector<Body> find(std::span<const ImageRegion> searched);

  /// The pixels of who is in each region, where the body points are not needed.
  std::vector<BodyPixels> pixels(std::span<const ImageRegion> searched);

  /// What the network says of one crop: "landmarks" (39 × x, y, depth, visibility, presence), "presence", "heatmaps".
  std::vector<network::Tensor> raw(const cv::Mat& crop);

 private:
  std::vector<network::Tensor> run(network::Inference::Engine& engine, const cv::Mat& crop,
                                   std::span<const std::string> outputs) const;

  std::string path_;
  network::Inference inference_;
};

/// Pixels out of the mask and the presence that a landmark network gives for a region's crop. Throws Error for a mask of another
/// size.
BodyPixels pixels_of(std::span<const network::Tensor> outputs, const PersonRegion& region);

/// A body out of what a landmark network says of a region's crop.
Body body_of(std::span<const network::Tensor> outputs, const PersonRegion& region);

}  // namespace marey::detect::keypoints
