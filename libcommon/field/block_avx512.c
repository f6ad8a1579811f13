#if defined __x86_64__
#pragma GCC target("avx512f,avx512dq,avx512bw,avx512vl,avx2,fma")
#define BLOCK_ISA avx512
#include "field/block_kernel.h"
#endif
