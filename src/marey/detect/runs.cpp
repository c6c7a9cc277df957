#include "marey/detect/runs.h"

#include <bit>
#include <cstring>

namespace marey::detect {

namespace {

/// The first x in [from, width) where `(pixels[x] != 0) == filled`, else `width`. Eight pixels at a time, the first in the lowest
/// byte.
int find(const std::uint8_t* pixels, int from, int width, bool filled) {
  constexpr std::uint64_t kOnes = 0x0101010101010101, kHighs = 0x8080808080808080;
  int x = from;
  for (; x + 8 <= width; x += 8) {
    std::uint64_t eight = 0;
    std::memcpy(&eight, pixels + x, sizeof eight);
    // The lowest bit that is set lies in the first such byte; above it an empty byte may be mistaken, which does not matter.
    const std::uint64_t hits = filled ? eight : (eight - kOnes) & ~eight & kHighs;
    if (hits != 0) return x + std::countr_zero(hits) / 8;
  }
  while (x < width && (pixels[x] != 0) != filled) ++x;
  return x;
}

/// Skips empty pixels, 64 at a time.
int skip_empty(const std::uint8_t* pixels, int from, int width) {
  int x = from;
  for (; x + 64 <= width; x += 64) {
    std::uint64_t many[8];
    std::memcpy(many, pixels + x, sizeof many);
    if ((many[0] | many[1] | many[2] | many[3] | many[4] | many[5] | many[6] | many[7]) != 0) break;
  }
  return x;
}

}  // namespace

void append_runs(const std::uint8_t* pixels, int row, int width, std::vector<PixelRun>& runs) {
  for (int x = 0; x < width;) {
    const int begin = find(pixels, skip_empty(pixels, x, width), width, true);
    if (begin == width) return;
    x = find(pixels, begin, width, false);
    runs.push_back({row, begin, x});
  }
}

void join_neighbours(std::span<const PixelRun> runs, int reach, assign::DisjointSets& sets) {
  std::size_t above = 0;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const PixelRun& run = runs[i];
    while (runs[above].row < run.row - 1 || (runs[above].row == run.row - 1 && runs[above].end + reach <= run.begin)) ++above;
    for (std::size_t j = above; runs[j].row == run.row - 1 && runs[j].begin < run.end + reach; ++j) {
      sets.join(static_cast<int>(j), static_cast<int>(i));
    }
  }
}

}  // namespace marey::detect
