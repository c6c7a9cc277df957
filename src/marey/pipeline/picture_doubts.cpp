#include "marey/pipeline/picture_doubts.h"

#include <algorithm>
#include <cmath>
#include <map>

#include <fmt/format.h>

#include "marey/pipeline/feed.h"
#include "marey/pipeline/steady_camera.h"

namespace marey::pipeline {
namespace {

constexpr std::size_t kCutsNamed = 5;
constexpr double kScrolls = 0.04;            // of the pictures looked at
constexpr int kManyInOne = 6;                // boxes in one region
constexpr double kOften = 0.05;              // of the frames
constexpr double kMostOfIt = 0.5;            // of the picture, at once
constexpr double kLeastForeground = 0.0005;  // of the picture, in which nothing is told
constexpr std::size_t kFewestKept = 10;      // frames
constexpr double kHardlyKept = 0.1;          // share of the foreground: a walker keeps half of it at 5 pictures a second

std::string moments(const std::vector<double>& cuts) {
  std::string text;
  for (std::size_t i = 0; i < std::min(cuts.size(), kCutsNamed); ++i) text += fmt::format("{}{:.1f}", i == 0 ? "" : ", ", cuts[i]);
  text += " s";
  if (cuts.size() > kCutsNamed) text += fmt::format(" and {} times more", cuts.size() - kCutsNamed);
  return text;
}

std::string said_of_turn(const source::steady::ViewReport::Turn& turn, bool steadied) {
  std::string what;
  if (turn.share >= 0.05)
    what = fmt::format("{} by {:.0f} % of the picture's width", turn.stays ? "was turned" : "pans or tilts,", 100 * turn.share);
  if (std::abs(std::log(turn.zoom)) >= 0.05)
    what += fmt::format("{}{} {:.2f} times", what.empty() ? "" : ", and ", turn.stays ? "zoomed" : "zooms", turn.zoom);
  if (turn.stays)
    return fmt::format("the camera {} at about {:.1f} s: until the new view was learned, what stands was taken for people; {}",
                       what, turn.from_s,
                       steadied ? "track what comes before and after it separately"
                                : "--steady brings its pictures to where it stood most of the time");
  return fmt::format(
      "the camera {} between {:.1f} and {:.1f} s: people cannot be told from a scene that moves; of a pitch, marey calibrate "
      "turning "
      "finds out where it looked, and a detection network finds the people (docs/turning.md)",
      what, turn.from_s, turn.to_s);
}

}  // namespace

std::vector<std::string> said_of_view(const source::steady::ViewReport& report, const std::optional<std::string>& shaking,
                                      bool steadied) {
  std::vector<std::string> all;
  if (!report.cuts.empty())
    all.push_back(fmt::format(
        "the video is cut at {}: each time the scene is another, and people before it are not found again after it; track "
        "each piece by itself",
        moments(report.cuts)));
  if (report.scrolling > kScrolls) {
    all.push_back(fmt::format(
        "a part of the picture moves up or down as one while the rest stands (in {:.0f} % of the pictures), as on a screen that "
        "is scrolled: marey track wants pictures of a camera that stands",
        100 * report.scrolling));
  } else if (report.turn) {
    all.push_back(said_of_turn(*report.turn, steadied));
  }
  if (!all.empty() || steadied) return all;
  if (shaking) {
    all.push_back(*shaking);
  } else if (report.shake_px >= kShakes) {
    all.push_back(said_of_shaking(report.shake_px));
  }
  return all;
}

void PictureDoubts::add(const Frame& frame, const detect::Detections& seen) {
  view_.add(frame);
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

std::vector<std::string> PictureDoubts::warnings(const RigCamera& camera, const std::optional<std::string>& shaking,
                                                 bool steadied) const {
  std::vector<std::string> all = said_of_view(view_.report(), shaking, steadied);
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
    const auto middle = kept.begin() + std::ssize(kept) / 2;
    std::nth_element(kept.begin(), middle, kept.end());
    if (*middle < kHardlyKept)
      all.push_back(
          fmt::format("what moves has left its place in the next picture ({:.0f} % of it is still there): either the pictures are "
                      "too far apart in time to track anyone (a time lapse), or what moves is rain, snow or noise",
                      100.0 * *middle));
  }
  for (std::string& one : all) one = said_of(camera, one);
  return all;
}

}  // namespace marey::pipeline
