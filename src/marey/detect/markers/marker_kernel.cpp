// Finding bright words and summing the linearised disc. Highway compiles this file once for each level of the processor
// (detect/kernel_targets.h). Nothing here may call an inline function of another header: it would be compiled for the plainest.
//
// Scanning: most of an image is dark, so 64 pixels at a time are compared with their threshold and only words with a bit set are
// written out. Cost: one load and one comparison, or subtraction and comparison, for 16, 32 or 64 pixels; the scan runs at the
// speed of memory.
//
// Linearising: eight pixels at a time in GNU vector types, which every level computes in the same order without fused
// multiply-adds, so that all levels agree to the bit. Φ after Abramowitz & Stegun 26.2.17 (error below 1e-7).
// clang-format off
#include "marey/detect/markers/marker_kernel.h"

#include <cstddef>
#include <cstdint>

#include "marey/detect/kernel_targets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "marey/detect/markers/marker_kernel.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>
#if HWY_ARCH_X86
#include <immintrin.h>
#endif
// clang-format on

HWY_BEFORE_NAMESPACE();
namespace marey::detect::markers::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

template <typename Pixel, bool dark>
HWY_INLINE bool passes(Pixel value, unsigned threshold) {
  return dark ? value < threshold : value > threshold;
}

/// The words at a row's end, and all of them where there is no vector unit.
template <typename Pixel, bool dark>
HWY_INLINE std::uint64_t bits_of_few(const Pixel* pixels, int count, unsigned threshold) {
  std::uint64_t bits = 0;
  for (int i = 0; i < count; ++i) bits |= std::uint64_t{passes<Pixel, dark>(pixels[i], threshold)} << i;
  return bits;
}

// Highway reads a mask of 8 or 16 bits by way of memory or of pext: with AVX2 that costs half as much again of 16-bit scans
// (docs/decisions/013).
#if HWY_TARGET == HWY_AVX3

template <bool dark>
HWY_INLINE std::uint64_t bits_of_word(const std::uint8_t* pixels, unsigned threshold) {
  const __m512i limit = _mm512_set1_epi8(static_cast<char>(threshold));
  const __m512i value = _mm512_loadu_si512(pixels);
  return dark ? _mm512_cmplt_epu8_mask(value, limit) : _mm512_cmpgt_epu8_mask(value, limit);
}

template <bool dark>
HWY_INLINE std::uint64_t bits_of_word(const std::uint16_t* pixels, unsigned threshold) {
  const __m512i limit = _mm512_set1_epi16(static_cast<short>(threshold));
  const __m512i low = _mm512_loadu_si512(pixels);
  const __m512i high = _mm512_loadu_si512(pixels + 32);
  const std::uint64_t first = dark ? _mm512_cmplt_epu16_mask(low, limit) : _mm512_cmpgt_epu16_mask(low, limit);
  const std::uint64_t second = dark ? _mm512_cmplt_epu16_mask(high, limit) : _mm512_cmpgt_epu16_mask(high, limit);
  return first | second << 32;
}

#elif HWY_TARGET == HWY_AVX2

template <bool dark>
HWY_INLINE std::uint64_t bits_of_word(const std::uint8_t* pixels, unsigned threshold) {
  const __m256i limit = _mm256_set1_epi8(static_cast<char>(threshold));
  const auto failing = [&](const std::uint8_t* at) HWY_ATTR {
    const __m256i value = _mm256_loadu_si256(reinterpret_cast<const __m256i*>(at));
    const __m256i beyond = dark ? _mm256_subs_epu8(limit, value) : _mm256_subs_epu8(value, limit);
    return static_cast<std::uint32_t>(_mm256_movemask_epi8(_mm256_cmpeq_epi8(beyond, _mm256_setzero_si256())));
  };
  return ~(failing(pixels) | std::uint64_t{failing(pixels + 32)} << 32);
}

template <bool dark>
HWY_INLINE std::uint64_t bits_of_word(const std::uint16_t* pixels, unsigned threshold) {
  const __m256i limit = _mm256_set1_epi16(static_cast<short>(threshold));
  const auto failing = [&](const std::uint16_t* at) HWY_ATTR {
    const __m256i value = _mm256_loadu_si256(reinterpret_cast<const __m256i*>(at));
    const __m256i beyond = dark ? _mm256_subs_epu16(limit, value) : _mm256_subs_epu16(value, limit);
    return _mm256_cmpeq_epi16(beyond, _mm256_setzero_si256());
  };
  const auto half = [&](const std::uint16_t* at) HWY_ATTR {
    const __m256i packed = _mm256_packs_epi16(failing(at), failing(at + 16));
    return static_cast<std::uint32_t>(_mm256_movemask_epi8(_mm256_permute4x64_epi64(packed, 0xD8)));
  };
  return ~(half(pixels) | std::uint64_t{half(pixels + 32)} << 32);
}

#elif HWY_ARCH_X86

template <bool dark>
HWY_INLINE std::uint64_t bits_of_word(const std::uint8_t* pixels, unsigned threshold) {
  const __m128i limit = _mm_set1_epi8(static_cast<char>(threshold));
  std::uint64_t failing = 0;
  for (int part = 0; part < 4; ++part) {
    const __m128i value = _mm_loadu_si128(reinterpret_cast<const __m128i*>(pixels + 16 * part));
    const __m128i beyond = dark ? _mm_subs_epu8(limit, value) : _mm_subs_epu8(value, limit);
    const int mask = _mm_movemask_epi8(_mm_cmpeq_epi8(beyond, _mm_setzero_si128()));
    failing |= std::uint64_t{static_cast<std::uint32_t>(mask)} << (16 * part);
  }
  return ~failing;
}

template <bool dark>
HWY_INLINE std::uint64_t bits_of_word(const std::uint16_t* pixels, unsigned threshold) {
  const __m128i limit = _mm_set1_epi16(static_cast<short>(threshold));
  const auto failing_at = [&](const std::uint16_t* at) HWY_ATTR {
    const __m128i value = _mm_loadu_si128(reinterpret_cast<const __m128i*>(at));
    const __m128i beyond = dark ? _mm_subs_epu16(limit, value) : _mm_subs_epu16(value, limit);
    return _mm_cmpeq_epi16(beyond, _mm_setzero_si128());
  };
  std::uint64_t failing = 0;
  for (int part = 0; part < 4; ++part) {
    const std::uint16_t* at = pixels + 16 * part;
    const int mask = _mm_movemask_epi8(_mm_packs_epi16(failing_at(at), failing_at(at + 8)));
    failing |= std::uint64_t{static_cast<std::uint32_t>(mask)} << (16 * part);
  }
  return ~failing;
}

#elif HWY_TARGET == HWY_SCALAR

template <bool dark, typename Pixel>
HWY_INLINE std::uint64_t bits_of_word(const Pixel* pixels, unsigned threshold) {
  return bits_of_few<Pixel, dark>(pixels, 64, threshold);
}

#else

template <bool dark, typename Pixel>
HWY_INLINE std::uint64_t bits_of_word(const Pixel* pixels, unsigned threshold) {
  const hn::CappedTag<Pixel, 64> tag;
  const auto limit = hn::Set(tag, static_cast<Pixel>(threshold));
  alignas(8) std::uint8_t bytes[16] = {};  // Highway may write eight at a time
  for (std::size_t i = 0; i < 64; i += hn::Lanes(tag)) {
    const auto value = hn::LoadU(tag, pixels + i);
    hn::StoreMaskBits(tag, dark ? hn::Lt(value, limit) : hn::Gt(value, limit), bytes + i / 8);
  }
  std::uint64_t bits;
  __builtin_memcpy(&bits, bytes, sizeof bits);
  return bits;
}

#endif

template <typename Pixel, bool dark>
int scan_band(const MarkerBand& band, MarkerHit* hits) {
  const int whole = band.width / 64;
  const int rest = band.width % 64;
  int found = 0;
  for (int row = 0; row < band.rows; ++row) {
    const auto* pixels = reinterpret_cast<const Pixel*>(static_cast<const char*>(band.pixels) + row * band.stride);
    for (int word = 0; word < whole; ++word) {
      const std::uint64_t bits = bits_of_word<dark>(pixels + 64 * word, band.thresholds[word]);
      if (HWY_UNLIKELY(bits != 0)) hits[found++] = {row, word, bits};
    }
    if (rest > 0) {
      const std::uint64_t bits = bits_of_few<Pixel, dark>(pixels + 64 * whole, rest, band.thresholds[whole]);
      if (bits != 0) hits[found++] = {row, whole, bits};
    }
  }
  return found;
}

template <typename Pixel>
int scan(const MarkerBand& band, MarkerHit* hits) {
  return band.dark ? scan_band<Pixel, true>(band, hits) : scan_band<Pixel, false>(band, hits);
}

using Floats = float __attribute__((vector_size(32)));
using Integers = std::int32_t __attribute__((vector_size(32)));

HWY_INLINE Floats load(const float* from) {
  Floats value;
  __builtin_memcpy(&value, from, sizeof value);
  return value;
}

HWY_INLINE Floats square_root(Floats value) {
#if HWY_ARCH_X86 && HWY_TARGET == HWY_SCALAR
  __m128 half[2];
  __builtin_memcpy(half, &value, sizeof value);
  half[0] = _mm_sqrt_ps(half[0]);
  half[1] = _mm_sqrt_ps(half[1]);
  __builtin_memcpy(&value, half, sizeof value);
#else
  for (int i = 0; i < 8; ++i) value[i] = __builtin_sqrtf(value[i]);  // compilers make one instruction of it
#endif
  return value;
}

/// 2^x for −126 ≤ x ≤ 0: the whole part goes into the exponent's bits, the rest, within ±½, through a polynomial.
HWY_INLINE Floats power_of_two(Floats x) {
  const Integers whole = __builtin_convertvector(x - 0.5f, Integers);
  const Floats f = x - __builtin_convertvector(whole, Floats);
  const Floats rest =
      1.0f + f * (0.69314718f + f * (0.24022651f + f * (0.05550411f + f * (0.00961813f + f * (0.00133336f + f * 0.00015404f)))));
  return rest * reinterpret_cast<Floats>((whole + 127) << 23);
}

/// A blurred edge, `distance` from a centre: the share of what lies within it, and its density, for u = (distance − radius) / blur.
struct Edge {
  Floats fraction, density;
};

HWY_INLINE Edge edge_at(Floats u) {
  Floats exponent = u * u * -0.72134752f;  // −u²/2 · log₂ e
  exponent = exponent < -120.0f ? Floats{} - 120.0f : exponent;
  const Floats density = power_of_two(exponent) * 0.39894228f;
  const Floats size = u < 0.0f ? -u : u;
  const Floats t = 1.0f / (1.0f + 0.2316419f * size);
  const Floats tail = density * t * (0.31938153f + t * (-0.35656378f + t * (1.78147794f + t * (-1.82125598f + t * 1.33027443f))));
  return {u < 0.0f ? 1.0f - tail : tail, density};
}

HWY_INLINE float sum_of(Floats s) {
  return ((s[0] + s[4]) + (s[2] + s[6])) + ((s[1] + s[5]) + (s[3] + s[7]));
}

HWY_INLINE bool any(Integers mask) {
  std::uint64_t parts[4];
  __builtin_memcpy(parts, &mask, sizeof parts);
  return (parts[0] | parts[1] | parts[2] | parts[3]) != 0;
}

DiscSums linearise_disc(const MarkerSamples& samples, const float* p) {
  const float cx = p[0], cy = p[1], radius = p[2], contrast = p[4], background = p[5];
  const float inverse_blur = 1.0f / p[3];
  Floats sums[28] = {};
  for (int i = 0; i < samples.count; i += 8) {
    const Floats dx = load(samples.x + i) - cx;
    const Floats dy = load(samples.y + i) - cy;
    const Floats distance = square_root(dx * dx + dy * dy + 1.0f / 12);
    const Floats u = (distance - radius) * inverse_blur;
    const auto [fraction, density] = edge_at(u);
    const Floats weight = load(samples.weight + i);
    const Floats slope = contrast * inverse_blur * density;
    const Floats along = slope / distance;
    const Floats residual = load(samples.value + i) - background - contrast * fraction;
    const Floats one = Floats{} + 1.0f;
    const Floats jacobian[kDiscParameters] = {along * dx, along * dy, slope, slope * u, fraction, one};
    int k = 0;
    for (int a = 0; a < kDiscParameters; ++a) {
      const Floats weighted = weight * jacobian[a];
      for (int b = a; b < kDiscParameters; ++b) sums[k++] += weighted * jacobian[b];
      sums[21 + a] += weighted * residual;
    }
    sums[27] += weight * residual * residual;
  }
  DiscSums result;
  for (int k = 0; k < 28; ++k) result.sum[k] = sum_of(sums[k]);
  return result;
}

constexpr float kFlat = 4.5f;  // blurs from the edge beyond which it is not felt

/// Eight pixels as one disc sees them.
struct Detected {
  Floats away_x, away_y, distance;  ///< px, from the disc's centre or the nearest of its segment
  Floats u;                         ///< blurs outside its edge
  Floats along;                     ///< along the sweep: −1 at one end, 1 at the other
  Edge edge;
};

/// Several discs as parameters in vectors' reach.
template <int discs, bool swept>
struct Discs {
  static constexpr int n = kFirstDisc + 3 * discs + (swept ? 2 : 0);
  const float* p;
  float contrast = p[kDiscsContrast], background = p[kDiscsBackground], inverse_blur = 1.0f / p[kDiscsBlur];
  float half_x = swept ? p[n - 2] : 0, half_y = swept ? p[n - 1] : 0;
  float length = half_x * half_x + half_y * half_y, along = length > 1e-9f ? 1.0f / length : 0;
  bool adds;
  float maximum;

  /// Whether any of the pixels is near enough to the edge to feel it.
  HWY_INLINE Integers observe_frame(int disc, Floats x, Floats y, Detected& detected) const {
    const float* at = p + kFirstDisc + 3 * disc;
    detected.away_x = x - at[0];
    detected.away_y = y - at[1];
    if (swept) {
      Floats t = (detected.away_x * half_x + detected.away_y * half_y) * along;
      t = t < -1.0f ? Floats{} - 1.0f : t;
      detected.along = t > 1.0f ? Floats{} + 1.0f : t;
      detected.away_x -= detected.along * half_x;
      detected.away_y -= detected.along * half_y;
    }
    detected.distance = square_root(detected.away_x * detected.away_x + detected.away_y * detected.away_y + 1.0f / 12);
    detected.u = (detected.distance - at[2]) * inverse_blur;
    return (detected.u < kFlat) & (detected.u > -kFlat);
  }

  /// The pixels' share of all discs; `edges` says that some pixel feels one.
  HWY_INLINE Floats fraction(Detected* detected, bool edges) const {
    Floats outside = Floats{} + 1.0f, sum = {};
    for (int d = 0; d < discs; ++d) {
      const Floats within = detected[d].u < 0.0f ? Floats{} + 1.0f : Floats{};
      detected[d].edge = edges ? edge_at(detected[d].u) : Edge{within, Floats{}};
      outside *= 1.0f - detected[d].edge.fraction;
      sum += detected[d].edge.fraction;
    }
    return adds ? (sum > maximum ? Floats{} + maximum : sum) : 1.0f - outside;
  }

  /// Derivatives of the pixels' levels by all parameters.
  HWY_INLINE void slopes(const Detected* detected, Floats fraction, Floats* slope) const {
    for (int a = kDiscsBlur; a < n; ++a) slope[a] = Floats{};
    slope[kDiscsContrast] = fraction;
    slope[kDiscsBackground] = Floats{} + 1.0f;
    for (int d = 0; d < discs; ++d) {
      Floats others = Floats{} + 1.0f;
      for (int other = 0; other < discs; ++other) others *= other == d ? Floats{} + 1.0f : 1.0f - detected[other].edge.fraction;
      if (adds) others = fraction < maximum ? Floats{} + 1.0f : Floats{};
      const Floats outwards = contrast * inverse_blur * detected[d].edge.density * others;
      const Floats by_x = outwards / detected[d].distance * detected[d].away_x,
                   by_y = outwards / detected[d].distance * detected[d].away_y;
      slope[kFirstDisc + 3 * d] = by_x;
      slope[kFirstDisc + 3 * d + 1] = by_y;
      slope[kFirstDisc + 3 * d + 2] = outwards;
      slope[kDiscsBlur] += outwards * detected[d].u;
      if (!swept) continue;
      slope[n - 2] += detected[d].along * by_x;
      slope[n - 1] += detected[d].along * by_y;
    }
  }
};

/// Eight pixels that lie beyond every edge inform about contrast and background alone.
template <int discs, bool swept>
void linearise_many(const MarkerSamples& samples, const DiscsAt& at, DiscsSums& result) {
  const Discs<discs, swept> model{.p = at.parameters, .adds = at.adds, .maximum = at.maximum};
  constexpr int n = Discs<discs, swept>::n;
  Floats information[n * (n + 1) / 2] = {}, gradient[n] = {}, squares = {};
  for (int i = 0; i < samples.count; i += 8) {
    const Floats x = load(samples.x + i), y = load(samples.y + i), weight = load(samples.weight + i);
    Detected detected[discs];
    Integers felt = {};
    for (int d = 0; d < discs; ++d) felt |= model.observe_frame(d, x, y, detected[d]);
    const bool edges = any(felt);
    const Floats fraction = model.fraction(detected, edges);
    const Floats residual = load(samples.value + i) - model.background - model.contrast * fraction;
    squares += weight * residual * residual;
    if (!edges) {
      information[0] += weight * fraction * fraction;
      information[1] += weight * fraction;
      information[n] += weight;
      gradient[0] += weight * fraction * residual;
      gradient[1] += weight * residual;
      continue;
    }
    Floats slope[n];
    model.slopes(detected, fraction, slope);
    int k = 0;
    for (int a = 0; a < n; ++a) {
      const Floats weighted = weight * slope[a];
      for (int b = a; b < n; ++b) information[k++] += weighted * slope[b];
      gradient[a] += weighted * residual;
    }
  }
  for (int k = 0; k < n * (n + 1) / 2; ++k) result.information[k] = sum_of(information[k]);
  for (int a = 0; a < n; ++a) result.gradient[a] = sum_of(gradient[a]);
  result.squares = sum_of(squares);
}

void linearise_discs(const MarkerSamples& samples, const DiscsAt& at, DiscsSums& sums) {
  switch (at.discs) {
    case 1:
      return at.swept ? linearise_many<1, true>(samples, at, sums) : linearise_many<1, false>(samples, at, sums);
    case 2:
      return at.swept ? linearise_many<2, true>(samples, at, sums) : linearise_many<2, false>(samples, at, sums);
    case 3:
      return linearise_many<3, false>(samples, at, sums);
    default:
      return linearise_many<4, false>(samples, at, sums);
  }
}

const MarkerKernels& kernels() {
  static constexpr MarkerKernels all{scan<std::uint8_t>, scan<std::uint16_t>, linearise_disc, linearise_discs};
  return all;
}

}  // namespace
}  // namespace marey::detect::markers::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace marey::detect::markers {

HWY_EXPORT(kernels);

const MarkerKernels& marker_kernels() {
  return HWY_DYNAMIC_DISPATCH(kernels)();
}

}  // namespace marey::detect::markers
#endif
