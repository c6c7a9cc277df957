// How clothes of a recording distinguish people, as densities: how one person's are seen again, and how other people's are.
//
// Shirt, thighs and shanks, each in L*a*b*. How far one person's colours lie apart from instant to instant is learned from early
// and late parts of tracklets; what others wear, from those who are seen at the same time and therefore are another person, and, as
// far as a person wears what no person wore yet, from the spread of all. How often two people wear the same is learned from those
// who are seen together, for a person who was not. Errors of parts and components are not independent: variances are widened by as
// much as the logarithms of likelihoods are to count less. Cost: the tracklets that coexist in pairs, and the pairs asked for,
// times the tracklets.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "marey/track/image/clothing.h"

namespace marey::track::image {

/// What one tracklet wears, as it was first seen, as it was last seen, and when it was there at all.
struct Worn {
  Clothes first, last;
  Clothes whole;
  double begin = 0, end = 0;                     ///< s
  std::optional<Clothes> early = {}, late = {};  ///< its thirds, where it was seen for long enough to learn from
};

class Wardrobe {
 public:
  explicit Wardrobe(std::span<const Worn> worn);

  /// Logarithm of how much likelier the clothes of `later`, a tracklet's index, are seen first if that is who wore those of
  /// `earlier` last than if it is another person of these people; nothing if less than two parts of both were seen.
  std::optional<double> log_ratio(int earlier, int later) const;

 private:
  static constexpr int kParts = 3, kComponents = 3;
  using Variances = std::array<std::array<double, kComponents>, kParts>;

  double log_density(const Clothes& known, const Clothes& detected, const Clothes& parts) const;
  double log_density_of_any_person(const Clothes& detected, const Clothes& parts) const;
  double log_density_of_others(int earlier, int later, const Clothes& parts, double same) const;
  void learn_within();
  void learn_all();
  void learn_alike();

  std::vector<Worn> worn_;
  Variances within_{}, all_{};
  std::array<std::array<double, kComponents>, kParts> middle_{};
  double alike_ = 0;  // fraction of pairs of people in equal clothes
};

}  // namespace marey::track::image
