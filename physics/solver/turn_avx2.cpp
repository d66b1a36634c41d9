// Turns of joints in AVX2 registers: compiled with -mavx2, called where the processor has it.
#define KERNELS kTurnKernelsAvx2
#include "physics/solver/turn_kernels.h"
