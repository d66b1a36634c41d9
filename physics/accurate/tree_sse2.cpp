// Kernels of trees in SSE2 registers.
#define KERNELS kTreeKernelsSse2
#include "physics/accurate/tree_kernels.h"
