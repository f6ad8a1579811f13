#include "cmd/report/reporting.h"

#include "base/mem.h"
#include "formats/splats/splat.h"

#include <stdlib.h>

struct shown {
	size_t gaussian, group;
	double size; /* opacity times area */
};

static int largest_first(const void *a, const void *b)
{
	const struct shown *x = a, *y = b;

	if (x->size != y->size)
		return x->size > y->size ? -1 : 1;
	return (x->gaussian > y->gaussian) - (x->gaussian < y->gaussian);
}

static int by_group(const void *a, const void *b)
{
	const struct shown *x = a, *y = b;

	return x->group != y->group ? (x->group > y->group) - (x->group < y->group) : largest_first(a, b);
}

/* groups (N): 1 + the object that has most of each Gaussian, where that is more than LIFTED_CUT; else 0. */
static int find_groups(const struct report_run *r, size_t *groups, struct err *e)
{
	const struct lifted *l = &r->lifted.lifted;
	SCOPED float *best = mem_zalloc(r->scene.splats.n, sizeof *best, "splats", e);

	if (!best)
		return -1;
	for (size_t o = 0; r->has_lifted && o < l->objects; o++)
		for (int64_t k = l->indptr[o]; k < l->indptr[o + 1]; k++) {
			const size_t i = (size_t)l->index[k];
			if (l->share[k] <= LIFTED_CUT || l->share[k] <= best[i])
				continue;
			best[i] = l->share[k];
			groups[i] = 1 + o;
		}
	return 0;
}

/* Those that are seen, the largest first. Returns how many. */
static size_t find_shown(const struct splats *s, const size_t *groups, struct shown *shown)
{
	size_t n = 0;

	for (size_t i = 0; i < s->n; i++) {
		const float *scale = s->scales + 3 * i;
		const double a = (double)scale[0], b = (double)scale[1], c = (double)scale[2];
		const double area =
			a * b > a * c ? (a * b > b * c ? a * b : b * c) : (a * c > b * c ? a * c : b * c);
		if (s->opacities[i] >= REPORT_LEAST_OPACITY)
			shown[n++] = (struct shown){i, groups[i], area * (double)s->opacities[i]};
	}
	qsort(shown, n, sizeof *shown, largest_first);
	return n;
}

/* Drops the low bits of a float's mantissa. */
static void round_float(unsigned char *bytes, int zeros)
{
	for (int k = 0; k < zeros; k++)
		bytes[k] = 0;
}

static void pack(struct report_splats *to, const struct splats *s, const struct shown *shown)
{
	unsigned char one[SPLAT_BYTES];

	for (size_t i = 0; i < to->n; i++) {
		splat_pack(one, s, shown[i].gaussian);
		for (int k = 0; k < 3; k++) {
			round_float(one + 4 * k, 1);
			round_float(one + 12 + 4 * k, 2);
		}
		for (size_t k = 0; k < SPLAT_BYTES; k++)
			to->bytes[k * to->n + i] = one[k];
		to->counts[shown[i].group]++;
	}
}

int report_splats_make(struct report_splats *s, const struct report_run *r, struct err *e)
{
	const struct splats *from = &r->scene.splats;
	SCOPED size_t *groups = mem_zalloc(from->n, sizeof *groups, "splats", e);
	SCOPED struct shown *shown = mem_alloc(from->n, sizeof *shown, "splats", e);

	*s = (struct report_splats){.groups = 1 + (r->has_lifted ? r->lifted.lifted.objects : 0)};
	s->counts = mem_zalloc(s->groups, sizeof *s->counts, "splats", e);
	int bad = !groups || !shown || !s->counts || find_groups(r, groups, e);
	if (!bad) {
		const size_t n = find_shown(from, groups, shown), most = (size_t)r->options->splats;
		s->n = n < most ? n : most;
		qsort(shown, s->n, sizeof *shown, by_group);
		bad = !(s->bytes = mem_alloc(s->n, SPLAT_BYTES, "splats", e));
	}
	if (!bad)
		pack(s, from, shown);
	return bad ? -1 : 0;
}

void report_splats_free(struct report_splats *s)
{
	free(s->counts);
	free(s->bytes);
	*s = (struct report_splats){0};
}
