#if defined __x86_64__
#pragma GCC target("avx2,fma,popcnt,bmi")
#include "splat/project_kernel.h"
#include "splat/blend_kernel.h"
#include "splat/prune_kernel.h"

const struct kernels kernels_avx2 = {project_batch, blend_values, blend_counts, blend_rows, prune_rows};
#endif
