#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace marey::evaluate {

/// The overlaps that HOTA asks a match to have: 0.05, 0.10, ..., 0.95.
inline constexpr int hota_levels = 19;

/// The state of an object and a track that overlap somewhere.
struct IdPair {
  int object = 0;
  int track = 0;
  std::int64_t found = 0;                                ///< frames in which they overlap enough to be a match
  double likeness = 0;                                   ///< over the frames, overlap shared among all that overlap with either
  double alignment = 0;                                  ///< HOTA's global alignment score
  std::array<std::int32_t, hota_levels + 1> at_level{};  ///< frames matched, by the number of levels that the overlap reaches
};

/// The pairs of ids that ever overlap, a sparse matrix.
class PairTable {
 public:
  explicit PairTable(int objects) : by_object_(objects) {}

  /// The pair, made where it is new. The reference holds until the next pair is made.
  IdPair& at(int object, int track);

  const std::vector<IdPair>& pairs() const { return pairs_; }
  std::vector<IdPair>& pairs() { return pairs_; }

 private:
  struct Slot {
    int track = 0;
    std::size_t pair = 0;
  };
  std::vector<std::vector<Slot>> by_object_;  // ordered by track
  std::vector<IdPair> pairs_;                 // in the order of their first meeting
};

}  // namespace marey::evaluate
