#include "marey/detect/markers/marker_kernel.h"

#include <array>

namespace marey::detect::markers {

extern const MarkerKernels marker_kernels_baseline;
#if defined(__x86_64__)
extern const MarkerKernels marker_kernels_avx2;
extern const MarkerKernels marker_kernels_avx512;
#endif

std::span<const MarkerKernels* const> marker_kernels() {
#if defined(__x86_64__)
  static const std::array<const MarkerKernels*, 3> all{&marker_kernels_baseline, &marker_kernels_avx2, &marker_kernels_avx512};
  static const std::size_t count = [] {
    if (!__builtin_cpu_supports("avx2")) return 1;
    return __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512vl") ? 3 : 2;
  }();
#else
  static const std::array<const MarkerKernels*, 1> all{&marker_kernels_baseline};
  constexpr std::size_t count = 1;
#endif
  return std::span(all).first(count);
}

}  // namespace marey::detect::markers
