// How open an area is: where people come into sight and leave permanently, and how often.
//
// A track that begins is a person who came, or who had been lost and is found again; one that ends is a person who left, or was
// lost. On a pitch nearly all are the second, in a square the first, and mostly at its sides. Both are densities over the ground:
// people who come, a m² and second; and of those whose tracks end at a place, the share that left. They are learned by turns
// with the probabilities that ends and beginnings belong together (expectation and maximisation, Dempster, Laird & Rubin 1977),
// from where the tracks of the recording end and begin, and hold to a prior (inside, and at the border of sight) where little is
// seen.
#pragma once

#include <span>
#include <vector>

#include "marey/core/geometry.h"
#include "marey/track/ground/ground_field.h"

namespace marey::track::ground::offline {

class EntryExitMap {
 public:
  /// A place where tracks begin or end, and the probability that the one who it is came or left just there.
  struct EntryExit {
    Vector<2> location = Vector<2>::Zero();
    bool at_border = false;  ///< of what is in sight
    double probability = 0.5;
  };

  /// Knows the prior alone.
  EntryExitMap() = default;
  /// `recorded` in s, positive.
  EntryExitMap(std::span<const EntryExit> came, std::span<const EntryExit> left, double recorded);

  /// People who come into sight at the place of one that was learned from, a m² and s: by all others.
  double coming(const EntryExit& one) const;
  /// Of those whose tracks end there, the share who left permanently: likewise.
  double leaving(const EntryExit& one) const;

 private:
  GroundGrid grid_;
  std::vector<double> came_, left_, ended_;  // by cell; none before anything was learned
  double recorded_ = 0;
};

}  // namespace marey::track::ground::offline
