#if defined __x86_64__
#pragma GCC target("avx2,fma")
#define BLOCK_ISA avx2
#include "field/block_kernel.h"
#endif
