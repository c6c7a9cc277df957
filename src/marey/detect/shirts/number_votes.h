#pragma once

#include <optional>
#include <string>
#include <vector>

#include "marey/core/time.h"
#include "marey/detect/shirts/shirt_network.h"

namespace marey::detect::shirts {

/// What is known of one track's number.
struct TrackNumber {
  int number = 0;          ///< the likeliest, 0 … 99
  double probability = 0;  ///< that it is this one; of people without a number, and of those of whom little was read, small
  int readings = 0;        ///< images in which digits were legible
  Timestamp clearest{};    ///< of the reading that says most for this number
};

/// The readings of one track, as votes: each number's likelihood by how digits are confused, overlooked and invented, against that
/// of a person without a number, of whom half of all are assumed. Readings within half a second are one look, for what made one
/// wrong makes the next wrong too.
class NumberVotes {
 public:
  /// By growing time.
  void add(Timestamp time, const ShirtReading& reading);

  /// Nothing if no digit was ever legible.
  std::optional<TrackNumber> result() const;

 private:
  struct Reading {
    Timestamp time{};
    ShirtReading read;
  };

  std::vector<double> totals_with(const std::vector<double>& look, int count) const;
  Timestamp clearest(int number) const;

  std::vector<double> totals_;  // log-likelihoods of 0 … 99 over that of no number, of the looks that have ended
  std::vector<double> look_;    // the same, summed over the readings of the look that has not
  Timestamp look_began_{};
  int in_look_ = 0, legible_ = 0;
  std::vector<Reading> clear_;  // the clearest reading of each look that had a legible one
};

}  // namespace marey::detect::shirts
