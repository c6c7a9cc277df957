#pragma once

#include <memory>
#include <vector>

#include <opencv2/core.hpp>

#include "marey/detect/network/model_file.h"

namespace marey::detect::network {

/// A network that is loaded, its layout known. Runs on one thread: the same picture gives the same bits.
class LoadedNetwork {
 public:
  /// Throws Error, with the model's file, where the network cannot be loaded or run, or its outputs are of no known layout.
  explicit LoadedNetwork(const NetworkModel& model);
  ~LoadedNetwork();
  LoadedNetwork(LoadedNetwork&&) noexcept;

  Layout layout() const { return *model_.layout; }
  const NetworkModel& model() const { return model_; }

  /// People in a picture, CV_8UC3, blue first, of any size: boxes in px of that picture, edges counted from its edge.
  std::vector<Candidate> find(const cv::Mat& bgr);

 private:
  struct Engine;
  std::vector<Tensor> run(const cv::Mat& bgr);

  NetworkModel model_;
  std::unique_ptr<Engine> engine_;
};

}  // namespace marey::detect::network
