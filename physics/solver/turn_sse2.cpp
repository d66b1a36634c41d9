// Turns of joints in two SSE2 halves: what every x86-64 has.
#define KERNELS kTurnKernelsSse2
#include "physics/solver/turn_kernels.h"
