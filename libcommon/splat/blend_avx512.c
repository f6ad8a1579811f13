#if defined __x86_64__
#pragma GCC target("avx512f,avx512dq,avx512bw,avx512vl,avx2,fma,popcnt,bmi")
#define BLEND_TABLE blend_avx512
#include "splat/blend_kernel.h"
#endif
