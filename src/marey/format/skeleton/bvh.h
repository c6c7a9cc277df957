#pragma once

#include <memory>
#include <string>

#include "marey/core/sink.h"
#include "marey/format/format.h"

namespace marey::format::skeleton {

/// How a BVH file is to be written: there are many dialects.
struct BvhDialect {
  double unit_m = 0.01;       ///< what one unit of the file is
  UpAxis up = UpAxis::y;      ///< (x, y, z) with z up becomes (x, z, −y)
  std::string order = "ZXY";  ///< of the turns: each letter once
};

/// Writes the bodies of a recording that form a skeleton. Each angle follows on from the one before it: what turns beyond 180° does
/// not jump. Joints that shift by more than 0.1 mm get position channels. Needs all of it, so that memory grows with the length.
std::unique_ptr<Sink> create_bvh(const std::string& path, const BvhDialect& dialect = {});

}  // namespace marey::format::skeleton
