#define BLOCK_ISA plain
#include "refer/block_kernel.h"
