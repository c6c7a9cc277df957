// How the weights of layers and what they make lie in memory.
#pragma once

#include <vector>

#include "marey/detect/network/layer_plan.h"
#include "marey/detect/network/onnx_graph.h"

namespace marey::detect::network {

/// The next multiple of LayerKernels::kLane.
int in_lanes(int channels);

/// Of a convolution over all channels, output × input × row × column: [lane][row, column, input channel][channel of the lane].
/// `step`: floats of an input pixel, at least as many as it has channels.
std::vector<float> dense_weights(const OnnxTensor& weights, int step);
/// Of a convolution by channel, output × 1 × row × column: [row, column][channel].
std::vector<float> weights_by_channel(const OnnxTensor& weights);

/// Values that are not needed at the same time share memory.
void assign_buffers(LayerPlan& plan);

}  // namespace marey::detect::network
