/* libcommon/lang/things.vectors from the uses of libcommon/lang/things.tsv:
 *
 *	fit_things TEXT OUT
 *
 * TEXT is of text-encode, a sentence a use, whose object is the number of its line in the table, from 0 on:
 * `make -f pipelines/parse.mk things` makes both. OUT (lang/things_vectors.h) has for each line the mean of
 * its uses' directions. */
#include "base/mem.h"
#include "formats/scene/text.h"
#include "lang/things.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { MOST = 127 };

static _Noreturn void fail(const char *message)
{
	fprintf(stderr, "fit_things: %s\n", message);
	exit(4);
}

static int count_rows(void)
{
	size_t length;
	int n = 0;

	while (things_text(n, THINGS_NAMES, &length))
		n++;
	return n;
}

/* mean (rows,width) of the directions of each line's sentences. */
static void add(const struct text *t, int rows, double *mean)
{
	const size_t width = (size_t)t->width;

	for (size_t i = 0; i < t->n; i++) {
		const float *x = t->sentences + i * width;
		const long row = strtol(t->objects[i], NULL, 10);
		double square = 0;
		for (size_t d = 0; d < width; d++)
			square += (double)x[d] * (double)x[d];
		if (row < 0 || row >= rows || !(square > 0))
			fail("a sentence is of no line of the table");
		for (size_t d = 0; d < width; d++)
			mean[(size_t)row * width + d] += (double)x[d] / sqrt(square);
	}
}

static void put(FILE *out, const double *mean, int width)
{
	double most = 0;

	for (int d = 0; d < width; d++)
		most = fmax(most, fabs(mean[d]));
	if (!(most > 0))
		fail("a line of the table has no uses");
	for (int d = 0; d < width; d++)
		fputc((unsigned char)(signed char)lround(MOST * mean[d] / most), out);
}

int main(int argc, char **argv)
{
	struct text t;
	struct err e;

	if (argc != 3)
		fail("usage: fit_things TEXT OUT");
	if (text_read(&t, argv[1], &e))
		fail(e.message);
	const int rows = count_rows();
	double *mean = mem_zalloc((size_t)rows * (size_t)t.width, sizeof *mean, "things", &e);
	FILE *out = fopen(argv[2], "wb");
	if (!mean || !out)
		fail("cannot write");
	add(&t, rows, mean);
	fprintf(out, "refer.things 1 %s %d %d %08" PRIx32 "\n", t.encoder.hex, rows, t.width, things_hash());
	for (int r = 0; r < rows; r++)
		put(out, mean + (size_t)r * (size_t)t.width, t.width);
	if (fclose(out))
		fail("cannot write");
	free(mean);
	text_free(&t);
	return 0;
}
