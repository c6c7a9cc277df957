#include "marey/geometry/pitch_elements.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

namespace marey::geometry {
namespace {

constexpr double kBigDepth = 16.5, kBigHalf = 20.16, kSmallDepth = 5.5, kSmallHalf = 9.16;
constexpr double kSpot = 11, kCircle = 9.15, kGoalHalf = 3.66, kBar = 2.44;

constexpr std::array<std::string_view, kPitchElements> kElementNames = {"Big rect. left bottom",
                                                                        "Big rect. left main",
                                                                        "Big rect. left top",
                                                                        "Big rect. right bottom",
                                                                        "Big rect. right main",
                                                                        "Big rect. right top",
                                                                        "Circle central",
                                                                        "Circle left",
                                                                        "Circle right",
                                                                        "Goal left crossbar",
                                                                        "Goal left post left ",
                                                                        "Goal left post right",
                                                                        "Goal right crossbar",
                                                                        "Goal right post left",
                                                                        "Goal right post right",
                                                                        "Middle line",
                                                                        "Side line bottom",
                                                                        "Side line left",
                                                                        "Side line right",
                                                                        "Side line top",
                                                                        "Small rect. left bottom",
                                                                        "Small rect. left main",
                                                                        "Small rect. left top",
                                                                        "Small rect. right bottom",
                                                                        "Small rect. right main",
                                                                        "Small rect. right top"};

/// The name with two words exchanged wherever they stand.
std::string swapped(std::string name, const std::string& a, const std::string& b) {
  for (std::size_t at = 0; at < name.size();) {
    if (name.compare(at, a.size(), a) == 0) {
      name.replace(at, a.size(), b), at += b.size();
    } else if (name.compare(at, b.size(), b) == 0) {
      name.replace(at, b.size(), a), at += a.size();
    } else {
      ++at;
    }
  }
  return name;
}

}  // namespace

std::array<PitchElement, kPitchElements> pitch_elements(const PitchSize& size) {
  const double L = size.length, m = size.width / 2;
  std::array<PitchElement, kPitchElements> all;
  const auto line = [&](std::string_view name, const Vector<3>& from, const Vector<3>& to) {
    const int index = *pitch_element_named(name);
    all[index] = {kElementNames[index], StraightElement{from, to}};
  };
  const auto arc = [&](std::string_view name, double x, double from, double to) {
    const int index = *pitch_element_named(name);
    all[index] = {kElementNames[index], ArcElement{{x, m}, kCircle, from, to}};
  };
  line("Side line bottom", {0, 0, 0}, {L, 0, 0});
  line("Side line top", {0, size.width, 0}, {L, size.width, 0});
  line("Middle line", {L / 2, 0, 0}, {L / 2, size.width, 0});
  arc("Circle central", L / 2, 0, 2 * std::numbers::pi);
  const double half = std::acos((kBigDepth - kSpot) / kCircle);
  arc("Circle left", kSpot, -half, half);
  arc("Circle right", L - kSpot, std::numbers::pi - half, std::numbers::pi + half);
  for (const bool left : {true, false}) {
    const double x = left ? 0 : L, inward = left ? 1 : -1;
    const std::string side = left ? "left" : "right";
    line("Side line " + side, {x, 0, 0}, {x, size.width, 0});
    const auto area = [&](const std::string& name, double depth, double reach) {
      const double front = x + inward * depth;
      line(name + " bottom", {x, m - reach, 0}, {front, m - reach, 0});
      line(name + " main", {front, m - reach, 0}, {front, m + reach, 0});
      line(name + " top", {x, m + reach, 0}, {front, m + reach, 0});
    };
    area("Big rect. " + side, kBigDepth, kBigHalf);
    area("Small rect. " + side, kSmallDepth, kSmallHalf);
    const double near_post = m - kGoalHalf, far_post = m + kGoalHalf;
    line("Goal " + side + " crossbar", {x, near_post, kBar}, {x, far_post, kBar});
    const double left_post = left ? near_post : far_post, right_post = left ? far_post : near_post;
    line("Goal " + side + (left ? " post left " : " post left"), {x, left_post, 0}, {x, left_post, kBar});
    line("Goal " + side + " post right", {x, right_post, 0}, {x, right_post, kBar});
  }
  return all;
}

std::optional<int> pitch_element_named(std::string_view name) {
  const auto trimmed = [](std::string_view text) { return text.substr(0, text.find_last_not_of(' ') + 1); };
  const auto found = std::find_if(kElementNames.begin(), kElementNames.end(),
                                  [&](std::string_view known) { return trimmed(known) == trimmed(name); });
  if (found == kElementNames.end()) return std::nullopt;
  return static_cast<int>(found - kElementNames.begin());
}

int mirrored_element(int element, PitchMirror mirror) {
  std::string name(kElementNames[element]);
  // A goal's posts change their sides with either mirror: they are those of who faces the goal.
  const bool post = name.find("post") != std::string::npos;
  if (post) {
    const std::size_t at = name.find("post");
    std::string goal = name.substr(0, at), side = name.substr(at);
    if (mirror.left_right) goal = swapped(goal, "left", "right");
    if (mirror.left_right != mirror.near_far) side = swapped(side, "left", "right");
    return *pitch_element_named(goal + side);
  }
  if (mirror.left_right) name = swapped(name, "left", "right");
  if (mirror.near_far) name = swapped(name, "top", "bottom");
  return *pitch_element_named(name);
}

std::vector<Vector<3>> sampled(const PitchElement& element, double step) {
  std::vector<Vector<3>> points;
  if (const auto* line = std::get_if<StraightElement>(&element.shape)) {
    const int pieces = std::max(1, static_cast<int>(std::ceil((line->to - line->from).norm() / step)));
    for (int i = 0; i <= pieces; ++i) points.emplace_back(line->from + (line->to - line->from) * i / pieces);
  } else {
    const auto& arc = std::get<ArcElement>(element.shape);
    const int pieces = std::max(1, static_cast<int>(std::ceil(arc.radius * (arc.to - arc.from) / step)));
    for (int i = 0; i <= pieces; ++i) {
      const double angle = arc.from + (arc.to - arc.from) * i / pieces;
      points.emplace_back(arc.centre.x() + arc.radius * std::cos(angle), arc.centre.y() + arc.radius * std::sin(angle), 0.0);
    }
  }
  return points;
}

}  // namespace marey::geometry
