// How clothes of a recording tell people apart, as densities: how one person's are seen again, and how other people's are.
//
// Shirt, thighs and shanks, each in L*a*b*. How far one person's colours lie apart from moment to moment is learned from early and
// late parts of tracklets; what others wear, from those who are seen at the same time and therefore are somebody else, and, as far
// as somebody wears what nobody wore yet, from the spread of all. Errors of parts and components are not independent: variances are
// widened by as much as the logarithms of likelihoods are to count less.
// Cost: the pairs asked for, times the tracklets that coexist.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "marey/track/image/clothes.h"

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
  /// `earlier` last than if it is somebody else of these people; nothing where less than two parts of both were seen.
  std::optional<double> log_ratio(int earlier, int later) const;

 private:
  static constexpr int kParts = 3, kComponents = 3;
  using Variances = std::array<std::array<double, kComponents>, kParts>;

  double log_density(const Clothes& known, const Clothes& seen, const Clothes& parts) const;
  double log_density_of_anybody(const Clothes& seen, const Clothes& parts) const;
  double log_density_of_others(int later, const Clothes& parts) const;
  void learn_within();
  void learn_all();

  std::vector<Worn> worn_;
  Variances within_{}, all_{};
  std::array<std::array<double, kComponents>, kParts> middle_{};
};

}  // namespace marey::track::image
