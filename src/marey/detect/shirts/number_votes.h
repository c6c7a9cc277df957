#pragma once

#include <optional>
#include <string>
#include <vector>

#include "marey/core/time.h"
#include "marey/detect/shirts/shirt_network.h"

namespace marey::detect::shirts {

/// The probability from which a number names a person, and is shown.
inline constexpr double kDecisiveNumber = 0.95;  // chosen on figures in bench/tuning.md

/// One track's number.
struct TrackNumber {
  int number = 0;          ///< the likeliest, 0 … 99
  double probability = 0;  ///< that it is this one; small for people without a number or with few legible readings
  int readings = 0;        ///< images in which digits were legible
  Timestamp clearest{};    ///< of the reading that says most for this number
};

/// The readings of one track, as votes: each number's likelihood by how digits are confused, overlooked and invented, against that
/// of a person without a number, which half of all people are taken to be. Readings within half a second are one group, for what
/// made one wrong makes the next wrong too.
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

  std::vector<double> totals_with(const std::vector<double>& group, int count) const;
  Timestamp clearest(int number) const;

  std::vector<double> totals_;  // log-likelihoods of 0 … 99 over that of no number, of the groups that have ended
  std::vector<double> group_;   // the same, summed over the readings of the group that has not
  Timestamp group_began_{};
  int in_group_ = 0, legible_ = 0;
  std::vector<Reading> clear_;  // the clearest reading of each group that had a legible one
};

}  // namespace marey::detect::shirts
