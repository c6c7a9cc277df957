#pragma once

#include <cstdint>

#include "marey/core/geometry.h"

namespace marey {

/// One line of a table of boxes: truth, a tracker's result, or a detector's. What files hold and what is evaluated.
struct LabelledBox {
  static constexpr std::int32_t no_person = -1;

  std::int32_t frame = 0;       ///< counts from 0
  std::int32_t id = no_person;  ///< whose box; `no_person` for detections
  Box box;                      ///< px
  double score = 1;             ///< as the file has it, in the detector's own scale; 1 where it has none

  bool operator==(const LabelledBox&) const = default;
};

}  // namespace marey
