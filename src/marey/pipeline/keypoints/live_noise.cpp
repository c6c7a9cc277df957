#include "marey/pipeline/keypoints/live_noise.h"

#include <algorithm>
#include <cmath>

namespace marey::pipeline::keypoints {
namespace {

constexpr std::size_t kBlock = 1000;  // points, numerical: enough for a median
constexpr int kMaxBlocks = 10;        // numerical: then the median is known
// Numerical: never above the start, so that a rig that does not fit cannot widen the gates by its own errors.
constexpr double kMinNoise = 0.5, kMaxNoise = 2.6;
constexpr double kMedianOfMean = 0.9;  // by definition: the median of a sum of squares is a little below its mean

}  // namespace

void LiveNoise::learn(std::span<const reconstruct::keypoints::LocatedPerson> people, double slack) {
  if (blocks_ >= kMaxBlocks) return;
  for (const auto& person : people) {
    for (const auto& point : person.points) {
      if (point) squares_.push_back(point->chi_square / (2 * point->rays - 3));
    }
  }
  if (squares_.size() < kBlock) return;
  const auto middle = squares_.begin() + std::ssize(squares_) / 2;
  std::nth_element(squares_.begin(), middle, squares_.end());
  noise_ = std::clamp(slack * noise_ * std::sqrt(*middle / kMedianOfMean), kMinNoise, kMaxNoise);
  squares_.clear();
  ++blocks_;
}

}  // namespace marey::pipeline::keypoints
