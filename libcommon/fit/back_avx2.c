#if defined __x86_64__
#pragma GCC target("avx2,fma,popcnt,bmi")
#include "fit/back_kernel.h"

const struct back_kernels back_avx2 = {back_tile};
#endif
