#include "marey/detect/network/layer_memory.h"

#include <algorithm>
#include <cstddef>
#include <set>

namespace marey::detect::network {
namespace {

constexpr std::size_t kLanes = LayerKernels::kLane;

}  // namespace

int in_lanes(int channels) {
  constexpr int kOne = LayerKernels::kLane;
  return (channels + kOne - 1) / kOne * kOne;
}

std::vector<float> dense_weights(const OnnxTensor& weights, int step) {
  const int outputs = weights.shape[0], inputs = weights.shape[1], taps = weights.shape[2] * weights.shape[3];
  std::vector<float> packed(static_cast<std::size_t>(in_lanes(outputs)) * static_cast<std::size_t>(taps * step), 0);
  for (int o = 0; o < outputs; ++o) {
    for (int i = 0; i < inputs; ++i) {
      for (int t = 0; t < taps; ++t) {
        const std::size_t output = static_cast<std::size_t>(o), of_lane = static_cast<std::size_t>(taps * step);
        const std::size_t row = output / kLanes * of_lane + static_cast<std::size_t>(t * step + i);
        packed[row * kLanes + output % kLanes] = weights.floats[static_cast<std::size_t>((o * inputs + i) * taps + t)];
      }
    }
  }
  return packed;
}

std::vector<float> weights_by_channel(const OnnxTensor& weights) {
  const int channels = weights.shape[0], taps = weights.shape[2] * weights.shape[3], step = in_lanes(channels);
  std::vector<float> packed(static_cast<std::size_t>(step * taps), 0);
  for (int c = 0; c < channels; ++c) {
    for (int t = 0; t < taps; ++t)
      packed[static_cast<std::size_t>(t * step + c)] = weights.floats[static_cast<std::size_t>(c * taps + t)];
  }
  return packed;
}

void assign_buffers(LayerPlan& plan) {
  constexpr std::size_t kAlways = static_cast<std::size_t>(-1);  // numerical
  std::vector<std::size_t> last(plan.values.size(), 0);
  for (std::size_t i = 0; i < plan.layers.size(); ++i) {
    for (const std::size_t from : plan.layers[i].from) last[from] = i;
  }
  for (const std::size_t value : plan.required) last[value] = kAlways;
  std::vector<std::size_t> free;
  const auto place = [&](LayerValue& value) {
    const std::size_t needed = value.floats();
    const auto nearest = std::min_element(free.begin(), free.end(), [&](std::size_t a, std::size_t b) {
      const auto cost = [&](std::size_t buffer) {
        const std::size_t size = plan.buffer_sizes[buffer];
        return size >= needed ? size - needed : 4 * (needed - size);
      };
      return cost(a) < cost(b);
    });
    if (nearest == free.end()) {
      value.buffer = plan.buffer_sizes.size();
      plan.buffer_sizes.push_back(needed);
      return;
    }
    value.buffer = *nearest;
    plan.buffer_sizes[value.buffer] = std::max(plan.buffer_sizes[value.buffer], needed);
    free.erase(nearest);
  };
  place(plan.values[0]);
  for (std::size_t i = 0; i < plan.layers.size(); ++i) {
    place(plan.values[plan.layers[i].to]);
    std::set<std::size_t> ended;
    for (const std::size_t from : plan.layers[i].from) {
      if (last[from] == i) ended.insert(plan.values[from].buffer);
    }
    free.insert(free.end(), ended.begin(), ended.end());
  }
}

}  // namespace marey::detect::network
