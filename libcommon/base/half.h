/* IEEE half floats to and from float, rounding to nearest even. */
#pragma once

#include <stdint.h>

float half_to_float(uint16_t h);
uint16_t half_of_float(float f);
