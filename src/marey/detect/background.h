#pragma once

#include <span>

#include "marey/core/foreground.h"
#include "marey/core/frame.h"
#include "marey/geometry/box.h"

namespace marey {

/// A model of the empty scene of a fixed camera.
class Background {
 public:
  virtual ~Background() = default;

  /// Begins with the scene common to `samples`, which span some seconds of the recording; people may stand in any of them.
  virtual void prime(std::span<const Frame> /*samples*/) {}

  /// What in `frame` does not belong to the scene; then learns from it, except within `held`, where people are known to be.
  virtual Foreground apply(const Frame& frame, std::span<const Box> held) = 0;
};

}  // namespace marey
