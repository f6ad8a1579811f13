#include "splat/palette.h"

#include "base/compare.h"
#include "base/mem.h"

#include <math.h>

/* Lloyd's iterations: then a real scene's codes move by less than a hundredth of their distance. */
enum { ITERATIONS = 30, BINS = 4096 };

int palette_code(const double codes[PALETTE_CODES], double value)
{
	int low = 0, high = PALETTE_CODES - 1;

	while (low < high) {
		const int middle = (low + high) / 2;
		if (value > (codes[middle] + codes[middle + 1]) / 2)
			low = middle + 1;
		else
			high = middle;
	}
	return low;
}

/* Of sorted values, how many are at most `limit`. */
static size_t count_below(const float *sorted, size_t n, double limit)
{
	size_t low = 0, high = n;

	while (low < high) {
		const size_t middle = low + (high - low) / 2;
		if (sorted[middle] <= limit)
			low = middle + 1;
		else
			high = middle;
	}
	return low;
}

/* sums (n + 1) of the first so many sorted values. A code that no value is nearest to stays. */
static void improve(double codes[PALETTE_CODES], const float *sorted, const double *sums, size_t n)
{
	double better[PALETTE_CODES];
	size_t begin = 0;

	for (int k = 0; k < PALETTE_CODES; k++) {
		const size_t end =
			k + 1 < PALETTE_CODES ? count_below(sorted, n, (codes[k] + codes[k + 1]) / 2) : n;
		better[k] = end > begin ? (sums[end] - sums[begin]) / (double)(end - begin) : codes[k];
		begin = end > begin ? end : begin;
	}
	memcpy(codes, better, sizeof better);
}

/* The different ones of sorted values, where they are no more than codes; else 0. */
static int take_different(double codes[PALETTE_CODES], const float *sorted, size_t n)
{
	int count = 0;

	for (size_t i = 0; i < n; i++) {
		if (i && sorted[i] == sorted[i - 1])
			continue;
		if (count == PALETTE_CODES)
			return 0;
		codes[count++] = (double)sorted[i];
	}
	for (; count < PALETTE_CODES; count++)
		codes[count] = count ? codes[count - 1] : 0;
	return 1;
}

/* The best cut of values into sets that follow each other: by bins between the least and the largest value,
 * of which a set has whole ones (Fisher's dynamic program). least[b]: the squared error of the first b bins
 * in as many sets as there are so far. */
struct partition {
	double counts[BINS + 1], sums[BINS + 1], squares[BINS + 1]; /* of the first so many bins */
	double least[BINS + 1], next[BINS + 1];
	uint16_t starts[PALETTE_CODES][BINS + 1]; /* where the last set begins */
};

static double error_between(const struct partition *p, int from, int to)
{
	const double n = p->counts[to] - p->counts[from], sum = p->sums[to] - p->sums[from];

	return n > 0 ? fmax(0, p->squares[to] - p->squares[from] - sum * sum / n) : 0;
}

/* One more set, for the first `low` to `high` bins. The last set of more bins begins no earlier, so that each
 * half has only a part of the places to try. */
static void add_set(struct partition *p, int set, int low, int high, int from, int to)
{
	while (low <= high) {
		const int middle = (low + high) / 2, last = to < middle ? to : middle;
		double best = INFINITY;
		int start = from;
		for (int b = from; b <= last; b++) {
			const double error = p->least[b] + error_between(p, b, middle);
			if (error < best) {
				best = error;
				start = b;
			}
		}
		p->next[middle] = best;
		p->starts[set][middle] = (uint16_t)start;
		add_set(p, set, low, middle - 1, from, start);
		low = middle + 1;
		from = start;
	}
}

static void fill_bins(struct partition *p, const float *sorted, size_t n)
{
	const double low = (double)sorted[0], step = ((double)sorted[n - 1] - low) / BINS;
	size_t at = 0;

	memset(p, 0, sizeof *p);
	for (int b = 0; b < BINS; b++) {
		const size_t end = b + 1 < BINS ? count_below(sorted, n, low + step * (b + 1)) : n;
		p->counts[b + 1] = (double)end;
		p->sums[b + 1] = p->sums[b];
		p->squares[b + 1] = p->squares[b];
		for (; at < end; at++) {
			const double x = (double)sorted[at] - low;
			p->sums[b + 1] += x;
			p->squares[b + 1] += x * x;
		}
	}
}

/* The means of the best sets. An empty one has the code after it. */
static int cut_best(double codes[PALETTE_CODES], const float *sorted, size_t n, struct err *e)
{
	SCOPED struct partition *p = mem_alloc(1, sizeof *p, "codebook", e);
	int end = BINS;

	if (!p)
		return -1;
	fill_bins(p, sorted, n);
	for (int b = 0; b <= BINS; b++)
		p->least[b] = error_between(p, 0, b);
	for (int set = 1; set < PALETTE_CODES; set++) {
		add_set(p, set, 0, BINS, 0, BINS);
		memcpy(p->least, p->next, sizeof p->least);
	}
	for (int set = PALETTE_CODES - 1; set >= 0; set--) {
		const int start = set ? p->starts[set][end] : 0;
		const double count = p->counts[end] - p->counts[start];
		codes[set] = count > 0 ? (double)sorted[0] + (p->sums[end] - p->sums[start]) / count
			     : set + 1 < PALETTE_CODES ? codes[set + 1]
						       : (double)sorted[n - 1];
		end = start;
	}
	return 0;
}

int palette_codebook(double codes[PALETTE_CODES], const float *values, size_t n, struct err *e)
{
	SCOPED float *sorted = mem_alloc(n, sizeof *sorted, "codebook", e);
	SCOPED double *sums = sorted ? mem_alloc(n + 1, sizeof *sums, "codebook", e) : NULL;

	if (sums) {
		memcpy(sorted, values, n * sizeof *sorted);
		qsort(sorted, n, sizeof *sorted, compare_float);
		sums[0] = 0;
		for (size_t i = 0; i < n; i++)
			sums[i + 1] = sums[i] + (double)sorted[i];
	}
	int bad = !sums;
	if (!bad && !take_different(codes, sorted, n)) {
		bad = cut_best(codes, sorted, n, e);
		for (int i = 0; i < ITERATIONS && !bad; i++)
			improve(codes, sorted, sums, n);
	}
	return bad ? -1 : 0;
}

/* A set of rows: ids[begin] to ids[end - 1]. */
struct set {
	size_t begin, end;
	double error;
	size_t column; /* of the largest variance */
	double mean;   /* in it */
};

/* All that the palette is made with; sets (count) are a heap, the largest error first. */
struct cutting {
	const float *rows;
	size_t width, count, *ids;
	struct set *sets;
	double *sums; /* (2, width) */
};

static void measure(const struct cutting *c, struct set *s)
{
	double *sum = c->sums, *squares = c->sums + c->width, most = -1;
	const double n = (double)(s->end - s->begin);

	memset(c->sums, 0, 2 * c->width * sizeof *c->sums);
	for (size_t i = s->begin; i < s->end; i++)
		for (size_t k = 0; k < c->width; k++) {
			const double x = (double)c->rows[c->ids[i] * c->width + k];
			sum[k] += x;
			squares[k] += x * x;
		}
	s->error = 0;
	for (size_t k = 0; k < c->width; k++) {
		const double off = squares[k] - sum[k] * sum[k] / n;
		s->error += off > 0 ? off : 0;
		if (off > most) {
			most = off;
			s->column = k;
			s->mean = sum[k] / n;
		}
	}
}

/* Places a set that belongs at `at` or below. */
static void sink(struct cutting *c, size_t at, struct set s)
{
	for (;;) {
		size_t child = 2 * at + 1;
		if (child + 1 < c->count && c->sets[child + 1].error > c->sets[child].error)
			child++;
		if (child >= c->count || c->sets[child].error <= s.error)
			break;
		c->sets[at] = c->sets[child];
		at = child;
	}
	c->sets[at] = s;
}

static void add(struct cutting *c, struct set s)
{
	size_t at = c->count++;

	for (; at && c->sets[(at - 1) / 2].error < s.error; at = (at - 1) / 2)
		c->sets[at] = c->sets[(at - 1) / 2];
	c->sets[at] = s;
}

/* Cuts the set with the largest error; 0 where nothing is left to cut. */
static int cut(struct cutting *c)
{
	struct set low = c->sets[0], high = low;
	size_t middle = low.begin;

	for (size_t i = low.begin; i < low.end; i++)
		if ((double)c->rows[c->ids[i] * c->width + low.column] <= low.mean) {
			const size_t id = c->ids[i];
			c->ids[i] = c->ids[middle];
			c->ids[middle++] = id;
		}
	if (!(low.error > 0) || middle == low.begin || middle == low.end)
		return 0;
	low.end = high.begin = middle;
	measure(c, &low);
	measure(c, &high);
	sink(c, 0, low);
	add(c, high);
	return 1;
}

static void take_centres(const struct cutting *c, float *centres, uint16_t *labels)
{
	for (size_t s = 0; s < c->count; s++) {
		const struct set *set = &c->sets[s];
		memset(c->sums, 0, c->width * sizeof *c->sums);
		for (size_t i = set->begin; i < set->end; i++) {
			labels[c->ids[i]] = (uint16_t)s;
			for (size_t k = 0; k < c->width; k++)
				c->sums[k] += (double)c->rows[c->ids[i] * c->width + k];
		}
		for (size_t k = 0; k < c->width; k++)
			centres[s * c->width + k] = (float)(c->sums[k] / (double)(set->end - set->begin));
	}
}

int palette_rows(float *centres, size_t *k, uint16_t *labels, const float *rows, size_t n, size_t width,
	size_t most, struct err *e)
{
	struct cutting c = {.rows = rows, .width = width};

	c.ids = mem_alloc(n, sizeof *c.ids, "palette", e);
	c.sets = mem_alloc(most, sizeof *c.sets, "palette", e);
	c.sums = mem_alloc(2 * width, sizeof *c.sums, "palette", e);
	const int bad = !c.ids || !c.sets || !c.sums;
	if (!bad && n) {
		struct set all = {.end = n};
		for (size_t i = 0; i < n; i++)
			c.ids[i] = i;
		measure(&c, &all);
		add(&c, all);
		while (c.count < most && cut(&c))
			;
		take_centres(&c, centres, labels);
	}
	*k = c.count;
	mem_free_all(c.ids, c.sets, c.sums);
	return bad ? -1 : 0;
}
