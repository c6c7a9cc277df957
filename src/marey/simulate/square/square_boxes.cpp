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

/// Round a cylinder; nothing if a part of it is behind the camera.
std::optional<Box> box_of(const SquarePerson& person, const Camera& camera) {
  std::optional<Box> box;
  for (int i = 0; i < 8; ++i) {
    const double angle = i * std::numbers::pi / 4;
    const Vector<2> at = person.location + kBodyRadius * Vector<2>(std::cos(angle), std::sin(angle));
    for (const double z : {0.0, person.height}) {
      // The feet are below the body's middle, not on the cylinder's rim.
      const Vector<2> xy = z == 0 ? Vector<2>(person.location + 0.4 * (at - person.location)) : at;
      const auto pixel = camera.project({xy.x(), xy.y(), z});
      if (!pixel) return std::nullopt;
      const Box point{pixel->x(), pixel->y(), 1e-6, 1e-6};
      box = box ? geometry::hull(*box, point) : point;
    }
  }
  return box;
}

struct Detected {
  Box box;
  double distance = 0;  // m
};

double covered(const Detected& one, std::span<const Detected> all) {
  double maximum = 0;
  for (const Detected& other : all) {
    if (other.distance < one.distance)
      maximum = std::max(maximum, geometry::intersection(one.box, other.box).area() / one.box.area());
  }
  return maximum;
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
  const Box image{0, 0, static_cast<double>(camera.size().width), static_cast<double>(camera.size().height)};
  std::vector<Detected> detected;
  for (const SquarePerson& person : people) {
    if (!square.holds(person.location)) continue;
    const auto box = box_of(person, camera);
    if (!box || geometry::intersection(*box, image).area() < 0.5 * box->area()) continue;
    detected.push_back({*box, (camera.centre().head<2>() - person.location).norm()});
  }
  std::vector<LabelledBox> boxes;
  const auto add = [&](const Box& box) {
    const Box shown = geometry::intersection(noisy(box, options.size_noise, random), image);
    if (!shown.empty()) boxes.push_back({.frame = frame, .box = shown, .score = 0.9});
  };
  for (const Detected& one : detected) {
    const bool hidden = covered(one, detected) > kHidden;
    if (!random.chance(hidden ? options.hidden_missed : options.missed)) add(one.box);
  }
  if (!detected.empty() && random.chance(options.false_alarms)) {
    Box somewhere = detected[static_cast<std::size_t>(random.integer(0, static_cast<int>(detected.size()) - 1))].box;
    somewhere.left += random.gaussian(0, 2 * somewhere.width);
    add(somewhere);
  }
  std::sort(boxes.begin(), boxes.end(), [](const LabelledBox& a, const LabelledBox& b) { return a.box.left < b.box.left; });
  return boxes;
}

}  // namespace marey::simulate::square
