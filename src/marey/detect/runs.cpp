#include "marey/detect/runs.h"

#include <cstring>

namespace marey {

void append_runs(const std::uint8_t* pixels, int row, int width, std::vector<PixelRun>& runs) {
  for (int x = 0; x < width;) {
    std::uint64_t many[4] = {};
    if (x + 32 <= width) {
      std::memcpy(many, pixels + x, sizeof many);
      if ((many[0] | many[1] | many[2] | many[3]) == 0) {
        x += 32;
        continue;
      }
    }
    std::uint64_t eight = 0;
    if (x + 8 <= width) {
      std::memcpy(&eight, pixels + x, sizeof eight);
      if (eight == 0) {
        x += 8;
        continue;
      }
    }
    if (pixels[x] == 0) {
      ++x;
      continue;
    }
    const int begin = x;
    while (x < width && pixels[x] != 0) ++x;
    runs.push_back({row, begin, x});
  }
}

/// Joins every two runs of neighbouring rows that overlap when one is widened by `reach` columns: 0 joins by edges, 1 by corners
/// too.
void join_neighbours(std::span<const PixelRun> runs, int reach, Forest& forest) {
  std::size_t above = 0;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const PixelRun& run = runs[i];
    while (runs[above].row < run.row - 1 || (runs[above].row == run.row - 1 && runs[above].end + reach <= run.begin)) ++above;
    for (std::size_t j = above; runs[j].row == run.row - 1 && runs[j].begin < run.end + reach; ++j) {
      forest.join(static_cast<int>(j), static_cast<int>(i));
    }
  }
}

}  // namespace marey
