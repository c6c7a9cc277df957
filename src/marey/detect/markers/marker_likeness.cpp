#include "marey/detect/markers/marker_likeness.h"

#include <algorithm>
#include <numbers>

namespace marey::detect::markers {
namespace {

constexpr double kFade = 1.0 / 8;                      // of what is known gives way to a frame
constexpr double kManyMarkers = 8;                     // areas of one: four that touch, or one that moves by four diameters
constexpr double kOddMarker = 2.5;                     // areas
constexpr double kMostUnlikeRadius = 2.2;              // times or a fraction
constexpr double kLeastSharp = 3;                      // blurs
constexpr double kLeastWidest = 21, kMostWidest = 81;  // px

std::optional<double> faded(const std::optional<double>& known, const std::optional<double>& seen) {
  if (!known || !seen) return seen ? seen : known;
  return *known + (*seen - *known) * kFade;
}

}  // namespace

void MarkerLikeness::learn(std::span<const Witness> seen) {
  radii_.clear();
  blurs_.clear();
  for (const Witness& one : seen) {
    radii_.push_back({one.radius, one.say});
    if (one.blur) blurs_.push_back({*one.blur, one.say});
  }
  radius_ = faded(radius_, weighted_median(radii_));
  blur_ = faded(blur_, weighted_median(blurs_));
}

std::optional<double> MarkerLikeness::widest() const {
  if (!radius_) return std::nullopt;
  return std::clamp(kMostUnlikeRadius * 2 * *radius_ + 6 * blur_.value_or(0.65), kLeastWidest, kMostWidest);
}

/// Of so many markers as large as they may be, px².
double MarkerLikeness::area(double markers) const {
  const double radius = std::max(*radius_ + 0.5, said_radius_);
  return markers * std::numbers::pi * radius * radius;
}

bool MarkerLikeness::too_large(double area) const {
  return radius_ && area > this->area(kManyMarkers);
}

bool MarkerLikeness::odd(double area) const {
  return radius_ && area > this->area(kOddMarker);
}

bool MarkerLikeness::fits(double radius) const {
  return !radius_ || (radius < kMostUnlikeRadius * *radius_ && *radius_ < kMostUnlikeRadius * radius + 0.5);
}

bool MarkerLikeness::sharp(double blur) const {
  return !blur_ || blur < kLeastSharp * *blur_;
}

}  // namespace marey::detect::markers
