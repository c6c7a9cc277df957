#define MAREY_KERNEL_LEVEL marker_kernels_avx2
#define MAREY_KERNEL_NAME "avx2"
#include "marey/detect/markers/marker_kernel.inl"
