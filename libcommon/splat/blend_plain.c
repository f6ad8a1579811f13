#define BLEND_TABLE blend_plain
#include "splat/blend_kernel.h"
