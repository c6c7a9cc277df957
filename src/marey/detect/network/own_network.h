// Networks of the few kinds of layers that small ones for people consist of (layer_plan.h), with own loops: all channels of a pixel
// lie together, so that every layer is sums of 16 channels at a time, limits and sums of two images are parts of the convolution
// before them, and nothing is copied between layers.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "marey/detect/network/layer_plan.h"
#include "marey/detect/network/output_layout.h"

namespace marey::detect::network {

/// One for each thread: what layers make lies in it.
class OwnNetwork {
 public:
  explicit OwnNetwork(LayerPlan plan, const LayerKernels& kernels = layer_kernels());

  /// `planes`: the input, 1 × channels × rows × columns, as the plan was made for. The outputs in the plan's order.
  std::vector<Tensor> run(const float* planes);

 private:
  float* at(std::size_t value) { return buffers_[plan_.values[value].buffer].data(); }
  void take(const float* planes);
  void compute(const Layer& layer);
  void dense(const Layer& layer);
  void by_channel(const Layer& layer);
  void pool(const Layer& layer);
  void enlarge(const Layer& layer);
  void widen(const Layer& layer);
  void numbers(const Layer& layer);
  Tensor tensor(std::size_t output);

  LayerPlan plan_;
  const LayerKernels* kernels_;
  std::vector<std::vector<float>> buffers_;
  std::vector<float> padded_;  // a dense convolution's input with zeros round it
  std::vector<float> line_;    // of an image that is enlarged
};

}  // namespace marey::detect::network
