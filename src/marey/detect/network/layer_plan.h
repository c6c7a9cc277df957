// The order in which own_network.h computes a network's layers, and where in memory what they make lies.
#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "marey/detect/network/layer_kernel.h"
#include "marey/detect/network/onnx_graph.h"

namespace marey::detect::network {

/// What a layer makes: an image, pixel by pixel, or rows of numbers without gaps.
struct LayerValue {
  int rows = 0, columns = 0, channels = 0;
  int step = 0;            ///< floats from pixel to pixel
  std::vector<int> shape;  ///< of rows of numbers; empty: it is an image
  std::size_t buffer = 0;

  std::size_t floats() const;
  std::ptrdiff_t row_step() const { return static_cast<std::ptrdiff_t>(columns) * step; }
};

struct Layer {
  enum class Kind {
    dense,       ///< convolution over all channels
    by_channel,  ///< convolution of each channel by itself
    sum,         ///< of two images
    pool,        ///< the largest of 2 × 2 pixels
    enlarge,     ///< twice the size, bilinear
    logistic,
    widen,    ///< more channels, of zeros
    numbers,  ///< an image as rows of numbers: row, column, channel
    join,     ///< rows of numbers one after the other
  };

  Kind kind = Kind::dense;
  std::vector<std::size_t> from;  ///< values; a dense one's second is added to what it makes
  std::size_t to = 0;
  int size_y = 1, size_x = 1, stride = 1;  ///< of a convolution
  int top = 0, left = 0, bottom = 0, right = 0;
  std::vector<float> weights, bias;  ///< as LayerKernels has them
  LayerKernels::Limits limits{-std::numeric_limits<float>::max(), std::numeric_limits<float>::max()};

  bool limited() const {
    return limits.low > -std::numeric_limits<float>::max() || limits.high < std::numeric_limits<float>::max();
  }
};

struct LayerPlan {
  std::vector<LayerValue> values;  ///< the first is the input, without gaps between its pixels
  std::vector<Layer> layers;
  std::vector<std::string> outputs;
  std::vector<std::size_t> required;      ///< values, of `outputs`
  std::vector<std::size_t> buffer_sizes;  ///< floats
};

/// Whether all nodes are of the kinds that layers exist for.
bool has_known_layers(const OnnxGraph& graph);

/// For an input of 1 × channels × rows × columns. Nothing if an output needs a layer of another kind.
std::optional<LayerPlan> layer_plan(const OnnxGraph& graph, std::span<const int> input, std::span<const std::string> required);

}  // namespace marey::detect::network
