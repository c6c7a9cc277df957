#pragma once

#include <span>
#include <vector>

#include <opencv2/core.hpp>

#include "marey/detect/network/inference.h"
#include "marey/detect/network/model_file.h"

namespace marey::detect::network {

/// A network that is loaded, its layout known. Several images are searched on as many threads as OpenCV has (--threads), each on
/// one: the same image gives the same bits.
class LoadedNetwork {
 public:
  /// Throws Error, with the model's file, where the network cannot be loaded or run, or its outputs are of no known layout.
  explicit LoadedNetwork(const NetworkModel& model);

  Layout layout() const { return *model_.layout; }
  const NetworkModel& model() const { return model_; }

  /// People in an image, CV_8UC3, blue first, of any size: boxes in px of that image, edges counted from its edge.
  std::vector<Candidate> find(const cv::Mat& bgr);
  /// The same of each image, in their order.
  std::vector<std::vector<Candidate>> find_all(std::span<const cv::Mat> images);

 private:
  std::vector<Tensor> run(Inference::Engine& engine, const cv::Mat& bgr) const;
  std::vector<Candidate> find(Inference::Engine& engine, const cv::Mat& bgr) const;

  NetworkModel model_;
  Inference inference_;
};

}  // namespace marey::detect::network
