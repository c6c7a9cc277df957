#include "marey/pipeline/people/picture_doubts.h"

#include <algorithm>
#include <cmath>
#include <map>

#include <fmt/format.h>

#include "marey/geometry/median.h"
#include "marey/pipeline/corridor/feed.h"

namespace marey::pipeline::people {
namespace {

constexpr int kManyInOne = 6;                // boxes in one region
constexpr double kOften = 0.05;              // of the frames
constexpr double kMostOfIt = 0.5;            // of the picture, at once
constexpr double kLeastForeground = 0.0005;  // of the picture, in which nothing is told
constexpr std::size_t kFewestKept = 10;      // frames
constexpr double kHardlyKept = 0.1;          // share of the foreground: a walker keeps half of it at 5 pictures a second

}  // namespace

void PictureDoubts::add(const detect::Detections& seen) {
  ++frames_;
  std::map<int, int> shared;
  for (const Detection& one : seen.detections) {
    if (one.group) ++shared[*one.group];
  }
  int most = 0;
  for (const auto& [group, count] : shared) most = std::max(most, count);
  most_in_one_ = std::max(most_in_one_, most);
  if (most >= kManyInOne) ++crowded_;
  look_at_foreground(seen);
}

void PictureDoubts::look_at_foreground(const detect::Detections& seen) {
  const cv::Mat& mask = seen.foreground.mask;
  if (mask.empty()) return;
  const double marked = cv::countNonZero(mask), all = static_cast<double>(mask.total());
  if (marked > kMostOfIt * all) ++covered_;
  if (before_.size() == mask.size() && marked > kLeastForeground * all) {
    cv::Mat both;
    cv::bitwise_and(mask, before_, both);
    kept_.push_back(static_cast<float>(cv::countNonZero(both) / marked));
  }
  mask.copyTo(before_);
}

std::vector<std::string> PictureDoubts::warnings() const {
  std::vector<std::string> all = view_.warnings();
  const auto of_view = std::ssize(all);
  const auto often = [&](std::int64_t count) { return static_cast<double>(count) > kOften * static_cast<double>(frames_); };
  const auto percent = [&](std::int64_t count) { return 100 * static_cast<double>(count) / static_cast<double>(frames_); };
  if (often(covered_))
    all.push_back(
        fmt::format("more than half of the picture changes at once (in {:.0f} % of the frames): the light changes, something is "
                    "before the lens, "
                    "or no camera that stands took it",
                    percent(covered_)));
  if (often(crowded_))
    all.push_back(fmt::format(
        "up to {} boxes share one region of what moves (in {:.0f} % of the frames six or more do): a crowd that only the size of a "
        "person divides, or one person near the camera, a vehicle or light that was taken for one",
        most_in_one_, percent(crowded_)));
  if (kept_.size() >= kFewestKept) {
    std::vector<float> kept = kept_;
    const auto middle = geometry::median(kept);
    if (middle < kHardlyKept)
      all.push_back(
          fmt::format("what moves has left its place in the next picture ({:.0f} % of it is still there): either the pictures are "
                      "too far apart in time to track anyone (a time lapse), or what moves is rain, snow or noise",
                      100.0 * middle));
  }
  for (auto one = all.begin() + of_view; one != all.end(); ++one) *one = corridor::said_of(camera_, *one);
  return all;
}

}  // namespace marey::pipeline::people
