#include "marey/track/image/clothing.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "marey/geometry/median.h"

namespace marey::track::image {
namespace {

// Variances of differences before anything is learned, and the number of tracklets they count for.
constexpr double kWithinLightness = 36, kWithinColour = 6;
constexpr double kBetweenLightness = 350, kBetweenColour = 50;
constexpr double kPriorCount = 6;
constexpr std::size_t kMinObservedCount = 8;  // instants of a tracklet that is learned from
constexpr double kTrusted = 0.6;              // of the ratio, since parts and components are not independent
constexpr double kMaxClothesGain = 4;         // that clothes alike say for one person: others may wear the same
constexpr double kMinClothesGain = -10;       // and clothes that differ against it: light changes more than was learned
constexpr double kAlike = 4;                  // neighbouring instants share light and pose: this many count as one

double squared(double x) {
  return x * x;
}

/// A variance from differences, half of which may be anything: from their median.
double variance_of(std::vector<double> differences, double prior) {
  if (differences.empty()) return prior;
  for (double& one : differences) one = std::abs(one);
  const double count = static_cast<double>(differences.size());
  return (squared(1.4826 * geometry::median(differences)) * count + prior * kPriorCount) / (count + kPriorCount);
}

std::optional<Appearance> mean_colour(std::span<const Clothes> detected, std::optional<Appearance> Clothes::* part) {
  double sum = 0, lightness = 0, a = 0, b = 0;
  for (const Clothes& one : detected) {
    const std::optional<Appearance>& colour = one.*part;
    if (!colour) continue;
    const double weight = 1 / std::max(1e-3, squared(colour->deviation));
    sum += weight;
    lightness += weight * colour->lightness;
    a += weight * colour->a;
    b += weight * colour->b;
  }
  if (sum <= 0) return std::nullopt;
  return Appearance{.lightness = static_cast<float>(lightness / sum),
                    .a = static_cast<float>(a / sum),
                    .b = static_cast<float>(b / sum),
                    .deviation = static_cast<float>(std::sqrt(kAlike / sum))};
}

/// Differences of colours, by component.
struct Differences {
  std::vector<double> lightness, a, b;

  void add(const std::optional<Appearance>& one, const std::optional<Appearance>& other) {
    if (!one || !other) return;
    lightness.push_back(one->lightness - other->lightness);
    a.push_back(one->a - other->a);
    b.push_back(one->b - other->b);
  }
};

double log_ratio_of(double difference, double noise, double within, double between) {
  const double same = within + noise, other = std::max(between, within) + noise;
  return (std::log(other / same) - squared(difference) * (1 / same - 1 / other)) / 2;
}

}  // namespace

PackedClothes::Colour PackedClothes::packed(const std::optional<Appearance>& colour) {
  if (!colour) return {};
  const auto rounded = [](float value, double minimum, double maximum) {
    return std::clamp(std::round(double(value)), minimum, maximum);
  };
  return {.lightness = static_cast<std::uint8_t>(rounded(colour->lightness, 0, 100)),
          .a = static_cast<std::int8_t>(rounded(colour->a, -127, 127)),
          .b = static_cast<std::int8_t>(rounded(colour->b, -127, 127)),
          .deviation = static_cast<std::uint8_t>(rounded(8 * colour->deviation, 1, 255))};
}

std::optional<Appearance> PackedClothes::unpacked(const Colour& colour) {
  if (colour.deviation == 0) return std::nullopt;
  return Appearance{.lightness = static_cast<float>(colour.lightness),
                    .a = static_cast<float>(colour.a),
                    .b = static_cast<float>(colour.b),
                    .deviation = static_cast<float>(colour.deviation) / 8};
}

Clothes mean_clothes(std::span<const Clothes> detected) {
  return {mean_colour(detected, &Clothes::upper), mean_colour(detected, &Clothes::lower), mean_colour(detected, &Clothes::shanks)};
}

ClothesLikelihood::ClothesLikelihood(std::span<const std::vector<Clothes>> tracklets) {
  Differences within, between;
  std::optional<Clothes> before;
  for (const std::vector<Clothes>& detected : tracklets) {
    if (detected.size() < kMinObservedCount) continue;
    const std::span<const Clothes> all = detected;
    const Clothes early = mean_clothes(all.first(detected.size() / 3)), late = mean_clothes(all.last(detected.size() / 3));
    within.add(early.upper, late.upper);
    within.add(early.lower, late.lower);
    const Clothes mean = mean_clothes(all);
    if (before) {
      between.add(before->upper, mean.upper);
      between.add(before->lower, mean.lower);
    }
    before = mean;
  }
  learned_ = !within.lightness.empty();
  within_ = {variance_of(std::move(within.lightness), kWithinLightness), variance_of(std::move(within.a), kWithinColour),
             variance_of(std::move(within.b), kWithinColour)};
  between_ = {variance_of(std::move(between.lightness), kBetweenLightness), variance_of(std::move(between.a), kBetweenColour),
              variance_of(std::move(between.b), kBetweenColour)};
}

double ClothesLikelihood::log_ratio(const std::optional<Appearance>& a, const std::optional<Appearance>& b) const {
  if (!a || !b) return 0;
  const double noise = squared(a->deviation) + squared(b->deviation);
  return log_ratio_of(a->lightness - b->lightness, noise, within_.lightness, between_.lightness) +
         log_ratio_of(a->a - b->a, noise, within_.a, between_.a) + log_ratio_of(a->b - b->b, noise, within_.b, between_.b);
}

double ClothesLikelihood::log_ratio(const Clothes& a, const Clothes& b) const {
  return std::clamp(kTrusted * (log_ratio(a.upper, b.upper) + log_ratio(a.lower, b.lower)), kMinClothesGain, kMaxClothesGain);
}

}  // namespace marey::track::image
