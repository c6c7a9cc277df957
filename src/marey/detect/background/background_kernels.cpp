// Plain loops over bytes, written so that compilers turn them into vector code without help: no branch, no call, no index but the
// loop's own. Highway compiles this file once for each level of the processor (detect/kernel_targets.h).
// clang-format off
#include "marey/detect/background/background_kernels.h"

#include <cstddef>

#include "marey/detect/kernel_targets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "marey/detect/background/background_kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>
// clang-format on

HWY_BEFORE_NAMESPACE();
namespace marey::detect::background::HWY_NAMESPACE {
namespace {

using Byte = std::uint8_t;
using Word = std::int16_t;

inline Byte lesser(Byte a, Byte b) {
  return a < b ? a : b;
}
inline Byte greater(Byte a, Byte b) {
  return a > b ? a : b;
}
inline Byte above(Byte a, Byte b) {
  return a > b ? static_cast<Byte>(a - b) : Byte{0};
}
inline Byte mark_of(Byte pixel, Byte low, Byte high) {
  const Byte excess = static_cast<Byte>(above(pixel, high) | above(low, pixel));
  const Byte enough = static_cast<Byte>((high - low) >> 1);
  const Byte weak = excess > 0 ? 1 : 0;
  const Byte strong = above(excess, 0) >= enough ? 16 : 0;
  return static_cast<Byte>(weak | (weak ? strong : 0));
}

void classify(const Byte* __restrict pixels, const Byte* __restrict low, const Byte* __restrict high, int width,
              Byte* __restrict mark) {
  for (int x = 0; x < width; ++x) mark[x] = mark_of(pixels[x], low[x], high[x]);
}

void classify_chroma(const Byte* const pixels[2], const Byte* const low[2], const Byte* const high[2], int width,
                     Byte* __restrict mark) {
  const Byte* __restrict pixels0 = pixels[0];
  const Byte* __restrict pixels1 = pixels[1];
  const Byte* __restrict low0 = low[0];
  const Byte* __restrict low1 = low[1];
  const Byte* __restrict high0 = high[0];
  const Byte* __restrict high1 = high[1];
  for (int x = 0; x < width; ++x) {
    const Byte both = static_cast<Byte>(mark_of(pixels0[x], low0[x], high0[x]) | mark_of(pixels1[x], low1[x], high1[x]));
    mark[2 * x] = both;
    mark[2 * x + 1] = both;
  }
}

void unite(const Byte* __restrict source, int width, Byte* __restrict target) {
  for (int x = 0; x < width; ++x) target[x] = static_cast<Byte>(target[x] | source[x]);
}

void vote(const Byte* const rows[3], int quorum, int width, Byte* __restrict out) {
  const Byte* __restrict a = rows[0];
  const Byte* __restrict b = rows[1];
  const Byte* __restrict c = rows[2];
  const Byte needed = static_cast<Byte>(quorum);
  for (int x = 0; x < width; ++x) {
    const Byte left = static_cast<Byte>((a[x - 1] & 1) + (b[x - 1] & 1) + (c[x - 1] & 1));
    const Byte middle = static_cast<Byte>((a[x] & 1) + (b[x] & 1) + (c[x] & 1));
    const Byte right = static_cast<Byte>((a[x + 1] & 1) + (b[x + 1] & 1) + (c[x + 1] & 1));
    const Byte votes = static_cast<Byte>(left + middle + right);
    const Byte strong = static_cast<Byte>((b[x] >> 3) & 2);
    const Byte solid = votes == 9 ? 4 : 0;
    out[x] = votes >= needed ? static_cast<Byte>(1 | strong | solid) : Byte{0};
  }
}

void learn(const Byte* __restrict pixels, const Byte* __restrict frozen, int width, int shift, Word* __restrict mean,
           Byte* __restrict spread) {
  constexpr Word kBound = 8 * 128;  // a speck of noise far out moves the mean no more than this would
  const Word half = static_cast<Word>(shift > 0 ? 1 << (shift - 1) : 0);
  for (int x = 0; x < width; ++x) {
    const Word old = mean[x];
    const Word distance = static_cast<Word>((pixels[x] << 7) - old);
    Word bounded = distance > kBound ? kBound : distance;
    bounded = bounded < -kBound ? static_cast<Word>(-kBound) : bounded;
    const Word step = static_cast<Word>((bounded + half) >> shift);
    mean[x] = frozen[x] ? old : static_cast<Word>(old + step);

    const Word length = static_cast<Word>(distance < 0 ? -distance : distance);
    const Word eighths = static_cast<Word>(length >> 4);
    const Word was = spread[x];
    const Word wider = static_cast<Word>(was + 3 < 255 ? was + 3 : 255);
    const Word narrower = static_cast<Word>(was > 0 ? was - 1 : 0);
    const Word next = eighths > was ? wider : narrower;
    spread[x] = static_cast<Byte>(frozen[x] ? was : next);
  }
}

void band(const Word* const rows[3], const Byte* __restrict spread, int width, int gate, int floor, Byte* __restrict low,
          Byte* __restrict high) {
  const Word* __restrict a = rows[0];
  const Word* __restrict b = rows[1];
  const Word* __restrict c = rows[2];
  constexpr Word kMaxWidth = 64 * 128;
  constexpr Word kWhite = 255 * 128;  // format: 8 bits of luma, in 1/128
  const Word minimum = static_cast<Word>(floor * 128);
  const Word factor = static_cast<Word>(gate);
  const auto put = [&](int x, int left, int right) HWY_ATTR {
    Word lowest = a[left], highest = a[left];
    const auto take = [&](Word value) HWY_ATTR {
      lowest = value < lowest ? value : lowest;
      highest = value > highest ? value : highest;
    };
    take(a[x]), take(a[right]), take(b[left]), take(b[x]), take(b[right]), take(c[left]), take(c[x]), take(c[right]);
    const Word noise = static_cast<Word>(spread[x] * factor);  // 1/8 level · 1/16 = 1/128 level
    const Word wide = noise < kMaxWidth ? noise : kMaxWidth;
    const Word half_width = wide > minimum ? wide : minimum;
    // Bounded before the half width is taken off or added, so that 16 bits hold every step.
    const Word below = static_cast<Word>(b[x] - ((b[x] - lowest) >> 1));
    const Word over = static_cast<Word>(b[x] + ((highest - b[x]) >> 1));
    const Word room = static_cast<Word>(kWhite - half_width);
    const Word bottom = static_cast<Word>((below > half_width ? below : half_width) - half_width);
    const Word top = static_cast<Word>((over < room ? over : room) + half_width);
    low[x] = static_cast<Byte>(bottom >> 7);
    high[x] = static_cast<Byte>((top >> 7) + ((top & 127) != 0 ? 1 : 0));
  };
  put(0, 0, width > 1 ? 1 : 0);
  for (int x = 1; x < width - 1; ++x) put(x, x - 1, x + 1);
  if (width > 1) put(width - 1, width - 2, width - 1);
}

/// Batcher's odd-even merge sort: the same comparisons whatever the values, so that pixels are sorted side by side.
void sort(Byte* rows, int log2_count, int stride, int width) {
  const int count = 1 << log2_count;
  for (int p = 1; p < count; p *= 2) {
    for (int k = p; k >= 1; k /= 2) {
      for (int j = k % p; j + k < count; j += 2 * k) {
        for (int i = 0; i < k && i + j + k < count; ++i) {
          if ((i + j) / (2 * p) != (i + j + k) / (2 * p)) continue;
          Byte* __restrict first = rows + static_cast<std::ptrdiff_t>(i + j) * stride;
          Byte* __restrict second = rows + static_cast<std::ptrdiff_t>(i + j + k) * stride;
          for (int x = 0; x < width; ++x) {
            const Byte lower = lesser(first[x], second[x]);
            second[x] = greater(first[x], second[x]);
            first[x] = lower;
          }
        }
      }
    }
  }
}

void shortest_half(const Byte* rows, int count, int stride, int width, Byte* __restrict middle, Byte* __restrict spread) {
  const int half = count / 2;
  for (int x = 0; x < width; ++x) {
    middle[x] = 0;
    spread[x] = 255;
  }
  for (int i = 0; i + half < count; ++i) {
    const Byte* __restrict first = rows + static_cast<std::ptrdiff_t>(i) * stride;
    const Byte* __restrict last = rows + static_cast<std::ptrdiff_t>(i + half) * stride;
    const Byte* __restrict inner = rows + static_cast<std::ptrdiff_t>(i + half / 2) * stride;
    for (int x = 0; x < width; ++x) {
      const Byte length = static_cast<Byte>(last[x] - first[x]);
      middle[x] = length < spread[x] ? inner[x] : middle[x];
      spread[x] = lesser(length, spread[x]);
    }
  }
  for (int x = 0; x < width; ++x) spread[x] = static_cast<Byte>(lesser(spread[x], 36) * 7);
}

const BackgroundKernels& kernels() {
  static constexpr BackgroundKernels all = {classify, classify_chroma, unite, vote, learn, band, sort, shortest_half};
  return all;
}

}  // namespace
}  // namespace marey::detect::background::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace marey::detect::background {

HWY_EXPORT(kernels);

const BackgroundKernels& background_kernels() {
  return HWY_DYNAMIC_DISPATCH(kernels)();
}

}  // namespace marey::detect::background
#endif
