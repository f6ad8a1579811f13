/* Mutation fuzzing without a library: driver.c breaks valid inputs in a fixed order and hands them to a
 * target, which must neither crash nor leak, whatever it says of them. Built and run with the sanitizers. */
#ifndef FUZZ_H
#define FUZZ_H

#include <stddef.h>

struct fuzz_seed {
	const void *data;
	size_t len;
};

/* Each target defines these. Seeds are valid inputs; fuzz_one reads the file `path`, which holds an input,
 * and returns 0 where it was accepted. */
extern const struct fuzz_seed fuzz_seeds[];
extern const size_t fuzz_seed_count;
int fuzz_one(const char *path);

#endif
