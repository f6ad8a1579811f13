/* The constants of the choice, by name. constants.def has them; the program that fits them
 * (tests/bench/bench_choice.c) compiles the room with constants that vary. */
#pragma once

#ifdef ASK_CONSTANTS_VARY
#define CONSTANT(name, value) extern double name;
#else
#define CONSTANT(name, value) static const double name = value;
#endif
#include "ask/constants.def"
#undef CONSTANT
