#include "marey/geometry/pitch.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace marey::geometry {
namespace {

constexpr double kPenaltyDepth = 16.5, kPenaltyHalfWidth = 20.16;
constexpr double kGoalAreaDepth = 5.5, kGoalAreaHalfWidth = 9.16;
constexpr double kPenaltyMark = 11, kRadius = 9.15;

struct Segment {
  const char* name;
  Vector<2> from, to;
};

struct Arc {
  const char* name;
  Vector<2> centre;
  double from, to;  // rad
};

/// x and y of both ends of the pitch from those of one: `toward` is +1 at x = 0 and −1 at the other end.
std::vector<Segment> segments_of(const PitchSize& size) {
  const double L = size.length, W = size.width, m = W / 2;
  std::vector<Segment> all = {{"touchline y = 0", {0, 0}, {L, 0}},
                              {"touchline y = width", {0, W}, {L, W}},
                              {"goal line x = 0", {0, 0}, {0, W}},
                              {"goal line x = length", {L, 0}, {L, W}},
                              {"halfway line", {L / 2, 0}, {L / 2, W}}};
  const auto area = [&](double x, double depth, double half, const char* low, const char* front, const char* high) {
    all.push_back({low, {x, m - half}, {x + depth, m - half}});
    all.push_back({front, {x + depth, m - half}, {x + depth, m + half}});
    all.push_back({high, {x, m + half}, {x + depth, m + half}});
  };
  area(0, kPenaltyDepth, kPenaltyHalfWidth, "penalty area x = 0, low y", "penalty area x = 0, front", "penalty area x = 0, high y");
  area(L, -kPenaltyDepth, kPenaltyHalfWidth, "penalty area x = length, low y", "penalty area x = length, front",
       "penalty area x = length, high y");
  area(0, kGoalAreaDepth, kGoalAreaHalfWidth, "goal area x = 0, low y", "goal area x = 0, front", "goal area x = 0, high y");
  area(L, -kGoalAreaDepth, kGoalAreaHalfWidth, "goal area x = length, low y", "goal area x = length, front",
       "goal area x = length, high y");
  return all;
}

std::vector<Arc> arcs_of(const PitchSize& size) {
  const double m = size.width / 2;
  const double half = std::acos((kPenaltyDepth - kPenaltyMark) / kRadius);
  return {{"centre circle", {size.length / 2, m}, 0, 2 * std::numbers::pi},
          {"penalty arc x = 0", {kPenaltyMark, m}, -half, half},
          {"penalty arc x = length", {size.length - kPenaltyMark, m}, std::numbers::pi - half, std::numbers::pi + half}};
}

double distance(const Segment& segment, const Vector<2>& location) {
  const Vector<2> along = segment.to - segment.from;
  const double t = std::clamp((location - segment.from).dot(along) / along.squaredNorm(), 0.0, 1.0);
  return (location - segment.from - t * along).norm();
}

double distance(const Arc& arc, const Vector<2>& location) {
  const Vector<2> from_centre = location - arc.centre;
  const double middle = (arc.from + arc.to) / 2, half = (arc.to - arc.from) / 2;
  const double off = std::remainder(std::atan2(from_centre.y(), from_centre.x()) - middle, 2 * std::numbers::pi);
  if (std::abs(off) <= half) return std::abs(from_centre.norm() - kRadius);
  const auto end = [&](double angle) -> Vector<2> { return arc.centre + kRadius * Vector<2>(std::cos(angle), std::sin(angle)); };
  return std::min((location - end(arc.from)).norm(), (location - end(arc.to)).norm());
}

}  // namespace

std::vector<PitchLine> pitch_lines(const PitchSize& size, double step) {
  std::vector<PitchLine> lines;
  for (const Segment& segment : segments_of(size)) {
    const Vector<2> along = segment.to - segment.from;
    const int count = static_cast<int>(std::ceil(along.norm() / step));
    PitchLine& line = lines.emplace_back(PitchLine{segment.name, {}, {}});
    for (int i = 0; i < count; ++i) {
      line.points.emplace_back(segment.from + along * ((i + 0.5) / count));
      line.tangents.emplace_back(along.normalized());
    }
  }
  for (const Arc& arc : arcs_of(size)) {
    const int count = static_cast<int>(std::ceil(kRadius * (arc.to - arc.from) / step));
    PitchLine& line = lines.emplace_back(PitchLine{arc.name, {}, {}});
    for (int i = 0; i < count; ++i) {
      const double angle = arc.from + (arc.to - arc.from) * ((i + 0.5) / count);
      const Vector<2> out(std::cos(angle), std::sin(angle));
      line.points.emplace_back(arc.centre + kRadius * out);
      line.tangents.emplace_back(-out.y(), out.x());
    }
  }
  return lines;
}

double distance_to_line(const PitchSize& size, const Vector<2>& location) {
  double nearest = std::numeric_limits<double>::infinity();
  for (const Segment& segment : segments_of(size)) nearest = std::min(nearest, distance(segment, location));
  for (const Arc& arc : arcs_of(size)) nearest = std::min(nearest, distance(arc, location));
  return nearest;
}

}  // namespace marey::geometry
