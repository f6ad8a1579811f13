#include "score/score_rows.h"

#include "base/mem.h"

const char *const score_unit_name[] = {"", "objects", "pairs"};

/* Ratios of a row, in the order of a unit's sums. */
enum { MIOU, OIOU, OTHER_MIOU, OTHER_OIOU, DIFFERENCE, RATIOS };

/* The end of the pairs of the object at `begin`. */
static size_t object_end(const struct score_sample *s, size_t begin)
{
	size_t end = begin;

	while (end < s->n && !strcmp(s->pairs[end].object, s->pairs[begin].object))
		end++;
	return end;
}

/* Objects that have something in their truth. */
static size_t count_objects(const struct score_sample *s)
{
	size_t count = 0;

	for (size_t begin = 0, end; begin < s->n; begin = end) {
		int is_scored = 0;
		end = object_end(s, begin);
		for (size_t i = begin; i < end && !is_scored; i++)
			is_scored = !s->pairs[i].is_empty;
		count += (size_t)is_scored;
	}
	return count;
}

/* Adds a pair to its unit's sums (ratios,2): numerators and denominators. */
static void add_pair(double (*sums)[2], const struct score_sample *s, size_t i)
{
	const struct score_pair *own = &s->pairs[i], *other = s->other ? &s->other[i] : NULL;

	sums[MIOU][0] += own->iou;
	sums[MIOU][1] += 1;
	sums[OIOU][0] += (double)own->intersection;
	sums[OIOU][1] += (double)own->either;
	if (!other)
		return;
	sums[OTHER_MIOU][0] += other->iou;
	sums[OTHER_MIOU][1] += 1;
	sums[OTHER_OIOU][0] += (double)other->intersection;
	sums[OTHER_OIOU][1] += (double)other->either;
	sums[DIFFERENCE][0] += own->iou - other->iou;
	sums[DIFFERENCE][1] += 1;
}

/* Fills sums (units,ratios,2), zeroed, and *differences (units) with the numerators of DIFFERENCE. */
static void sum_units(
	double *sums, double *differences, const struct score_sample *s, enum score_unit unit, size_t ratios)
{
	size_t at = 0;

	for (size_t begin = 0, end; begin < s->n; begin = end) {
		size_t counted = 0;
		end = unit == SCORE_UNIT_OBJECTS ? object_end(s, begin) : begin + 1;
		double(*own)[2] = (double(*)[2])(sums + at * ratios * 2);
		for (size_t i = begin; i < end; i++) {
			if (s->pairs[i].is_empty)
				continue;
			add_pair(own, s, i);
			counted++;
		}
		if (!counted)
			continue;
		if (s->other)
			differences[at] = own[DIFFERENCE][0];
		at++;
	}
}

static int add_intervals(struct score_row *row, const struct score_sample *s, struct err *e)
{
	const size_t objects = count_objects(s), ratios = s->other ? RATIOS : OIOU + 1;
	const enum score_unit unit = objects >= SCORE_LEAST_OBJECTS ? SCORE_UNIT_OBJECTS : SCORE_UNIT_PAIRS;
	const size_t units = unit == SCORE_UNIT_OBJECTS ? objects : row->score.pairs;
	struct interval intervals[RATIOS] = {{0}};

	if (units < 2)
		return 0;
	row->unit = unit;
	row->units = units;
	SCOPED double *sums = mem_zalloc(units, ratios * 2 * sizeof *sums, "pairs", e);
	SCOPED double *differences = mem_zalloc(units, sizeof *differences, "pairs", e);
	int bad = !sums || !differences;
	if (!bad) {
		sum_units(sums, differences, s, unit, ratios);
		bad = bootstrap_ratios(intervals, sums, units, ratios, s->how, e) ||
		      (s->other && bootstrap_sign_test(&row->other.p, differences, units, s->how, e));
	}
	row->miou = intervals[MIOU];
	row->oiou = intervals[OIOU];
	row->other.miou = intervals[OTHER_MIOU];
	row->other.oiou = intervals[OTHER_OIOU];
	row->other.range = intervals[DIFFERENCE];
	return bad ? -1 : 0;
}

static void compare(struct score_compared *c, const struct score_sample *s)
{
	double sum = 0;

	score_sum(&c->score, s->other, s->n);
	for (size_t i = 0; i < s->n; i++) {
		if (s->pairs[i].is_empty)
			continue;
		const double more = s->pairs[i].iou - s->other[i].iou;
		c->better += more > 0;
		c->worse += more < 0;
		c->equal += more == 0;
		sum += more;
	}
	c->difference = c->score.pairs ? sum / (double)c->score.pairs : 0;
}

int score_row_make(struct score_row *row, const char *name, const struct score_sample *s, struct err *e)
{
	*row = (struct score_row){.name = name};
	score_sum(&row->score, s->pairs, s->n);
	if (s->other)
		compare(&row->other, s);
	return s->how ? add_intervals(row, s, e) : 0;
}

static int table_add(struct score_table *t, const char *name, const struct score_sample *s, struct err *e)
{
	if (mem_grow((void **)&t->rows, &t->capacity, t->n + 1, sizeof *t->rows, "scores", e))
		return -1;
	if (score_row_make(&t->rows[t->n], name, s, e))
		return -1;
	t->n++;
	return 0;
}

void score_table_free(struct score_table *t)
{
	free(t->rows);
	*t = (struct score_table){0};
}

int score_table_objects(struct score_table *t, const struct score_sample *s, struct err *e)
{
	*t = (struct score_table){0};
	for (size_t begin = 0, end; begin < s->n; begin = end) {
		end = object_end(s, begin);
		struct score_sample one = {
			end - begin, s->pairs + begin, s->other ? s->other + begin : NULL, s->how};
		if (table_add(t, s->pairs[begin].object, &one, e))
			return -1;
	}
	return 0;
}

/* The pairs of a bit, in their order, into room for all of them. */
static size_t choose(
	struct score_pair *to, const struct score_pair *from, size_t n, const uint32_t *sets, uint32_t bit)
{
	size_t kept = 0;

	for (size_t i = 0; i < n && from; i++)
		if (sets[i] & bit)
			to[kept++] = from[i];
	return kept;
}

int score_table_groups(struct score_table *t, const struct score_sample *s, const uint32_t *sets,
	const char *const *names, size_t count, uint32_t always, struct err *e)
{
	SCOPED struct score_pair *own = mem_alloc(s->n, sizeof *own, "pairs", e);
	SCOPED struct score_pair *other = mem_alloc(s->other ? s->n : 0, sizeof *other, "pairs", e);
	int bad = !own || !other;

	*t = (struct score_table){0};
	for (size_t g = 0; g < count && !bad; g++) {
		const uint32_t bit = (uint32_t)1 << g;
		struct score_sample one = {
			choose(own, s->pairs, s->n, sets, bit), own, s->other ? other : NULL, s->how};
		choose(other, s->other, s->n, sets, bit);
		if (one.n || always & bit)
			bad = table_add(t, names[g], &one, e);
	}
	return bad ? -1 : 0;
}
