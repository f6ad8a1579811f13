/* How far apart response maps are: the root of the mean square of the differences, over all values of pairs
 *of .npy files.
 *
 *	bench_rms A B FILE...
 *
 * compares A/FILE with B/FILE. "relative" is the rms of the differences over that of A's values. */
#include "base/file.h"
#include "base/mem.h"
#include "cli/cli.h"
#include "formats/arrays/npy.h"

#include <math.h>
#include <stdlib.h>

static const struct cli_option table[] = {{0}};

static const struct cli_tool tool = {.name = "bench_rms",
	.operands = "A B FILE...",
	.summary = "Print how far apart the .npy files of two folders are, JSON.",
	.options = table,
	.min_operands = 3,
	.max_operands = -1};

struct sums {
	double values, squares, differences;
};

static int read_in(struct npy *a, const char *dir, const char *name, struct err *e)
{
	char *path = file_join(dir, name, "", e);
	const int bad = !path || npy_read(a, path, e) ? -1 : 0;

	free(path);
	return bad;
}

static int compare(struct sums *s, const char *const dirs[2], const char *name, struct err *e)
{
	struct npy a = {0}, b = {0};
	int bad = read_in(&a, dirs[0], name, e) || read_in(&b, dirs[1], name, e);

	if (!bad && a.count != b.count)
		bad = err_set(e, ERR_FORMAT, "%s: %zu values in %s, %zu in %s", name, a.count, dirs[0],
			b.count, dirs[1]);
	for (size_t i = 0; i < a.count && !bad; i++) {
		const double x = (double)a.values[i], d = x - (double)b.values[i];
		s->values++;
		s->squares += x * x;
		s->differences += d * d;
	}
	npy_free(&a);
	npy_free(&b);
	return bad ? -1 : 0;
}

int main(int argc, char **argv)
{
	struct sums s = {0};
	struct err e;
	struct cli c;

	cli_parse(&c, &tool, argc, argv);
	for (int i = 2; i < c.operand_count; i++)
		if (compare(&s, c.operands, c.operands[i], &e))
			return cli_fail(&c, &e);
	printf("{\"values\":%.0f,\"rms\":%.6g,\"relative\":%.6g}\n", s.values, sqrt(s.differences / s.values),
		sqrt(s.differences / s.squares));
	return 0;
}
