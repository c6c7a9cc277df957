#pragma once

#include <cstddef>
#include <cstdint>

namespace marey::detect::markers {

/// 64 neighbouring pixels of one row of which some pass the threshold.
struct MarkerHit {
  std::int32_t row = 0;    ///< within the band
  std::int32_t word = 0;   ///< pixels 64 · word … 64 · word + 63
  std::uint64_t bits = 0;  ///< bit i is pixel 64 · word + i; never 0
};

/// The rows of a band of an image, and what each of its words of 64 pixels must pass.
struct MarkerBand {
  const void* pixels = nullptr;  ///< first pixel of the band's first row
  std::size_t stride = 0;        ///< bytes from row to row
  int rows = 0;
  int width = 0;                              ///< px
  const std::uint16_t* thresholds = nullptr;  ///< one a word; a pixel passes above it, or below it where `dark`
  bool dark = false;
};

/// Pixels round a marker, in units of the marker's rough contrast, for the fit. `count` is a multiple of 8: the rest has weight 0.
struct MarkerSamples {
  const float* x = nullptr;
  const float* y = nullptr;
  const float* value = nullptr;
  const float* weight = nullptr;
  int count = 0;
};

/// Parameters of a disc, in this order everywhere: x, y, radius, blur, contrast, background.
inline constexpr int kDiscParameters = 6;

/// Weighted sums over the pixels: the upper triangle of JᵀJ row by row (21), then Jᵀr (6), then r² (1), with r = value − model.
struct DiscSums {
  float sum[28];
};

inline constexpr int kMaxDiscs = 4;
/// Parameters of several discs, in this order everywhere: these three, then x, y, radius of each disc, then half of the path that
/// all of them went, if they did.
enum { kDiscsContrast, kDiscsBackground, kDiscsBlur, kFirstDisc };
inline constexpr int kMaxParameters = kFirstDisc + 3 * kMaxDiscs + 2;

/// One to four discs. Where they hide each other a pixel's share is 1 − Π (1 − sᵢ); where their light adds up it is Σ sᵢ, at most
/// `most`, as far as the sensor goes. A disc that moved while it was seen is as near as its segment.
struct DiscsAt {
  const float* parameters = nullptr;
  int discs = 1;
  bool swept = false;  ///< one or two discs only
  bool adds = false;
  float maximum = 0;
};

/// The same sums as DiscSums for this many parameters as there are: the upper triangle of JᵀJ row by row, Jᵀr, r².
struct DiscsSums {
  float information[kMaxParameters * (kMaxParameters + 1) / 2];
  float gradient[kMaxParameters];
  float squares;
};

/// The loops that most of the time goes to, compiled for one level of the processor. Every level gives the same bits.
struct MarkerKernels {
  /// Writes the hits of a band, row by row, left to right, and returns how many; `hits` has room for every word of the band.
  int (*scan_8)(const MarkerBand& band, MarkerHit* hits);
  int (*scan_16)(const MarkerBand& band, MarkerHit* hits);
  /// The disc model background + contrast · Φ((radius − d) / blur), with d² = dx² + dy² + 1/12, linearised at `parameters`.
  DiscSums (*linearise_disc)(const MarkerSamples& samples, const float* parameters);
  /// The same of several discs.
  void (*linearise_discs)(const MarkerSamples& samples, const DiscsAt& at, DiscsSums& sums);
};

/// The fastest that this machine runs.
const MarkerKernels& marker_kernels();

}  // namespace marey::detect::markers
