#include "splat/project_kernel.h"
#include "splat/blend_kernel.h"

const struct kernels kernels_plain = {project_batch, blend_values, blend_counts, blend_weights};
