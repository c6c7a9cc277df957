#pragma once

namespace marey::detect::network {

/// From now on OpenCV's dnn computes convolutions by channel of 3 × 3 and 5 × 5 taps, and those of 1 × 1, with our own loops, in
/// this whole process; all others as before. They are most of what networks for small processors do. Once is enough.
void use_own_convolutions();

}  // namespace marey::detect::network
