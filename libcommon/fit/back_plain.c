#include "fit/back_kernel.h"

const struct back_kernels back_plain = {back_tile};
