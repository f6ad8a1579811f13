#if defined __x86_64__
#pragma GCC target("avx512f,avx512dq,avx512bw,avx512vl,avx2,fma,popcnt,bmi")
#include "fit/back_kernel.h"

const struct back_kernels back_avx512 = {back_tile};
#endif
