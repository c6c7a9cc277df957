#include "marey/pipeline/people/view_doubts.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "marey/pipeline/corridor/feed.h"
#include "marey/pipeline/corridor/steady_camera.h"

namespace marey::pipeline::people {
namespace {

constexpr std::size_t kCutsNamed = 5;
constexpr double kScrolls = 0.04;  // of the pictures looked at
constexpr double kLookMore = 1.1;  // times as many pictures as at the last look: all of them are gone through each time

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

std::string said_of_scrolling(double share) {
  return fmt::format(
      "a part of the picture moves up or down as one while the rest stands (in {:.0f} % of the pictures), as on a screen that "
      "is scrolled: marey track wants pictures of a camera that stands",
      100 * share);
}

std::vector<std::string> said_of_view(const source::steady::ViewReport& report, const std::optional<std::string>& shaking,
                                      bool steadied) {
  std::vector<std::string> all;
  if (!report.cuts.empty())
    all.push_back(fmt::format(
        "the video is cut at {}: each time the scene is another, and people before it are not found again after it; track "
        "each piece by itself",
        moments(report.cuts)));
  if (report.scrolling > kScrolls) {
    all.push_back(said_of_scrolling(report.scrolling));
  } else if (report.turn) {
    all.push_back(said_of_turn(*report.turn, steadied));
  }
  if (!all.empty() || steadied) return all;
  if (shaking) {
    all.push_back(*shaking);
  } else if (report.shake_px >= corridor::kShakes) {
    all.push_back(corridor::shaking_warning(report.shake_px));
  }
  return all;
}

}  // namespace

void ViewDoubts::look_at_beginning(std::span<const Frame> samples) {
  if (!steadied_) shaking_ = corridor::shaking(samples);
}

std::vector<std::string> ViewDoubts::news() {
  std::vector<std::string> all;
  const auto tell = [&](bool& told, const std::string& sentence) {
    if (!std::exchange(told, true)) all.push_back(corridor::said_of(camera_, sentence));
  };
  if (shaking_) tell(shaking_told_, *shaking_);
  if (!view_.cuts().empty())
    tell(cut_told_, fmt::format("the video is cut at {:.1f} s: the scene is another from there on; all cuts are named at the end",
                                view_.cuts().front()));
  if (view_.looked_at() < next_look_ || moved_told_) return all;
  next_look_ = 1 + static_cast<std::int64_t>(kLookMore * static_cast<double>(view_.looked_at()));
  const source::steady::ViewReport report = view_.report();
  if (report.scrolling > kScrolls) {
    tell(moved_told_, said_of_scrolling(report.scrolling));
  } else if (report.turn) {
    tell(moved_told_,
         fmt::format("the camera pans, tilts or zooms, or was turned, from {:.1f} s on: what stands is taken for people "
                     "then; how far it went is told at the end",
                     report.turn->from_s));
  } else if (!steadied_ && report.shake_px >= corridor::kShakes && report.cuts.empty()) {
    tell(shaking_told_, corridor::shaking_warning(report.shake_px));
  }
  return all;
}

std::vector<std::string> ViewDoubts::warnings() const {
  std::vector<std::string> all = said_of_view(view_.report(), shaking_, steadied_);
  for (std::string& one : all) one = corridor::said_of(camera_, one);
  return all;
}

}  // namespace marey::pipeline::people
