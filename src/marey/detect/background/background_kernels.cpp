#include "marey/detect/background/background_kernels.h"

#include <cstddef>

#include "marey/detect/background/background_kernels.inc"

namespace marey::detect::background {

const BackgroundKernels& background_kernels_baseline() {
  return kKernels;
}

const BackgroundKernels& background_kernels() {
#ifdef MAREY_HAS_AVX2_KERNELS
  static const bool avx2 = __builtin_cpu_supports("avx2") != 0;
  if (avx2) return background_kernels_avx2();
#endif
  return kKernels;
}

}  // namespace marey::detect::background
