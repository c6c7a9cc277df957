#pragma once

#include <cstddef>

namespace marey::detect::network {

/// The inner loops of own_network.h. Images lie pixel by pixel, all channels of one together, filled up with zeros to a multiple of
/// kLane. Results are held in [low, high]. Steps are counted in floats.
struct LayerKernels {
  static constexpr int kLane = 16;  ///< numerical: channels that are computed together

  struct Limits {
    float low, high;
  };

  /// What one output pixel is a sum of: `segments` pieces of `inputs` neighbouring values; from pixel to pixel and from piece to
  /// piece.
  struct Pixels {
    const float* values;
    std::ptrdiff_t step;
    int inputs, segments;
    std::ptrdiff_t segment_step;
  };
  /// out[p][o] = bias[o] + Σ weights[o / kLane][i][o % kLane] · pixels[p][i] over all values i of all pieces, of `count` pixels and
  /// `lanes` × kLane output channels; + added[p][o] where that is not null, which has `out`'s steps.
  void (*product)(const Pixels& pixels, int count, const float* weights, const float* bias, int lanes, Limits limits,
                  const float* added, float* out, std::ptrdiff_t out_step);

  /// Where a convolution by channel reads: the first tap of the first output, the steps from a tap to the next one down and across,
  /// and from output to output. Weights are by row, column, channel.
  struct Taps {
    const float* values;
    std::ptrdiff_t down, across, next;
    const float* weights;
    std::ptrdiff_t weights_down;
    int rows, columns;
  };
  /// out[p][c] = bias[c] + Σ weights · taps, of `count` outputs and `lanes` × kLane channels.
  void (*by_channel)(const Taps& taps, const float* bias, int count, int lanes, Limits limits, float* out);

  /// out = a · by_a + b · by_b; of `count` floats, a multiple of kLane.
  void (*sum)(const float* a, float by_a, const float* b, float by_b, std::size_t count, Limits limits, float* out);
  /// out = the larger one.
  void (*larger)(const float* a, const float* b, std::size_t count, float* out);
};

/// The fastest that this machine runs.
const LayerKernels& layer_kernels();

}  // namespace marey::detect::network
