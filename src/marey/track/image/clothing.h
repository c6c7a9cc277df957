// What people wear, as evidence of who is who.
//
// How much two colours that differ say depends on the recording: on how the same person's colours change from place to place and
// instant to instant, and on how different people's differ. Both are learned from tracklets while no person is near them; the
// ratio of the two likelihoods is the evidence. Colours are taken as independent Gaussians; that they are not (shade darkens
// shirt and trousers alike) is why the ratio counts in part only.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "marey/core/appearance.h"

namespace marey::track::image {

/// As far as it was seen.
struct Clothes {
  std::optional<Appearance> upper, lower;
  std::optional<Appearance> shanks = {};  ///< below the knees: socks, trousers
};

/// The same in twelve bytes: colours to one unit of L*a*b*, deviations to an eighth.
class PackedClothes {
 public:
  PackedClothes() = default;
  explicit PackedClothes(const Clothes& clothes)
      : upper_(packed(clothes.upper)), lower_(packed(clothes.lower)), shanks_(packed(clothes.shanks)) {}
  Clothes unpacked() const { return {unpacked(upper_), unpacked(lower_), unpacked(shanks_)}; }

 private:
  struct Colour {
    std::uint8_t lightness = 0;
    std::int8_t a = 0, b = 0;
    std::uint8_t deviation = 0;  ///< in eighths; 0 where nothing was seen
  };
  static Colour packed(const std::optional<Appearance>& colour);
  static std::optional<Appearance> unpacked(const Colour& colour);

  Colour upper_, lower_, shanks_;
};

/// The mean of the observations, one instant after another, sure ones before unsure ones.
Clothes mean_clothes(std::span<const Clothes> detected);

class ClothesLikelihood {
 public:
  /// Learns from `tracklets`, each one person's clothes in the order of time, a few seconds and more each.
  explicit ClothesLikelihood(std::span<const std::vector<Clothes>> tracklets);

  /// Logarithm of how much likelier two are seen in these clothes if they are one person than if they are two; 0 where either is
  /// not known.
  double log_ratio(const Clothes& a, const Clothes& b) const;

  /// Whether there was anything to learn from.
  bool learned() const { return learned_; }

 private:
  struct Spread {
    double lightness = 0, a = 0, b = 0;  ///< variances
  };
  double log_ratio(const std::optional<Appearance>& a, const std::optional<Appearance>& b) const;

  bool learned_ = false;
  Spread within_, between_;  ///< of one person's colours at two times; of two people's
};

}  // namespace marey::track::image
