#include "marey/detect/background/background_frozen.h"

#include <algorithm>
#include <cmath>

namespace marey::detect::background {
namespace {

constexpr int kFringe = 3;  // px round a region that are not learned: its blurred rim

}  // namespace

void mark_held(std::span<const Box> held, int top, int bottom, int width, std::vector<std::uint8_t>& row) {
  for (const Box& box : held) {
    if (box.top > bottom || box.bottom() <= top) continue;
    const int begin = static_cast<int>(std::clamp(std::floor(box.left), 0.0, static_cast<double>(width)));
    const int end = static_cast<int>(std::clamp(std::ceil(box.right()), 0.0, static_cast<double>(width)));
    if (begin < end) std::fill(row.begin() + begin, row.begin() + end, std::uint8_t{1});
  }
}

void mark_frozen(const ForegroundRegions& regions, std::span<const Box> held, int top, int bottom, cv::Size size,
                 std::vector<std::uint8_t>& row) {
  std::fill(row.begin(), row.end(), std::uint8_t{0});
  const int above = std::max(0, top - kFringe);
  const int below = std::min(size.height, bottom + kFringe + 1);
  for (std::size_t i = regions.begin_of(above); i < regions.begin_of(below); ++i) {
    const int begin = std::max(0, regions.runs()[i].begin - kFringe);
    const int end = std::min(size.width, regions.runs()[i].end + kFringe);
    std::fill(row.begin() + begin, row.begin() + end, std::uint8_t{1});
  }
  mark_held(held, top, bottom, size.width, row);
}

}  // namespace marey::detect::background
