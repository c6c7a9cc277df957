#include "marey/detect/background/difference_sums.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <vector>

namespace marey::detect::background {
namespace {

constexpr int kMaxSum = 9 * 255;        // by definition: of nine pixels of 8 bits
constexpr int kSums = 2 * kMaxSum + 1;  // by definition
constexpr int kLanes = 4;  // of counts: neighbours are alike, and one count could not be raised twice in a row at speed

/// A sum's mean in levels, as cv::blur rounds it.
float level_of_sum(int sum) {
  return static_cast<float>(sum * (1.0 / 9));
}

float distance_of_sum(int sum, double shade) {
  return static_cast<float>(std::abs(level_of_sum(sum) - shade));
}

/// The differences of one row, added to `sums`.
void add_difference(const std::uint8_t* now, const std::uint8_t* scene, int width, std::int16_t* sums) {
  for (int x = 0; x < width; ++x) sums[x] = static_cast<std::int16_t>(sums[x] + now[x] - scene[x]);
}

/// Sets what is below `lowest` or above `highest` to 255.
void mark_beyond(const std::int16_t* __restrict sums, int width, int lowest, int highest, std::uint8_t* __restrict marked) {
  const auto first = static_cast<std::uint16_t>(lowest), range = static_cast<std::uint16_t>(highest - lowest);
  for (int x = 0; x < width; ++x) {
    const auto above = static_cast<std::uint16_t>(static_cast<std::uint16_t>(sums[x]) - first);
    marked[x] = static_cast<std::uint8_t>(marked[x] | (above > range ? 255 : 0));
  }
}

/// How often each sum occurs.
class SumCounts {
 public:
  SumCounts() : counts_(static_cast<std::size_t>(kLanes) * kSums, 0) {}

  void add(const std::int16_t* sums, int begin, int end) {
    int x = begin;
    for (; x + kLanes <= end; x += kLanes) {
      for (int lane = 0; lane < kLanes; ++lane) ++of(lane, sums[x + lane]);
    }
    for (; x < end; ++x) ++of(0, sums[x]);
  }

  int of_sum(int sum) {
    int count = 0;
    for (int lane = 0; lane < kLanes; ++lane) count += of(lane, sum);
    return count;
  }

 private:
  int& of(int lane, int sum) { return counts_[static_cast<std::size_t>(lane * kSums + sum + kMaxSum)]; }
  std::vector<int> counts_;
};

/// The value of rank `rank` among the distances from `shade`, which is the level of the sum `middle`: from there outwards, nearest
/// first.
double ranked_distance(SumCounts& counts, int middle, double shade, int rank) {
  int below = middle, above = middle + 1, passed = 0;
  while (true) {
    const bool down = above > kMaxSum || (below >= -kMaxSum && distance_of_sum(below, shade) <= distance_of_sum(above, shade));
    const int next = down ? below-- : above++;
    passed += counts.of_sum(next);
    if (passed > rank) return distance_of_sum(next, shade);
  }
}

}  // namespace

DifferenceSums::DifferenceSums(const cv::Mat& scene, const cv::Mat& now) : sums_(scene.size(), CV_16SC1) {
  const int width = scene.cols, height = scene.rows;
  std::vector<std::int16_t> column(static_cast<std::size_t>(width) + 2);
  std::int16_t* const inner = column.data() + 1;
  for (int y = 0; y < height; ++y) {
    std::fill(column.begin(), column.end(), std::int16_t{0});
    for (int row = y - 1; row <= y + 1; ++row) {
      const int at = cv::borderInterpolate(row, height, cv::BORDER_REFLECT_101);
      add_difference(now.ptr<std::uint8_t>(at), scene.ptr<std::uint8_t>(at), width, inner);
    }
    inner[-1] = inner[cv::borderInterpolate(-1, width, cv::BORDER_REFLECT_101)];
    inner[width] = inner[cv::borderInterpolate(width, width, cv::BORDER_REFLECT_101)];
    auto* sums = sums_.ptr<std::int16_t>(y);
    for (int x = 0; x < width; ++x) sums[x] = static_cast<std::int16_t>(inner[x - 1] + inner[x] + inner[x + 1]);
  }
}

DifferenceSums::Noise DifferenceSums::noise_outside(const cv::Rect& body) const {
  SumCounts counts;
  for (int y = 0; y < sums_.rows; ++y) {
    const auto* sums = sums_.ptr<std::int16_t>(y);
    const bool outside = y < body.y || y >= body.br().y || body.empty();
    counts.add(sums, 0, outside ? sums_.cols : body.x);
    if (!outside) counts.add(sums, body.br().x, sums_.cols);
  }
  const int total = static_cast<int>(sums_.total()) - body.area();
  if (total == 0) return {};
  int middle = -kMaxSum - 1;
  for (int passed = 0; passed <= total / 2;) passed += counts.of_sum(++middle);
  const double shade = level_of_sum(middle);
  return {shade, ranked_distance(counts, middle, shade, total / 2)};
}

void DifferenceSums::mark(double shade, double minimum, cv::Mat& mask) const {
  // In the precision of the smoothed image, CV_32F.
  const auto is_far = [&](int sum) {
    return std::abs(level_of_sum(sum) - static_cast<float>(shade)) > static_cast<float>(minimum);
  };
  int lowest = static_cast<int>(std::lround(9 * shade)), highest = lowest;  // of those that are near
  while (lowest > -kMaxSum && !is_far(lowest - 1)) --lowest;
  while (highest < kMaxSum && !is_far(highest + 1)) ++highest;
  for (int y = 0; y < sums_.rows; ++y)
    mark_beyond(sums_.ptr<std::int16_t>(y), sums_.cols, lowest, highest, mask.ptr<std::uint8_t>(y));
}

}  // namespace marey::detect::background
