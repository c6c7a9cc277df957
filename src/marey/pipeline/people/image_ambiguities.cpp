#include "marey/pipeline/people/image_ambiguities.h"

#include <algorithm>
#include <cmath>
#include <map>

#include <fmt/format.h>

#include "marey/geometry/median.h"
#include "marey/pipeline/corridor/feed.h"

namespace marey::pipeline::people {
namespace {

constexpr int kManyInOne = 6;              // boxes in one region
constexpr double kOften = 0.05;            // of the frames
constexpr double kMajorityFraction = 0.5;  // of the image, at once
constexpr double kMinForeground = 0.0005;  // of the image, in which nothing is reported
constexpr std::size_t kMinKept = 10;       // frames
constexpr double kMinKeptFraction = 0.1;   // share of the foreground: a walker keeps half of it at 5 images a second

}  // namespace

void ImageAmbiguities::add(const detect::Detections& detected) {
  ++frames_;
  std::map<int, int> shared;
  for (const Detection& one : detected.detections) {
    if (one.group) ++shared[*one.group];
  }
  int maximum = 0;
  for (const auto& [group, count] : shared) maximum = std::max(maximum, count);
  max_in_one_ = std::max(max_in_one_, maximum);
  if (maximum >= kManyInOne) ++crowded_;
  inspect_at_foreground(detected);
}

void ImageAmbiguities::inspect_at_foreground(const detect::Detections& detected) {
  const cv::Mat& mask = detected.foreground.mask;
  if (mask.empty()) return;
  const double marked = cv::countNonZero(mask), all = static_cast<double>(mask.total());
  if (marked > kMajorityFraction * all) ++covered_;
  if (before_.size() == mask.size() && marked > kMinForeground * all) {
    cv::Mat both;
    cv::bitwise_and(mask, before_, both);
    kept_.push_back(static_cast<float>(cv::countNonZero(both) / marked));
  }
  mask.copyTo(before_);
}

std::vector<std::string> ImageAmbiguities::warnings() const {
  std::vector<std::string> all = view_.warnings();
  const auto of_view = std::ssize(all);
  const auto often = [&](std::int64_t count) { return static_cast<double>(count) > kOften * static_cast<double>(frames_); };
  const auto percent = [&](std::int64_t count) { return 100 * static_cast<double>(count) / static_cast<double>(frames_); };
  if (often(covered_))
    all.push_back(
        fmt::format("more than half of the image changes at once (in {:.0f} % of the frames): the light changes, something is "
                    "before the lens, "
                    "or no static camera took it",
                    percent(covered_)));
  if (often(crowded_))
    all.push_back(fmt::format(
        "up to {} boxes share one region of what moves (in {:.0f} % of the frames six or more do): a crowd that only the size of a "
        "person divides, or one person near the camera, a vehicle or light that was taken for one",
        max_in_one_, percent(crowded_)));
  if (kept_.size() >= kMinKept) {
    std::vector<float> kept = kept_;
    const auto middle = geometry::median(kept);
    if (middle < kMinKeptFraction)
      all.push_back(
          fmt::format("what moves has left its place in the next image ({:.0f} % of it is still there): either the images are "
                      "too far apart in time to track any person (a time lapse), or what moves is rain, snow or noise",
                      100.0 * middle));
  }
  for (auto one = all.begin() + of_view; one != all.end(); ++one) *one = corridor::stated_of(camera_, *one);
  return all;
}

}  // namespace marey::pipeline::people
