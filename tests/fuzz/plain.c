/* Runs a target of reader.c without libFuzzer: usage: reader-NAME SECONDS DIR. The files of DIR are the
 * seeds, which are broken in an order that is the same each time. Prints how many inputs there were. */
#include "mutate.h"

#include "base/file.h"
#include "base/list.h"

#include <dirent.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

int LLVMFuzzerInitialize(int *argc, char ***argv);
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

enum { SEEDS = 64, MORE = 4096 };

struct seed {
	char *data;
	size_t len;
};

static int read_seeds(const char *dir, struct seed *seeds)
{
	struct dirent **names;
	struct err e;
	const int n = scandir(dir, &names, NULL, alphasort);
	int count = 0;

	for (int i = 0; i < n; i++) {
		char *path = names[i]->d_name[0] == '.' ? NULL : file_join(dir, names[i]->d_name, "", &e);
		if (path && count < SEEDS && !file_read(path, &seeds[count].data, &seeds[count].len, &e))
			count++;
		free(path);
		free(names[i]);
	}
	if (n >= 0)
		free(names);
	return count;
}

int main(int argc, char **argv)
{
	struct seed seeds[SEEDS];
	struct rng r;
	long runs = 0;

	LLVMFuzzerInitialize(&argc, &argv);
	const int count = argc == 3 ? read_seeds(argv[2], seeds) : 0;
	if (!count)
		return 2;
	const time_t end = time(NULL) + atol(argv[1]);
	rng_seed(&r, 1, 1);
	for (int i = 0; i < count; i++, runs++)
		LLVMFuzzerTestOneInput((const uint8_t *)seeds[i].data, seeds[i].len);
	do {
		const struct seed *seed = &seeds[rng_below(&r, (uint32_t)count)];
		unsigned char *data = malloc(seed->len + MORE);
		size_t len = seed->len;
		if (!data)
			return 2;
		memcpy(data, seed->data, len);
		for (uint32_t n = 1 + rng_below(&r, 4); n; n--)
			len = mutate(&r, data, len, seed->len + MORE);
		LLVMFuzzerTestOneInput(data, len);
		free(data);
		runs++;
	} while (time(NULL) < end);
	for (int i = 0; i < count; i++)
		free(seeds[i].data);
	printf("stat::number_of_executed_units: %ld\n", runs);
	return 0;
}
