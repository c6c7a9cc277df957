// Compiled with -mavx2; see background_kernels.inc.
#include <cstddef>

#include "marey/detect/background/background_kernels.h"
#include "marey/detect/background/background_kernels.inc"

namespace marey::detect::background {

const BackgroundKernels& background_kernels_avx2() {
  return kKernels;
}

}  // namespace marey::detect::background
