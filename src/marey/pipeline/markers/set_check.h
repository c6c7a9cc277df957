// What searches found out of a learned set: which of its labels are ambiguous, and whether it is another person's.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "marey/solve/labels/find_names.h"

namespace marey::pipeline::markers {

class SetCheck {
 public:
  explicit SetCheck(std::size_t labels) : undecided_(labels, 0), decided_(labels, 0) {}

  /// The final check of a search that found labels.
  void add(const solve::labels::FoundNames& found);

  /// Whether a label may as well be swapped with another, and no search has decided it.
  bool is_ambiguous(std::size_t label) const { return undecided_[label] != 0; }
  /// A sentence if the set is probably another person's, by the median over all searches, of which there is at least one: a short
  /// one alone may be off. `found` of its `markers` were found.
  std::optional<std::string> misfit(std::size_t found, std::size_t markers) const;
  /// The same once, after the second search.
  std::optional<std::string> new_misfit(std::size_t found, std::size_t markers);

 private:
  std::vector<char> undecided_, decided_;    // by label
  std::vector<double> misfits_, misfits_m_;  // of each search
  bool reported_ = false;
};

}  // namespace marey::pipeline::markers
