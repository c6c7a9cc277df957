// How well a gap can be filled: each method is tried on test holes in the marker's path, where the truth is known.
//
// Holes as long as the gap show it best. In a short take there is room for few or none of them. Then test holes are laid round the
// gap itself: they are longer by up to the gap's length, and the truth is known at their rims, from where errors are brought to
// the middle by how they grow towards it (as of a Brownian bridge). If these have no room either, shorter holes decide, whose
// errors are scaled up by how they grow with the length.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "marey/edit/gap_methods.h"
#include "marey/edit/operation.h"

namespace marey::edit {

/// The hole's places by one method, as the functions of gap_methods.h have them.
std::optional<std::vector<Vector<3>>> filled(FillMethod method, const Locations& locations, const Hole& hole,
                                             std::span<const std::size_t> donors, const Hole& hidden);

struct FillScore {
  double typical_m = 0;   ///< median error: by which methods are compared, for a few holes of another phase shall not decide
  double expected_m = 0;  ///< standard deviation of the distance from the true place, in the middle of the gap
};

class FillTrials {
 public:
  /// Of the first marker of `places`. The arguments must outlive it.
  FillTrials(const Locations& locations, const Hole& gap, std::span<const std::size_t> donors);

  FillScore score(FillMethod method) const;

 private:
  /// Holes of one length.
  struct Group {
    std::size_t length = 0;
    std::vector<Hole> holes;
  };

  Group inside(std::size_t length) const;
  std::vector<Hole> around() const;
  std::vector<double> errors(FillMethod method, std::span<const Hole> holes) const;
  FillScore of(FillMethod method, std::span<const Hole> holes) const;
  FillScore scaled(FillMethod method) const;
  FillScore untried(FillMethod method) const;

  const Locations& locations_;
  Hole gap_;
  std::span<const std::size_t> donors_;
  std::vector<Group> groups_;  // inside the observed part; of the gap's length, a half, a quarter
  std::vector<Hole> around_;
};

}  // namespace marey::edit
