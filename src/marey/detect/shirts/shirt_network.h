#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include <opencv2/core/mat.hpp>

#include "marey/core/image.h"
#include "marey/detect/network/inference.h"
#include "marey/detect/shirts/number_strings.h"
#include "marey/detect/shirts/shirt_region.h"

namespace marey::detect::shirts {

/// What one image says of a shirt's number.
struct ShirtReading {
  StringProbabilities strings{};  ///< of the number there, if there are digits alone; they sum to 1
  double legibility = 0;          ///< probability that digits are there and no other characters
};

/// A shirt in one of several images.
struct ShirtView {
  Image image;
  ShirtRegion region;
};

/// PP-OCRv4's text recogniser as `script/model --numbers` makes it. Shirts are shared out among as many threads as OpenCV has
/// (--threads); the same image gives the same bits.
class ShirtNetwork {
 public:
  /// Throws Error if the file is not there, cannot be loaded, or is another network.
  explicit ShirtNetwork(const std::string& onnx);

  std::vector<ShirtReading> read(std::span<const ShirtView> views);

  /// What the network says of one crop, CV_8UC3 of 96 × 48, blue first: 12 columns × 6,625 classes.
  network::Tensor raw(const cv::Mat& crop);

 private:
  network::Tensor run(network::Inference::Engine& engine, const cv::Mat& crop) const;
  ShirtReading read(network::Inference::Engine& engine, const ShirtView& view) const;

  std::string path_;
  network::Inference inference_;
};

/// The network that `script/model --numbers` makes (keypoints/model_folder.h). Throws Error, naming that, where it is not there.
std::string shirt_network_file();

}  // namespace marey::detect::shirts
