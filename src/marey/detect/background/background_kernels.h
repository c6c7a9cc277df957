#pragma once

#include <cstdint>

namespace marey::detect::background {

/// The inner loops of the adaptive background model, over rows of pixels. Each is compiled for several levels of the
/// processor, to the same results. A scene's mean is held in 1/128 level, its spread in 1/8 level.
struct BackgroundKernels {
  /// excess[x] = how far pixels[x] lies outside [low[x], high[x]].
  /// mark[x] = 0 inside, 1 outside, 1 + 16 where the excess is half the width of the band or more.
  void (*classify)(const std::uint8_t* pixels, const std::uint8_t* low, const std::uint8_t* high, int width, std::uint8_t* mark);

  /// The same for two half-size rows; each mark is written twice, for the two pixels it covers. `width` counts half-size pixels.
  void (*classify_chroma)(const std::uint8_t* const pixels[2], const std::uint8_t* const low[2], const std::uint8_t* const high[2],
                          int width, std::uint8_t* mark);

  /// target[x] |= source[x].
  void (*unite)(const std::uint8_t* source, int width, std::uint8_t* target);

  /// Of three rows of marks, each with a zero before its first and after its last: vote[x] is 0 where fewer than `quorum` of the
  /// 3 × 3 round x are marked; else 1, with 2 added where the mark of x is strong, and 4 where all of the round are marked.
  void (*vote)(const std::uint8_t* const rows[3], int quorum, int width, std::uint8_t* vote);

  /// Moves mean towards pixels by 2^-shift of the distance (at most kBoundedStep levels of it), and spread towards the distance
  /// that one pixel in four exceeds, except where frozen[x] is not zero.
  void (*learn)(const std::uint8_t* pixels, const std::uint8_t* frozen, int width, int shift, std::int16_t* mean,
                std::uint8_t* spread);

  /// The band of levels that belong to the scene: round the mean, wider by the noise (`gate` / 16 spreads, at least `floor`
  /// levels), and half-way to the lowest and the highest mean of the 3 × 3 pixels, so that an edge may move by half a pixel. `rows`
  /// are the rows above, at and below; they are not read beyond their width. `gate` is at most 128, `floor` at most 64.
  void (*band)(const std::int16_t* const rows[3], const std::uint8_t* spread, int width, int gate, int floor, std::uint8_t* low,
               std::uint8_t* high);

  /// Sorts, for each x, the 2^log2_count values rows[i][x], rows being `stride` apart. `width` is a multiple of 32.
  void (*sort)(std::uint8_t* rows, int log2_count, int stride, int width);

  /// Of values sorted by `sort`: the middle of the shortest interval that holds half of them, and the spread that `learn` would
  /// find in Gaussian noise of which half lies in an interval as long.
  void (*shortest_half)(const std::uint8_t* rows, int count, int stride, int width, std::uint8_t* middle, std::uint8_t* spread);
};

/// The fastest that this machine runs.
const BackgroundKernels& background_kernels();

}  // namespace marey::detect::background
