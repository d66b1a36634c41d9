// Contact kernels in AVX2 registers: compiled with -mavx2, called where the processor has it.
#define KERNELS kContactKernelsAvx2
#include "physics/solver/contact_table.h"
