// Sums of evidence over what people cover: a row's part is a difference of two numbers, so that a person costs as many look-ups as
// the grid's rows it spans, not as its points; a person who occludes another is counted once.
#pragma once

#include <span>
#include <vector>

#include "marey/core/blob_evidence.h"
#include "marey/track/bramble/person_cylinder.h"

namespace marey::track::bramble {

class EvidenceSums {
 public:
  EvidenceSums() = default;
  explicit EvidenceSums(const BlobEvidence& evidence);

  /// Of what a span of a row holds, nats.
  double sum(int row, int begin, int end) const {
    const double* to = &sums_[static_cast<std::size_t>(row) * stride_];
    return to[end] - to[begin];
  }
  /// Of all that the shape covers.
  double sum(const GridShape& shape) const;

  struct Gain {
    double evidence = 0;  ///< nats
    int points = 0;       ///< that no other covers
  };
  /// Of what it covers and none of `others` does: what it adds to the union's sum.
  Gain gain(const GridShape& shape, std::span<const GridShape* const> others) const;

 private:
  std::size_t stride_ = 0;
  std::vector<double> sums_;  // rows × (columns + 1): of all points of the row before a column
};

}  // namespace marey::track::bramble
