// Sums stay in registers while all that goes into them is added: two vectors of a row by channel, two of each of six rows for 1
// × 1. Highway compiles this file once for each level of the processor (detect/kernel_targets.h).
// clang-format off
#include "marey/detect/network/convolution_kernel.h"

#include <cstddef>

#include "marey/detect/kernel_targets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "marey/detect/network/convolution_kernel.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>
// clang-format on

HWY_BEFORE_NAMESPACE();
namespace marey::detect::network::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using Floats = hn::CappedTag<float, ConvolutionKernels::kBlock / 2>;

template <int size>
void row_of(const DepthwiseRows& rows, const float* weights, float bias, float low, float high, int width, float* out) {
  const Floats d;
  const int step = static_cast<int>(hn::Lanes(d));
  const auto minimum = hn::Set(d, low), maximum = hn::Set(d, high), first = hn::Set(d, bias);
  for (int x = 0; x < width; x += 2 * step) {
    auto left = first, right = first;
    for (int r = 0; r < size; ++r) {
      for (int k = 0; k < size; ++k) {
        const auto weight = hn::Set(d, weights[r * size + k]);
        const float* values = rows.taps[r][k] + x;
        left = hn::MulAdd(weight, hn::LoadU(d, values), left);
        right = hn::MulAdd(weight, hn::LoadU(d, values + step), right);
      }
    }
    hn::StoreU(hn::Min(hn::Max(left, minimum), maximum), d, out + x);
    hn::StoreU(hn::Min(hn::Max(right, minimum), maximum), d, out + x + step);
  }
}

void by_channel(const DepthwiseRows& rows, const float* weights, int size, float bias, float low, float high, int width,
                float* out) {
  if (size == 3) {
    row_of<3>(rows, weights, bias, low, high, width, out);
  } else {
    row_of<5>(rows, weights, bias, low, high, width, out);
  }
}

void point(const float* pixels, const float* weights, int inputs, const float* bias, float low, float high, float* out,
           int stride) {
  const Floats d;
  constexpr int kBlock = ConvolutionKernels::kBlock, kRows = ConvolutionKernels::kRows;
  static_assert(kRows == 6);
  const int step = static_cast<int>(hn::Lanes(d));
  const auto minimum = hn::Set(d, low), maximum = hn::Set(d, high);
  for (int x = 0; x < kBlock; x += 2 * step) {
    auto a0 = hn::Set(d, bias[0]), a1 = hn::Set(d, bias[1]), a2 = hn::Set(d, bias[2]), a3 = hn::Set(d, bias[3]),
         a4 = hn::Set(d, bias[4]), a5 = hn::Set(d, bias[5]);
    auto b0 = a0, b1 = a1, b2 = a2, b3 = a3, b4 = a4, b5 = a5;
    const float* from = pixels + x;
    const float* weight = weights;
    for (int i = 0; i < inputs; ++i, from += kBlock, weight += kRows) {
      const auto left = hn::LoadU(d, from), right = hn::LoadU(d, from + step);
      const auto add = [&](auto& a, auto& b, int row) HWY_ATTR {
        const auto w = hn::Set(d, weight[row]);
        a = hn::MulAdd(w, left, a);
        b = hn::MulAdd(w, right, b);
      };
      add(a0, b0, 0), add(a1, b1, 1), add(a2, b2, 2), add(a3, b3, 3), add(a4, b4, 4), add(a5, b5, 5);
    }
    const auto put = [&](auto a, auto b, int row) HWY_ATTR {
      float* to = out + static_cast<std::ptrdiff_t>(row) * stride + x;
      hn::StoreU(hn::Min(hn::Max(a, minimum), maximum), d, to);
      hn::StoreU(hn::Min(hn::Max(b, minimum), maximum), d, to + step);
    };
    put(a0, b0, 0), put(a1, b1, 1), put(a2, b2, 2), put(a3, b3, 3), put(a4, b4, 4), put(a5, b5, 5);
  }
}

const ConvolutionKernels& kernels() {
  static constexpr ConvolutionKernels all = {by_channel, point};
  return all;
}

}  // namespace
}  // namespace marey::detect::network::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace marey::detect::network {

HWY_EXPORT(kernels);

const ConvolutionKernels& convolution_kernels() {
  return HWY_DYNAMIC_DISPATCH(kernels)();
}

}  // namespace marey::detect::network
#endif
