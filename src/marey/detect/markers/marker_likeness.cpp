#include "marey/detect/markers/marker_likeness.h"

#include <algorithm>
#include <numbers>

#include "marey/geometry/median.h"

namespace marey::detect::markers {
namespace {

constexpr double kFade = 1.0 / 8;                           // of what is known gives way to a frame
constexpr double kManyMarkers = 8;                          // areas of one: four that touch, or one that moves by four diameters
constexpr double kOddMarker = 2.5;                          // areas
constexpr double kMaxUnlikeRadius = 2.2;                    // times or a fraction
constexpr double kMaxUnlikeOfMany = 1.4;                    // a fraction, of three and more in a blob
constexpr double kMinSharp = 3;                             // blurs
constexpr double kLarger = 1.6;                             // radii of the small kind
constexpr std::size_t kMinOfAKind = 4;                      // by chance three things are as large as each other
constexpr double kKindContrast = 0.7;                       // of what the others stand out by
constexpr double kMaxSpread = 1.5;                          // the third quartile of a kind's radii over the first
constexpr double kMinWidthLimit = 21, kMaxWidthLimit = 81;  // px

std::optional<double> faded(const std::optional<double>& known, const std::optional<double>& detected) {
  if (!known || !detected) return detected ? detected : known;
  return *known + (*detected - *known) * kFade;
}

}  // namespace

void MarkerLikeness::learn(std::span<const Witness> detected) {
  radii_.clear();
  blurs_.clear();
  for (const Witness& one : detected) {
    radii_.push_back({one.radius, one.announce});
    if (one.blur) blurs_.push_back({*one.blur, one.announce});
  }
  radius_ = faded(radius_, geometry::weighted_median(radii_));
  large_ = faded(large_, large_kind(detected));
  blur_ = faded(blur_, geometry::weighted_median(blurs_));
}

/// Things that are not discs as the small ones are, but round, as bright, and as large as each other: spheres lit from aside among
/// dust.
std::optional<double> MarkerLikeness::large_kind(std::span<const Witness> detected) {
  std::vector<double> radii;
  if (!radius_) return std::nullopt;
  contrasts_.clear();
  for (const Witness& one : detected) contrasts_.push_back({one.contrast, 1});
  const double bright = kKindContrast * geometry::weighted_median(contrasts_).value_or(0), small = kLarger * (*radius_ + 0.5);
  for (const Witness& one : detected) {
    if (one.round && one.contrast > bright && one.radius > small) radii.push_back(one.radius);
  }
  if (radii.size() < kMinOfAKind) return std::nullopt;
  std::sort(radii.begin(), radii.end());
  const double first = radii[radii.size() / 4], third = radii[3 * radii.size() / 4];
  if (third > kMaxSpread * first) return std::nullopt;
  return third;
}

std::optional<double> MarkerLikeness::widest() const {
  if (!radius_) return std::nullopt;
  return std::clamp(kMaxUnlikeRadius * 2 * largest() + 6 * blur_.value_or(0.65), kMinWidthLimit, kMaxWidthLimit);
}

/// Of this many markers as large as they may be, px².
double MarkerLikeness::area(double markers) const {
  const double radius = std::max(largest() + 0.5, stated_radius_);
  return markers * std::numbers::pi * radius * radius;
}

bool MarkerLikeness::too_large(double area) const {
  return radius_ && area > this->area(kManyMarkers);
}

bool MarkerLikeness::odd(double area) const {
  return radius_ && area > this->area(kOddMarker);
}

bool MarkerLikeness::fits(double radius, std::size_t together) const {
  const double minimum = together > 2 ? kMaxUnlikeOfMany : kMaxUnlikeRadius;
  return !radius_ || (radius < kMaxUnlikeRadius * largest() && *radius_ < minimum * radius + 0.5);
}

bool MarkerLikeness::sharp(double blur) const {
  return !blur_ || blur < kMinSharp * *blur_;
}

}  // namespace marey::detect::markers
