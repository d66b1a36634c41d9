// Contact kernels in two SSE2 halves: what every x86-64 has.
#define KERNELS kContactKernelsSse2
#include "physics/solver/contact_table.h"
