// Products of blocks in two SSE2 halves: what every x86-64 has.
#define KERNELS kBlockKernelsSse2
#include "physics/solver/block_kernels.h"
