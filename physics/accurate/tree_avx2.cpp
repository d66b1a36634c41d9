// Kernels of trees in AVX2 registers: compiled with -mavx2, called where the processor has it.
#define KERNELS kTreeKernelsAvx2
#include "physics/accurate/tree_kernels.h"
