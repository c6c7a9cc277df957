// Cost: each view's things are compared with those of some seconds round it, and with all of its boxes.
#include "marey/track/ball/ball_clutter.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>

namespace marey::track::ball {
namespace {

enum Zone { kOpen, kNear, kOnPerson, kBeyond };
constexpr int kZones = 4;
constexpr std::size_t kBeyondEvery = 25;  // views, after which the area beyond the lines is counted again: PTZ cameras move

bool holds(const Box& box, const Vector<2>& pixel) {
  return pixel.x() > box.left && pixel.x() < box.right() && pixel.y() > box.top && pixel.y() < box.bottom();
}

Box grown(const Box& box, double sides, double top, double bottom) {
  return {box.left - sides, box.top - top, box.width + 2 * sides, box.height + top + bottom};
}

/// Where a person's ball is seen, and what a quick foot or a box that was too narrow omits.
Box surroundings_of(const Box& person) {
  return grown(person, 0.4 * person.height + 2, 0.15 * person.height + 2, 0.2 * person.height + 2);
}

bool is_beyond(const Vector<2>& pixel, const GroundView& ground, const GroundRegion& pitch) {
  if (!pitch) return false;
  const auto location = ground.location(pixel);
  return !location || !pitch(location->ground);
}

/// px² of an image that show what lies beyond the lines: counted on a grid.
double area_beyond(const GroundView& ground, const GroundRegion& pitch) {
  constexpr int kGrid = 16;  // px
  if (!pitch) return 0;
  double area = 0;
  for (int y = kGrid / 2; y < ground.size().height; y += kGrid) {
    for (int x = kGrid / 2; x < ground.size().width; x += kGrid)
      area += is_beyond({static_cast<double>(x), static_cast<double>(y)}, ground, pitch) ? kGrid * kGrid : 0;
  }
  return area;
}

Zone zone_of(const BallView& view, const BallSighting& one, const GroundView& ground, const GroundRegion& pitch,
             const BallClutterOptions& options) {
  if (one.local_clutter > options.max_clutter) return kOnPerson;
  const Vector<2>& pixel = one.pixel;
  Zone zone = kOpen;
  for (const Box& person : view.people) {
    if (holds(limbs_of(person), pixel)) return kOnPerson;
    if (holds(surroundings_of(person), pixel)) zone = kNear;
  }
  if (zone == kOpen && is_beyond(pixel, ground, pitch)) return kBeyond;
  return zone;
}

/// One camera's views, in the order of time.
using CameraViews = std::vector<BallView*>;

/// Of the other frames of some seconds round it, the share in which something is seen at the same place.
double recurrence(const CameraViews& views, std::size_t at, const Vector<2>& pixel, const BallClutterOptions& options) {
  int frames = 0, again = 0;
  const auto inspect = [&](std::size_t i) {
    const double away = std::abs(seconds(views[i]->time - views[at]->time));
    if (away > options.recurs_for) return false;
    if (away < options.recurs_from) return true;
    ++frames;
    const auto is = [&](const BallSighting& one) { return (one.pixel - pixel).norm() < options.recurs_within; };
    again += std::any_of(views[i]->detected.begin(), views[i]->detected.end(), is) ? 1 : 0;
    return true;
  };
  for (std::size_t i = at; i > 0; --i)
    if (!inspect(i - 1)) break;
  for (std::size_t i = at + 1; i < views.size(); ++i)
    if (!inspect(i)) break;
  return frames == 0 ? 0 : static_cast<double>(again) / frames;
}

/// Areas of the zones in one view, px².
std::array<double, kZones> areas_of(const BallView& view, double image, double beyond) {
  std::array<double, kZones> area{};
  double round = 0;
  for (const Box& person : view.people) {
    area[kOnPerson] += limbs_of(person).area();
    round += surroundings_of(person).area();
  }
  area[kNear] = round - area[kOnPerson];
  area[kBeyond] = beyond;
  area[kOpen] = image - beyond;
  return area;
}

void weigh_camera(const CameraViews& views, const GroundViews& grounds, const GroundRegion& pitch,
                  const BallClutterOptions& options) {
  std::array<double, kZones> detected{options.min_open * static_cast<double>(views.size()), 1, 1, 1}, area{};
  std::vector<std::vector<std::pair<Zone, double>>> known;
  double beyond = 0;
  for (std::size_t i = 0; i < views.size(); ++i) {
    const GroundView& ground = grounds.view_at(views[i]->camera, views[i]->time);
    const double image = static_cast<double>(ground.size().width) * ground.size().height;
    if (i % kBeyondEvery == 0) beyond = area_beyond(ground, pitch);
    const auto of_this = areas_of(*views[i], image, beyond);
    for (int zone = 0; zone < kZones; ++zone) area[static_cast<std::size_t>(zone)] += of_this[static_cast<std::size_t>(zone)];
    auto& of_view = known.emplace_back();
    for (const BallSighting& one : views[i]->detected) {
      of_view.emplace_back(zone_of(*views[i], one, ground, pitch, options), recurrence(views, i, one.pixel, options));
      constexpr double kRecurs = 0.3;
      if (of_view.back().second < kRecurs) detected[of_view.back().first] += 1;
    }
  }
  const double spread = options.recurs_within / 2, at_the_place = 1 / (2 * std::numbers::pi * spread * spread);  // px, 1/px²
  for (std::size_t i = 0; i < views.size(); ++i) {
    for (std::size_t k = 0; k < known[i].size(); ++k) {
      const auto& [zone, again] = known[i][k];
      BallSighting& one = views[i]->detected[k];
      one.on_person = zone == kOnPerson;
      one.false_density = detected[zone] / std::max(area[zone], 1.0) + again * at_the_place;
    }
  }
}

}  // namespace

Box limbs_of(const Box& person) {
  return grown(person, 0.1 * person.height + 1, 0.04 * person.height + 1, 0.06 * person.height + 1);
}

void weigh_sightings(std::span<BallObservations> time_steps, const GroundViews& views, const BallClutterOptions& options,
                     const GroundRegion& pitch) {
  std::map<CameraId, CameraViews> cameras;
  for (BallObservations& time_step : time_steps) {
    for (BallView& view : time_step.views) cameras[view.camera].push_back(&view);
  }
  for (const auto& [camera, of_camera] : cameras) weigh_camera(of_camera, views, pitch, options);
}

}  // namespace marey::track::ball
