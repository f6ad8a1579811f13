#include "fuzz.h"
#include "mutate.h"

#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

enum { MAX_LEN = 8192, MAX_RUNS = 30000, MAX_SECONDS = 3 };

/* Not opened with O_TRUNC: some file systems then write to the disk at every close. */
static int write_input(int fd, const void *data, size_t len)
{
	return pwrite(fd, data, len, 0) != (ssize_t)len || ftruncate(fd, (off_t)len);
}

int main(void)
{
	static unsigned char data[MAX_LEN];
	char path[] = "/tmp/refersplat-fuzz-XXXXXX";
	int fd = mkstemp(path), accepted = 0, runs = 0, failed = 0;
	time_t end = time(NULL) + MAX_SECONDS;
	struct rng r;

	if (fd < 0)
		return 1;
	for (size_t i = 0; i < fuzz_seed_count; i++)
		if (write_input(fd, fuzz_seeds[i].data, fuzz_seeds[i].len) || fuzz_one(path)) {
			fprintf(stderr, "failed: seed %zu is not accepted\n", i);
			failed++;
		}
	rng_seed(&r, 1, 1);
	while (runs < MAX_RUNS && time(NULL) < end && !failed) {
		const struct fuzz_seed *seed = &fuzz_seeds[rng_below(&r, (uint32_t)fuzz_seed_count)];
		size_t len = seed->len;
		memcpy(data, seed->data, len);
		for (uint32_t n = 1 + rng_below(&r, 4); n; n--)
			len = mutate(&r, data, len, MAX_LEN);
		failed += write_input(fd, data, len);
		accepted += !fuzz_one(path);
		runs++;
	}
	close(fd);
	unlink(path);
	/* Where all or none passed, the inputs were not at the border that they should be at. */
	if (!failed && (accepted == 0 || accepted == runs)) {
		fprintf(stderr, "failed: %d of %d broken inputs were accepted\n", accepted, runs);
		failed++;
	}
	fprintf(stderr, "%d inputs, %d accepted\n", runs, accepted);
	printf("%d passed, %d failed\n", !failed, failed);
	return failed != 0;
}
