#if defined __x86_64__
#pragma GCC target("avx2,fma,popcnt,bmi")
#define BLEND_TABLE blend_avx2
#include "splat/blend_kernel.h"
#endif
