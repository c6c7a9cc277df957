// Sums stay in registers while all that goes into them is added: 1 × 1, of 16 output channels and as many pixels as there are
// registers for; by channel, of 16 channels and four pixels. Highway compiles this file once for each level of the processor
// (detect/kernel_targets.h).
// clang-format off
#include "marey/detect/network/layer_kernel.h"

#include <algorithm>

#include "marey/detect/kernel_targets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "marey/detect/network/layer_kernel.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>
// clang-format on

HWY_BEFORE_NAMESPACE();
namespace marey::detect::network::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using LayerFloats = hn::CappedTag<float, LayerKernels::kLane>;
using LayerVector = hn::Vec<LayerFloats>;
using Limits = LayerKernels::Limits;

// numerical: by the registers of the processor
constexpr int kLane = LayerKernels::kLane, kStep = static_cast<int>(hn::MaxLanes(LayerFloats()));
constexpr int kTogether = kStep == kLane ? 1 : 2;  // vectors of output channels
constexpr int kPixels = kStep == kLane ? 12 : 6;   // with which their sums fill the registers
constexpr std::ptrdiff_t kBlockFloats = 48 * 1024;
constexpr int kPart = kStep * kTogether;  // output channels

struct Product {
  LayerKernels::Pixels pixels;
  const float *weights, *bias;
  const float* added;
  float* out;
  std::ptrdiff_t out_step;
};

/// `count` pixels and kPart output channels.
template <int count>
HWY_INLINE void product_of(const Product& p, Limits limits) {
  const LayerFloats d;
  LayerVector sums[count][kTogether];
#pragma GCC unroll 16
  for (int k = 0; k < count; ++k) {
#pragma GCC unroll 2
    for (int v = 0; v < kTogether; ++v) sums[k][v] = hn::LoadU(d, p.bias + v * kStep);
  }
  const float* weights = p.weights;
  for (int segment = 0; segment < p.pixels.segments; ++segment) {
    const float* values = p.pixels.values + segment * p.pixels.segment_step;
    for (int i = 0; i < p.pixels.inputs; ++i, weights += kLane) {
      LayerVector weight[kTogether];
#pragma GCC unroll 2
      for (int v = 0; v < kTogether; ++v) weight[v] = hn::LoadU(d, weights + v * kStep);
#pragma GCC unroll 16
      for (int k = 0; k < count; ++k) {
        const auto value = hn::Set(d, values[k * p.pixels.step + i]);
#pragma GCC unroll 2
        for (int v = 0; v < kTogether; ++v) sums[k][v] = hn::MulAdd(value, weight[v], sums[k][v]);
      }
    }
  }
  const auto low = hn::Set(d, limits.low), high = hn::Set(d, limits.high);
#pragma GCC unroll 16
  for (int k = 0; k < count; ++k) {
#pragma GCC unroll 2
    for (int v = 0; v < kTogether; ++v) {
      auto sum = sums[k][v];
      if (p.added != nullptr) sum = hn::Add(sum, hn::LoadU(d, p.added + k * p.out_step + v * kStep));
      hn::StoreU(hn::Min(hn::Max(sum, low), high), d, p.out + k * p.out_step + v * kStep);
    }
  }
}

/// kLane output channels of `count` pixels.
template <int count>
HWY_INLINE void lane_of(const Product& p, Limits limits) {
  for (int part = 0; part < kLane; part += kPart) {
    Product one = p;
    one.weights += part, one.bias += part, one.out += part;
    if (one.added != nullptr) one.added += part;
    product_of<count>(one, limits);
  }
}

/// kLane output channels of a block of pixels.
void block_of(Product p, int count, Limits limits) {
  const auto advance = [&](int by) {
    p.pixels.values += by * p.pixels.step, p.out += by * p.out_step;
    if (p.added != nullptr) p.added += by * p.out_step;
    count -= by;
  };
  while (count >= kPixels) lane_of<kPixels>(p, limits), advance(kPixels);
  while (count >= 4) lane_of<4>(p, limits), advance(4);
  while (count > 0) lane_of<1>(p, limits), advance(1);
}

/// Block by block: its pixels stay in the second cache while all output channels are computed of them, and a lane's weights in the
/// first one while all of its pixels are.
void product(const LayerKernels::Pixels& pixels, int count, const float* weights, const float* bias, int lanes, Limits limits,
             const float* added, float* out, std::ptrdiff_t out_step) {
  const std::ptrdiff_t inputs = static_cast<std::ptrdiff_t>(pixels.inputs) * pixels.segments;
  const int block = kPixels * std::max(1, static_cast<int>(kBlockFloats / (inputs * kPixels)));
  for (int begin = 0; begin < count; begin += block) {
    for (int lane = 0; lane < lanes; ++lane) {
      const std::ptrdiff_t first = begin * out_step + static_cast<std::ptrdiff_t>(lane) * kLane;
      Product p{
          pixels,  weights + lane * inputs * kLane, bias + lane * kLane, added == nullptr ? nullptr : added + first, out + first,
          out_step};
      p.pixels.values += begin * pixels.step;
      block_of(p, std::min(block, count - begin), limits);
    }
  }
}

template <int count>
HWY_INLINE void outputs_of(const LayerKernels::Taps& taps, const float* values, const float* weights, const float* bias,
                           Limits limits, float* out, std::ptrdiff_t out_step) {
  const LayerFloats d;
  const auto first = hn::LoadU(d, bias);
  LayerVector sums[count];
#pragma GCC unroll 4
  for (int k = 0; k < count; ++k) sums[k] = first;
  for (int r = 0; r < taps.rows; ++r) {
    const float *row = values + r * taps.down, *weight = weights + r * taps.weights_down;
    for (int c = 0; c < taps.columns; ++c, row += taps.across, weight += taps.across) {
      const auto w = hn::LoadU(d, weight);
#pragma GCC unroll 4
      for (int k = 0; k < count; ++k) sums[k] = hn::MulAdd(hn::LoadU(d, row + k * taps.next), w, sums[k]);
    }
  }
  const auto low = hn::Set(d, limits.low), high = hn::Set(d, limits.high);
#pragma GCC unroll 4
  for (int k = 0; k < count; ++k) hn::StoreU(hn::Min(hn::Max(sums[k], low), high), d, out + k * out_step);
}

void by_channel(const LayerKernels::Taps& taps, const float* bias, int count, int lanes, Limits limits, float* out) {
  const std::ptrdiff_t out_step = static_cast<std::ptrdiff_t>(lanes) * kLane;
  for (std::ptrdiff_t channel = 0; channel < out_step; channel += kStep) {
    const float* values = taps.values + channel;
    float* to = out + channel;
    int left = count;
    for (; left >= 4; left -= 4, values += 4 * taps.next, to += 4 * out_step)
      outputs_of<4>(taps, values, taps.weights + channel, bias + channel, limits, to, out_step);
    for (; left > 0; --left, values += taps.next, to += out_step)
      outputs_of<1>(taps, values, taps.weights + channel, bias + channel, limits, to, out_step);
  }
}

void sum(const float* a, float by_a, const float* b, float by_b, std::size_t count, Limits limits, float* out) {
  const LayerFloats d;
  const auto low = hn::Set(d, limits.low), high = hn::Set(d, limits.high), of_a = hn::Set(d, by_a), of_b = hn::Set(d, by_b);
  for (std::size_t i = 0; i < count; i += kStep) {
    const auto both = hn::MulAdd(hn::LoadU(d, a + i), of_a, hn::Mul(hn::LoadU(d, b + i), of_b));
    hn::StoreU(hn::Min(hn::Max(both, low), high), d, out + i);
  }
}

void larger(const float* a, const float* b, std::size_t count, float* out) {
  const LayerFloats d;
  for (std::size_t i = 0; i < count; i += kStep) hn::StoreU(hn::Max(hn::LoadU(d, a + i), hn::LoadU(d, b + i)), d, out + i);
}

const LayerKernels& layer_table() {
  static constexpr LayerKernels all = {product, by_channel, sum, larger};
  return all;
}

}  // namespace
}  // namespace marey::detect::network::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace marey::detect::network {

HWY_EXPORT(layer_table);

const LayerKernels& layer_kernels() {
  return HWY_DYNAMIC_DISPATCH(layer_table)();
}

}  // namespace marey::detect::network
#endif
