#define BLOCK_ISA plain
#include "field/block_kernel.h"
