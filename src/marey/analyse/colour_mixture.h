// How many colours there are among many that were measured, which, and whose is which.
//
// Each person's colour is one of few (a shirt's) plus what light and measuring change, or none of them (a keeper alone in its
// colour; a person measured badly): a mixture of round Gaussians of one common width and a thin even background over all colours,
// fitted by expectation and maximisation (Dempster, Laird & Rubin 1977) from several deterministic beginnings, for one colour, two,
// three …; how many there are is decided by Schwarz's criterion (1978). People count by how long they were seen.
// Cost: beginnings · colours · people for each iteration; a millisecond for a match.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "marey/core/appearance.h"

namespace marey::analyse {

struct ColourObserved {
  Appearance colour;  ///< with its own deviation
  double weight = 1;  ///< > 0; in people: 1 for one who was seen throughout
};

struct ColourMixture {
  struct Kind {
    Appearance colour;    ///< deviation: how much people of one kind differ
    double fraction = 0;  ///< of the weight
  };
  std::vector<Kind> kinds;                      ///< largest share first
  double odd = 0;                               ///< share of those who are of none
  std::vector<std::vector<double>> membership;  ///< of each one given, the probability of each kind; the remainder to 1 is odd
};

/// At most `most` kinds. None where nothing was seen.
ColourMixture find_colours(std::span<const ColourObserved> detected, int maximum = 6);

}  // namespace marey::analyse
