#define MAREY_KERNEL_LEVEL marker_kernels_avx512
#define MAREY_KERNEL_NAME "avx512"
#include "marey/detect/markers/marker_kernel.inl"
