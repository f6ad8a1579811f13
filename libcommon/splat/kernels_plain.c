#include "splat/project_kernel.h"
#include "splat/blend_kernel.h"
#include "splat/prune_kernel.h"

const struct kernels kernels_plain = {project_batch, blend_values, blend_counts, blend_rows, prune_rows};
