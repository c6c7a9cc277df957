#include "marey/pipeline/people/view_ambiguities.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "marey/pipeline/corridor/feed.h"
#include "marey/pipeline/corridor/stabilised_camera.h"

namespace marey::pipeline::people {
namespace {

constexpr std::size_t kCutsNamed = 5;
constexpr double kScrolls = 0.04;    // of the images inspected
constexpr double kSearchMore = 1.1;  // times as many images as at the last inspection: all of them are gone through each time

std::string time_steps(const std::vector<double>& cuts) {
  std::string text;
  for (std::size_t i = 0; i < std::min(cuts.size(), kCutsNamed); ++i) text += fmt::format("{}{:.1f}", i == 0 ? "" : ", ", cuts[i]);
  text += " s";
  if (cuts.size() > kCutsNamed) text += fmt::format(" and {} times more", cuts.size() - kCutsNamed);
  return text;
}

std::string stated_of_turn(const source::stabilise::ViewReport::Turn& turn, bool stabilised) {
  std::string what;
  if (turn.fraction >= 0.05)
    what = fmt::format("{} by {:.0f} % of the image's width", turn.stays ? "was turned" : "pans or tilts,", 100 * turn.fraction);
  if (std::abs(std::log(turn.zoom)) >= 0.05)
    what += fmt::format("{}{} {:.2f} times", what.empty() ? "" : ", and ", turn.stays ? "zoomed" : "zooms", turn.zoom);
  if (turn.stays)
    return fmt::format("the camera {} at about {:.1f} s: until the new view was learned, what stands was taken for people; {}",
                       what, turn.from_s,
                       stabilised ? "track what comes before and after it separately"
                                  : "--stabilise brings its images to where it stood most of the time");
  return fmt::format(
      "the camera {} between {:.1f} and {:.1f} s: people cannot be distinguished from a scene that moves; of a pitch, marey "
      "calibrate "
      "ptz "
      "finds out where it looked, and a detection network finds the people (docs/ptz.md)",
      what, turn.from_s, turn.to_s);
}

std::string stated_of_scrolling(double fraction) {
  return fmt::format(
      "a part of the image moves up or down as one while the rest stands (in {:.0f} % of the images), as on a screen that "
      "is scrolled: marey track wants images of a static camera",
      100 * fraction);
}

std::vector<std::string> stated_of_view(const source::stabilise::ViewReport& report, const std::optional<std::string>& shaking,
                                        bool stabilised) {
  std::vector<std::string> all;
  if (!report.cuts.empty())
    all.push_back(fmt::format(
        "the video is cut at {}: each time the scene is another, and people before it are not found again after it; track "
        "each piece by itself",
        time_steps(report.cuts)));
  if (report.scrolling > kScrolls) {
    all.push_back(stated_of_scrolling(report.scrolling));
  } else if (report.turn) {
    all.push_back(stated_of_turn(*report.turn, stabilised));
  }
  if (!all.empty() || stabilised) return all;
  if (shaking) {
    all.push_back(*shaking);
  } else if (report.shake_px >= corridor::kShakes) {
    all.push_back(corridor::shaking_warning(report.shake_px));
  }
  return all;
}

}  // namespace

void ViewAmbiguities::inspect_at_beginning(std::span<const Frame> samples) {
  if (!stabilised_) shaking_ = corridor::shaking(samples);
}

std::vector<std::string> ViewAmbiguities::news() {
  std::vector<std::string> all;
  const auto notify = [&](bool& reported, const std::string& message_text) {
    if (!std::exchange(reported, true)) all.push_back(corridor::stated_of(camera_, message_text));
  };
  if (shaking_) notify(shaking_reported_, *shaking_);
  if (!view_.cuts().empty())
    notify(cut_reported_,
           fmt::format("the video is cut at {:.1f} s: the scene is another from there on; all cuts are named at the end",
                       view_.cuts().front()));
  if (view_.images() < next_search_ || moved_reported_) return all;
  next_search_ = 1 + static_cast<std::int64_t>(kSearchMore * static_cast<double>(view_.images()));
  const source::stabilise::ViewReport report = view_.report();
  if (report.scrolling > kScrolls) {
    notify(moved_reported_, stated_of_scrolling(report.scrolling));
  } else if (report.turn) {
    notify(moved_reported_,
           fmt::format("the camera pans, tilts or zooms, or was turned, from {:.1f} s on: what stands is taken for people "
                       "then; how far it went is reported at the end",
                       report.turn->from_s));
  } else if (!stabilised_ && report.shake_px >= corridor::kShakes && report.cuts.empty()) {
    notify(shaking_reported_, corridor::shaking_warning(report.shake_px));
  }
  return all;
}

std::vector<std::string> ViewAmbiguities::warnings() const {
  std::vector<std::string> all = stated_of_view(view_.report(), shaking_, stabilised_);
  for (std::string& one : all) one = corridor::stated_of(camera_, one);
  return all;
}

}  // namespace marey::pipeline::people
