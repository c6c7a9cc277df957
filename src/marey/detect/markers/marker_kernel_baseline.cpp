#define MAREY_KERNEL_LEVEL marker_kernels_baseline
#define MAREY_KERNEL_NAME "baseline"
#include "marey/detect/markers/marker_kernel.inl"
