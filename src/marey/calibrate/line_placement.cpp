#include "marey/calibrate/line_placement.h"

#include <cmath>

#include "marey/core/geometry.h"
#include "marey/geometry/camera.h"

namespace marey::calibrate {
namespace {

constexpr double kAgree = 5;         // sigmas within which rays meet
constexpr double kLengthOff = 0.15;  // relative, by which a placed line may be too long or too short

}  // namespace

LinePlacement::LinePlacement(std::vector<StartingCamera> cameras, MarkerLine line, const MarkTable& table)
    : poses(cameras.size()),
      bodies(table.size()),
      rotated(table.size(), std::vector<char>(cameras.size(), 0)),
      cameras_(std::move(cameras)),
      line_(std::move(line)),
      table_(table),
      bearings_(table.size(), std::vector<std::optional<MarkerPositions>>(cameras_.size())) {
  for (std::size_t c = 0; c < cameras_.size(); ++c) measure(c);
}

double LinePlacement::sigma(std::size_t c) const {
  return cameras_[c].sigma_px / geometry::focal_of(cameras_[c].lens).x();
}

void LinePlacement::set_lens(std::size_t c, const geometry::Lens& lens) {
  cameras_[c].lens = lens;
  measure(c);
}

void LinePlacement::measure(std::size_t c) {
  const Camera camera(cameras_[c].lens, {}, cameras_[c].size);
  for (std::size_t i = 0; i < bearings_.size(); ++i) {
    bearings_[i][c].reset();
    const auto& marks = table_[i][c];
    if (!marks) continue;
    MarkerPositions locations{};
    bool whole = true;
    for (std::size_t m = 0; m < line_.markers(); ++m) {
      const auto bearing = (*marks)[m] ? camera.bearing(*(*marks)[m]) : std::nullopt;
      whole &= bearing.has_value();
      if (bearing) locations[m] = *bearing;
    }
    if (whole) bearings_[i][c] = locations;
  }
}

Vector<2> LinePlacement::pixel(std::size_t i, std::size_t c, std::size_t marker) const {
  return *(*table_[i][c])[rotated[i][c] ? line_.markers() - 1 - marker : marker];
}

Vector<3> LinePlacement::marker_at(const bundle::Body& body, std::size_t marker) const {
  if (const auto* point = std::get_if<Vector<3>>(&body)) return *point;
  const auto& wand = std::get<bundle::WandPose>(body);
  return wand.origin + line_.distances[marker] * wand.direction;
}

SightLine LinePlacement::sight(std::size_t i, std::size_t c, std::size_t marker) const {
  const Rigid3 world_from_camera = poses[c]->inverse();
  const std::size_t detected = rotated[i][c] ? line_.markers() - 1 - marker : marker;
  return {{world_from_camera.translation, world_from_camera.rotation * (*bearings_[i][c])[detected]}, sigma(c)};
}

void LinePlacement::turn_to_fit(std::size_t i, std::size_t first, std::size_t other) {
  constexpr double never = 1e6;
  std::array<double, 2> off{};
  const char before = rotated[i][other];
  for (const char turn : {0, 1}) {
    rotated[i][other] = turn;
    for (std::size_t m = 0; m < line_.markers(); ++m) {
      const std::array lines = {sight(i, first, m), sight(i, other, m)};
      const auto point = intersection_point(lines);
      off[static_cast<std::size_t>(turn)] +=
          point ? std::pow(angle_off(lines[0], *point), 2) + std::pow(angle_off(lines[1], *point), 2) : never;
    }
  }
  rotated[i][other] = off[0] == off[1] ? before : static_cast<char>(off[1] < off[0]);
}

std::optional<MarkerPositions> LinePlacement::markers(std::size_t i) {
  std::vector<std::size_t> observing;
  for (std::size_t c = 0; c < poses.size(); ++c) {
    if (poses[c] && bearings_[i][c]) observing.push_back(c);
  }
  if (observing.size() < 2) return std::nullopt;
  if (line_.reversible()) {
    for (std::size_t k = 1; k < observing.size(); ++k) turn_to_fit(i, observing[0], observing[k]);
  }
  MarkerPositions locations{};
  std::vector<SightLine> lines;
  for (std::size_t m = 0; m < line_.markers(); ++m) {
    lines.clear();
    for (const std::size_t c : observing) lines.push_back(sight(i, c, m));
    const auto point = agreed_point(lines, kAgree);
    if (!point) return std::nullopt;
    locations[m] = *point;
  }
  return locations;
}

void LinePlacement::location(std::size_t i) {
  const auto locations = markers(i);
  if (!locations) return;
  if (line_.markers() == 1) {
    bodies[i] = bundle::Body((*locations)[0]);
    return;
  }
  const Vector<3> along = (*locations)[line_.markers() - 1] - (*locations)[0];
  if (std::abs(along.norm() / line_.length() - 1) > kLengthOff) return;
  bundle::WandPose pose{Vector<3>::Zero(), along.normalized()};
  for (std::size_t m = 0; m < line_.markers(); ++m) {
    pose.origin += ((*locations)[m] - line_.distances[m] * pose.direction) / static_cast<double>(line_.markers());
  }
  bodies[i] = bundle::Body(pose);
}

void LinePlacement::position_all() {
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    if (!bodies[i]) location(i);
  }
}

}  // namespace marey::calibrate
