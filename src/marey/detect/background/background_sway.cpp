// Of each block of the scene the sharpest upright and the sharpest level edge are searched for again in the image: the sum over
// them of how much the step of light across each differs, cut off so that what people hide counts no more than that. A step of
// light, unlike light, barely changes with exposure. From no shift and from the last one the sum is followed downhill pixel by
// pixel; where it stays high, whole neighbourhoods are tried. Cost: a few thousand reads a frame, whatever its size.
#include "marey/detect/background/background_sway.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>

namespace marey::detect::background {
namespace {

constexpr int kMaxEdges = 400;
constexpr int kMinEdges = 24;
constexpr int kMinStep = 24;         // levels
constexpr int kReach = 2;            // px from side to side of an edge
constexpr int kMaxDistance = 24;     // px, of a shift
constexpr int kChooseEvery = 64;     // frames
constexpr int kCoarse = 3;           // px: the grid of neighbourhoods
constexpr int kSearched = 18;        // px: how far they reach
constexpr double kWorthwhile = 0.9;  // of the sum without any shift
constexpr double kStill = 0.06;      // of the sum if no edge were found at all: nothing to explain
constexpr double kLost = 0.5;        // of the sum if no edge were found at all

}  // namespace

void SwayMeter::begin() {
  *this = {};
}

void SwayMeter::choose(const ScenePlane& scene) {
  until_chosen_ = kChooseEvery;
  edges_.clear();
  const cv::Size size = scene.size();
  const int border = kMaxDistance + kReach;
  const int side = std::max(8, static_cast<int>(std::sqrt(2.0 * size.area() / kMaxEdges)));
  for (int top = border; top + side <= size.height - border; top += side) {
    for (int left = border; left + side <= size.width - border; left += side) {
      Edge upright{0, 0, true, 0}, level{0, 0, false, 0};
      for (int y = top; y < top + side; ++y) {
        const std::int16_t *row = scene.mean(y), *above = scene.mean(y - kReach), *below = scene.mean(y + kReach);
        for (int x = left; x < left + side; ++x) {
          const int across = (row[x + kReach] - row[x - kReach]) / 128, down = (below[x] - above[x]) / 128;
          if (std::abs(across) > std::abs(upright.step)) upright = {x, y, true, across};
          if (std::abs(down) > std::abs(level.step)) level = {x, y, false, down};
        }
      }
      for (const Edge& edge : {upright, level}) {
        if (std::abs(edge.step) >= kMinStep) edges_.push_back(edge);
      }
    }
  }
}

int SwayMeter::misfit(const cv::Mat& luma, cv::Point shift) const {
  const auto stride = static_cast<std::ptrdiff_t>(luma.step);
  int sum = 0;
  for (const Edge& edge : edges_) {
    const std::uint8_t* at = luma.ptr<std::uint8_t>(edge.y + shift.y) + edge.x + shift.x;
    const std::ptrdiff_t reach = edge.across ? kReach : kReach * stride;
    sum += std::min(std::abs(at[reach] - at[-reach] - edge.step), std::abs(edge.step));
  }
  return sum;
}

cv::Point SwayMeter::descend(const cv::Mat& luma, cv::Point from) const {
  int minimum = misfit(luma, from);
  for (int step = 0; step < 2 * kMaxDistance; ++step) {
    cv::Point best = from;
    for (const cv::Point by : {cv::Point(1, 0), cv::Point(-1, 0), cv::Point(0, 1), cv::Point(0, -1)}) {
      const cv::Point next = from + by;
      if (std::max(std::abs(next.x), std::abs(next.y)) > kMaxDistance) continue;
      const int one = misfit(luma, next);
      if (one < minimum) {
        minimum = one;
        best = next;
      }
    }
    if (best == from) break;
    from = best;
  }
  return from;
}

cv::Point SwayMeter::measure(const cv::Mat& luma, const ScenePlane& scene) {
  if (--until_chosen_ < 0) choose(scene);
  if (edges_.size() < kMinEdges) return {};
  int maximum = 0;
  for (const Edge& edge : edges_) maximum += std::abs(edge.step);
  const int unmoved = misfit(luma, {});
  if (unmoved < kStill * maximum) return last_ = {};
  cv::Point best = descend(luma, {});
  const auto take = [&](cv::Point from) {
    const cv::Point other = descend(luma, from);
    if (misfit(luma, other) < misfit(luma, best)) best = other;
  };
  if (last_ != cv::Point()) take(last_);
  if (misfit(luma, best) > kLost * maximum) {
    cv::Point start;
    int minimum = misfit(luma, start);
    for (int y = -kSearched; y <= kSearched; y += kCoarse) {
      for (int x = -kSearched; x <= kSearched; x += kCoarse) {
        const int one = misfit(luma, {x, y});
        if (one < minimum) {
          minimum = one;
          start = {x, y};
        }
      }
    }
    take(start);
  }
  last_ = misfit(luma, best) < kWorthwhile * unmoved ? best : cv::Point();
  return last_;
}

namespace {

cv::Mat plane_back(const cv::Mat& plane, cv::Point shift, const ScenePlane& scene) {
  cv::Mat result(plane.size(), CV_8UC1);
  const int first = std::clamp(-shift.x, 0, plane.cols), last = std::clamp(plane.cols - shift.x, 0, plane.cols);
  for (int y = 0; y < plane.rows; ++y) {
    auto* row = result.ptr<std::uint8_t>(y);
    const bool within = y + shift.y >= 0 && y + shift.y < plane.rows && first < last;
    const int begin = within ? first : plane.cols, end = within ? last : plane.cols;
    if (within) std::memcpy(row + begin, plane.ptr<std::uint8_t>(y + shift.y) + begin + shift.x, end - begin);
    for (int x = 0; x < begin; ++x) row[x] = scene.level(y, x);
    for (int x = end; x < plane.cols; ++x) row[x] = scene.level(y, x);
  }
  return result;
}

/// Half the size: an odd shift lies between two pixels.
cv::Mat half_plane_back(const cv::Mat& plane, cv::Point shift, const ScenePlane& scene) {
  const cv::Point low(shift.x >> 1, shift.y >> 1), high((shift.x + 1) >> 1, (shift.y + 1) >> 1);
  cv::Mat result = plane_back(plane, low, scene);
  if (low == high) return result;
  const cv::Mat other = plane_back(plane, high, scene);
  for (int y = 0; y < result.rows; ++y) {
    auto* row = result.ptr<std::uint8_t>(y);
    const auto* second = other.ptr<std::uint8_t>(y);
    for (int x = 0; x < result.cols; ++x) row[x] = static_cast<std::uint8_t>((row[x] + second[x] + 1) / 2);
  }
  return result;
}

}  // namespace

FramePlanes brought_back(const FramePlanes& planes, cv::Point shift, const ScenePlane& luma, const ScenePlane& cb,
                         const ScenePlane& cr) {
  FramePlanes result{plane_back(planes.luma, shift, luma), {}, {}};
  if (planes.cb.empty()) return result;
  result.cb = half_plane_back(planes.cb, shift, cb);
  result.cr = half_plane_back(planes.cr, shift, cr);
  return result;
}

void carry_over(const cv::Mat& mask, cv::Point shift, cv::Mat& result) {
  result = cv::Mat::zeros(mask.size(), mask.type());
  const cv::Rect image({0, 0}, mask.size());
  const cv::Rect to = image & (image + shift);
  if (!to.empty()) mask(to - shift).copyTo(result(to));
}

}  // namespace marey::detect::background
