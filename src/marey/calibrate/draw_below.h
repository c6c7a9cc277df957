#pragma once

#include <cstddef>
#include <random>

namespace marey::calibrate {

/// A uniform integer below `end`, the same on every machine.
inline std::size_t draw_below(std::mt19937_64& engine, std::size_t end) {
  return static_cast<std::size_t>(static_cast<double>(engine() >> 11) * 0x1.0p-53 * static_cast<double>(end));
}

}  // namespace marey::calibrate
