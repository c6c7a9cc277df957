#include "marey/simulate/square/square_boxes.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "marey/geometry/box.h"

namespace marey::simulate::square {
namespace {

constexpr double kBodyRadius = 0.22;  // m
constexpr double kHidden = 0.67;

/// Round a cylinder; nothing where a part of it is behind the camera.
std::optional<Box> box_of(const SquarePerson& person, const Camera& camera) {
  std::optional<Box> box;
  for (int i = 0; i < 8; ++i) {
    const double angle = i * std::numbers::pi / 4;
    const Vector<2> at = person.place + kBodyRadius * Vector<2>(std::cos(angle), std::sin(angle));
    for (const double z : {0.0, person.height}) {
      // The feet are below the body's middle, not on the cylinder's rim.
      const Vector<2> xy = z == 0 ? Vector<2>(person.place + 0.4 * (at - person.place)) : at;
      const auto pixel = camera.project({xy.x(), xy.y(), z});
      if (!pixel) return std::nullopt;
      const Box point{pixel->x(), pixel->y(), 1e-6, 1e-6};
      box = box ? geometry::hull(*box, point) : point;
    }
  }
  return box;
}

struct Seen {
  Box box;
  double distance = 0;  // m
};

double covered(const Seen& one, std::span<const Seen> all) {
  double most = 0;
  for (const Seen& other : all) {
    if (other.distance < one.distance) most = std::max(most, geometry::intersection(one.box, other.box).area() / one.box.area());
  }
  return most;
}

Box noisy(const Box& box, double noise, Random& random) {
  const double left = box.left + random.gaussian(0, noise * box.width), right = box.right() + random.gaussian(0, noise * box.width);
  const double top = box.top + random.gaussian(0, noise * box.height),
               bottom = box.bottom() + random.gaussian(0, noise * box.height);
  return {left, top, std::max(1.0, right - left), std::max(1.0, bottom - top)};
}

}  // namespace

std::vector<LabelledBox> square_boxes(std::span<const SquarePerson> people, const SquareMotion& square, const Camera& camera,
                                      std::int32_t frame, const SquareDetectorOptions& options, Random& random) {
  const Box picture{0, 0, static_cast<double>(camera.size().width), static_cast<double>(camera.size().height)};
  std::vector<Seen> seen;
  for (const SquarePerson& person : people) {
    if (!square.holds(person.place)) continue;
    const auto box = box_of(person, camera);
    if (!box || geometry::intersection(*box, picture).area() < 0.5 * box->area()) continue;
    seen.push_back({*box, (camera.centre().head<2>() - person.place).norm()});
  }
  std::vector<LabelledBox> boxes;
  const auto add = [&](const Box& box) {
    const Box shown = geometry::intersection(noisy(box, options.size_noise, random), picture);
    if (!shown.empty()) boxes.push_back({.frame = frame, .box = shown, .score = 0.9});
  };
  for (const Seen& one : seen) {
    const bool hidden = covered(one, seen) > kHidden;
    if (!random.chance(hidden ? options.hidden_missed : options.missed)) add(one.box);
  }
  if (!seen.empty() && random.chance(options.false_alarms)) {
    Box somewhere = seen[static_cast<std::size_t>(random.integer(0, static_cast<int>(seen.size()) - 1))].box;
    somewhere.left += random.gaussian(0, 2 * somewhere.width);
    add(somewhere);
  }
  std::sort(boxes.begin(), boxes.end(), [](const LabelledBox& a, const LabelledBox& b) { return a.box.left < b.box.left; });
  return boxes;
}

}  // namespace marey::simulate::square
