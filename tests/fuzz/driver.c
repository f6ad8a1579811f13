#include "fuzz.h"

#include "base/mem.h"
#include "base/rng.h"

#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

enum { MAX_LEN = 8192, MAX_RUNS = 30000, MAX_SECONDS = 3 };

/* Bytes that matter to some format. */
static const char *const words[] = {"\"", "{", "}", "[", "]", ",", ":", "-", ".", "e9", "null", "true",
	"\\u0000", "\n", "\xff", "\x80", "0", "1", "99999999999999999999", "4294967295", "-1", "1e308", "nan",
	"{}", "[]", "\"\"", " ", "[[[[[[[["};

static size_t mutate(struct rng *r, unsigned char *data, size_t len)
{
	size_t at = len ? rng_below(r, (uint32_t)len) : 0, count;
	const char *word;

	switch (rng_below(r, 7)) {
	case 0: /* another byte */
		if (len)
			data[at] = (unsigned char)rng_u32(r);
		return len;
	case 1: /* one bit */
		if (len)
			data[at] ^= (unsigned char)(1u << rng_below(r, 8));
		return len;
	case 2: /* cut off the end */
		return at;
	case 3: /* leave some out */
		count = rng_below(r, 1 + (uint32_t)(len - at < 16 ? len - at : 16));
		memmove(data + at, data + at + count, len - at - count);
		return len - count;
	case 4: /* say some twice */
		count = rng_below(r, 1 + (uint32_t)(len - at < 64 ? len - at : 64));
		if (len + count > MAX_LEN)
			return len;
		memmove(data + at + count, data + at, len - at);
		return len + count;
	case 5: /* a word over what is there */
		word = words[rng_below(r, sizeof words / sizeof *words)];
		count = strlen(word);
		if (at + count <= len)
			memcpy(data + at, word, count);
		return len;
	default: /* a word between */
		word = words[rng_below(r, sizeof words / sizeof *words)];
		count = strlen(word);
		if (len + count > MAX_LEN)
			return len;
		memmove(data + at + count, data + at, len - at);
		memcpy(data + at, word, count);
		return len + count;
	}
}

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
			len = mutate(&r, data, len);
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
