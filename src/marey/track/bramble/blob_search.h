// Where a person new may stand: how much evidence a person of typical size would explain at each place of the ground that cameras
// see.
//
// Ours: newcomers of BraMBLe, as remembered, are proposed blindly over the whole ground, which is as good as never on a pitch. A
// proposal that uses the image is importance sampling (Isard, Blake, "ICONDENSATION", ECCV 1998): its user weighs what it
// proposes by what was likely beforehand over what was proposed.
#pragma once

#include <span>
#include <vector>

#include "marey/core/geometry.h"
#include "marey/geometry/ground_view.h"
#include "marey/track/bramble/evidence_sums.h"

namespace marey::track::bramble {

/// What a camera says at an instant.
struct EvidenceView {
  const GroundView* view = nullptr;  ///< holds a whole camera
  const BlobEvidence* evidence = nullptr;
  EvidenceSums sums;
  double late = 0;  ///< s by which its image was taken after the instant
};

class BlobSearch {
 public:
  struct Candidate {
    Vector<2> location = Vector<2>::Zero();  ///< m
    double evidence = 0;                     ///< nats
  };

  /// Places at least `apart` from each other, at most `most`, at which more than `least` would be explained of what `explained`,
  /// one list of shapes a view, does not cover; those with most evidence first. `views` in the order of cameras; those without
  /// evidence have none.
  std::vector<Candidate> find(std::span<const EvidenceView> views, const std::vector<std::vector<GridShape>>& explained,
                              double minimum);

 private:
  struct Cell {
    Vector<2> location;
    std::vector<GridShape> shapes;  // of each camera; none where it does not see enough of a person there
  };
  void lay_out(std::span<const EvidenceView> views);

  std::vector<Cell> cells_;
};

}  // namespace marey::track::bramble
