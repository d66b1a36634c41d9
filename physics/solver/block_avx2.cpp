// Products of blocks in AVX2 registers: compiled with -mavx2, called where the processor has it.
#define KERNELS kBlockKernelsAvx2
#include "physics/solver/block_kernels.h"
