#include "places/object_surface.h"

#include "base/mem.h"
#include "base/quantile.h"
#include "lang/finish.h"

#include <float.h>
#include <math.h>

enum {
	ROUNDS = 12,
	BINS = 24,  /* along an axis */
	TURNS = 8,  /* level axes, of half a turn */
	CELLS = 10, /* along the longest axis */
	SIDE = CELLS + 3,
	CHANGES = 4, /* from one colour to the other, of stripes */
};

/* Chosen on synthetic scenes, seeds 51 and 52, and looked at on the desk (tests/unit/test_object_surface.c
 * has the cases). hue: L*a*b*, across the line of one colour in light and shade. rough: how much nearer
 * neighbours differ than any two do. */
static const double lightness = 0.5, hue_half = 15, share_least = 0.1, rough_half = 0.45, rough_soft = 0.04,
		    striped_rough = 0.35, along_half = 0.3, prior = 0.25, points_half = 150, thin = 0.002;

static const double pi = 3.14159265358979323846;

/* Two colours of a surface: the means of two clusters, and which of them each point is of. */
struct two_colours {
	double mean[2][3], share[2];
	char *is_second; /* (n) */
};

static double apart(const double a[3], const double b[3])
{
	double sum = 0;

	for (int k = 0; k < 3; k++) {
		const double d = (a[k] - b[k]) * (k ? 1 : lightness);
		sum += d * d;
	}
	return sum;
}

/* The two means to begin with: the colours that are far from one another along the axis of L*a*b* on which
 * they vary most. */
static void begin_colours(
	struct two_colours *c, const struct surface_point *p, size_t n, struct quantile_item *along)
{
	double mean[3] = {0}, square[3] = {0}, total = 0;
	int most = 0;

	for (size_t i = 0; i < n; i++) {
		total += p[i].weight;
		for (int k = 0; k < 3; k++) {
			mean[k] += p[i].weight * p[i].lab[k];
			square[k] += p[i].weight * p[i].lab[k] * p[i].lab[k];
		}
	}
	for (int k = 0; k < 3; k++) {
		mean[k] /= total;
		square[k] = (square[k] / total - mean[k] * mean[k]) * (k ? 1 : lightness * lightness);
		most = square[k] > square[most] ? k : most;
	}
	for (size_t i = 0; i < n; i++)
		along[i] = (struct quantile_item){p[i].lab[most], p[i].weight};
	for (int c2 = 0; c2 < 2; c2++) {
		memcpy(c->mean[c2], mean, sizeof mean);
		c->mean[c2][most] = quantile_weighted(along, n, c2 ? 0.9 : 0.1);
	}
}

static void find_colours(
	struct two_colours *c, const struct surface_point *p, size_t n, struct quantile_item *along)
{
	begin_colours(c, p, n, along);
	for (int round = 0; round < ROUNDS; round++) {
		double sum[2][3] = {{0}}, weight[2] = {0};
		for (size_t i = 0; i < n; i++) {
			const int k = apart(p[i].lab, c->mean[1]) < apart(p[i].lab, c->mean[0]);
			c->is_second[i] = (char)k;
			weight[k] += p[i].weight;
			for (int d = 0; d < 3; d++)
				sum[k][d] += p[i].weight * p[i].lab[d];
		}
		for (int k = 0; k < 2; k++) {
			c->share[k] = weight[k] / (weight[0] + weight[1]);
			for (int d = 0; d < 3 && weight[k] > 0; d++)
				c->mean[k][d] = sum[k][d] / weight[k];
		}
	}
}

/* How far the rarer colour is from the line through black and the other one. */
static double hue_apart(const struct two_colours *c)
{
	const double *most = c->mean[c->share[1] > c->share[0]], *least = c->mean[c->share[1] <= c->share[0]];
	double length = 0, along = 0, sum = 0;

	for (int k = 0; k < 3; k++) {
		length += most[k] * most[k];
		along += most[k] * least[k];
	}
	along /= fmax(length, DBL_MIN);
	for (int k = 0; k < 3; k++)
		sum += (least[k] - along * most[k]) * (least[k] - along * most[k]);
	return sqrt(sum);
}

/* The points along an axis. */
struct axis {
	double of[3], low, length;
};

static double place(const struct axis *a, const struct surface_point *p)
{
	return (a->of[0] * p->at[0] + a->of[1] * p->at[1] + a->of[2] * p->at[2] - a->low) / a->length;
}

/* From two standard deviations below the mean to two above: all of a ball, a disc or a bar. */
static void measure_axis(struct axis *a, const struct surface_point *p, size_t n)
{
	double sum = 0, squares = 0, total = 0;

	a->low = 0;
	a->length = 1;
	for (size_t i = 0; i < n; i++) {
		const double x = place(a, &p[i]) - place(a, &p[0]);
		total += p[i].weight;
		sum += p[i].weight * x;
		squares += p[i].weight * x * x;
	}
	const double mean = sum / total, deviation = sqrt(fmax(squares / total - mean * mean, 0));
	a->low = place(a, &p[0]) + mean - 2 * deviation;
	a->length = fmax(4 * deviation, DBL_MIN);
}

static int cut(double x, int cells)
{
	return x < 0 ? 0 : x >= cells - 1 ? cells - 1 : (int)x;
}

/* How much of which colour a point has is told by its place along an axis, and how often it changes there. */
struct told {
	double part;
	int changes;
};

static struct told tell_along(
	const struct axis *a, const struct two_colours *c, const struct surface_point *p, size_t n)
{
	double weight[BINS] = {0}, second[BINS] = {0}, total = 0, sum = 0;
	struct told t = {0, 0};
	int last = -1;

	for (size_t i = 0; i < n; i++) {
		const int b = cut(BINS * place(a, &p[i]), BINS);
		weight[b] += p[i].weight;
		second[b] += c->is_second[i] ? p[i].weight : 0;
		total += p[i].weight;
	}
	for (int b = 0; b < BINS; b++) {
		if (weight[b] <= thin * total)
			continue;
		const double share = second[b] / weight[b];
		sum += weight[b] * (share - c->share[1]) * (share - c->share[1]);
		t.changes += last >= 0 && last != (share > 0.5);
		last = share > 0.5;
	}
	t.part = sum / total / fmax(c->share[0] * c->share[1], DBL_MIN);
	return t;
}

/* Two level directions at right angles. */
static void level_axes(const double up[3], double x[3], double y[3])
{
	const int least = fabs(up[0]) < fabs(up[1]) ? (fabs(up[0]) < fabs(up[2]) ? 0 : 2)
						    : (fabs(up[1]) < fabs(up[2]) ? 1 : 2);
	double length = 0;

	for (int k = 0; k < 3; k++) {
		x[k] = (k == least) - up[least] * up[k];
		length += x[k] * x[k];
	}
	for (int k = 0; k < 3; k++)
		x[k] /= sqrt(length);
	for (int k = 0; k < 3; k++)
		y[k] = up[(k + 1) % 3] * x[(k + 2) % 3] - up[(k + 2) % 3] * x[(k + 1) % 3];
}

struct cell {
	double weight, second;
};

/* The variance of the colours of neighbouring cells beside that of all points. axes: up, then two level. */
static double roughness(const struct axis axes[3], const struct two_colours *c, const struct surface_point *p,
	size_t n, struct cell *cells)
{
	static const int step[3] = {1, SIDE, SIDE * SIDE};
	double sum = 0, total = 0, most = 0;

	for (int k = 0; k < 3; k++)
		most = fmax(most, axes[k].length);
	memset(cells, 0, SIDE * SIDE * SIDE * sizeof *cells);
	for (size_t i = 0; i < n; i++) {
		size_t at = 0;
		for (int k = 0; k < 3; k++)
			at += (size_t)(step[k] *
				       cut(CELLS * place(&axes[k], &p[i]) * axes[k].length / most, SIDE - 1));
		cells[at].weight += p[i].weight;
		cells[at].second += c->is_second[i] ? p[i].weight : 0;
	}
	for (int at = 0; at < SIDE * SIDE * SIDE; at++)
		for (int k = 0; k < 3 && cells[at].weight > 0; k++) {
			/* the last of a side is empty */
			const struct cell *a = &cells[at];
			if (at + step[k] >= SIDE * SIDE * SIDE || !(cells[at + step[k]].weight > 0))
				continue;
			const struct cell *b = &cells[at + step[k]];
			const double d = a->second / a->weight - b->second / b->weight,
				     w = fmin(a->weight, b->weight);
			sum += w * d * d;
			total += w;
		}
	return sum / fmax(total, DBL_MIN) / fmax(2 * c->share[0] * c->share[1], DBL_MIN);
}

static double soft(double x)
{
	return 1 / (1 + exp(-x));
}

static void judge(struct surface *s, const struct two_colours *c, const struct surface_point *p, size_t n,
	const double up[3], struct cell *cells)
{
	struct axis axes[3] = {{{up[0], up[1], up[2]}, 0, 0}};
	double x[3], y[3], striped = 0, part = 0;

	level_axes(up, x, y);
	for (int t = -1; t < TURNS; t++) {
		struct axis a = axes[0];
		for (int k = 0; k < 3 && t >= 0; k++)
			a.of[k] = cos(pi * t / TURNS) * x[k] + sin(pi * t / TURNS) * y[k];
		measure_axis(&a, p, n);
		const struct told told = tell_along(&a, c, p, n);
		if (told.changes >= CHANGES)
			striped = fmax(striped, told.part);
		else
			part = fmax(part, told.part);
		if (t < 1 || t == TURNS / 2)
			axes[t < 0 ? 0 : t ? 2 : 1] = a;
	}
	const double hue = hue_apart(c), rough = roughness(axes, c, p, n, cells);
	const double other = hue * hue / (hue * hue + hue_half * hue_half) *
			     fmin(1, fmin(c->share[0], c->share[1]) / share_least);
	const double along_axis = striped * striped / (striped * striped + along_half * along_half);
	const double patterned = fmax(fmax(other * (1 - part), soft((rough - rough_half) / rough_soft)),
		along_axis * soft((rough - striped_rough) / rough_soft));
	const double known = (double)n / ((double)n + points_half);

	s->stripes = known * patterned * along_axis + (1 - known) * prior;
	s->spots = known * patterned * (1 - along_axis) + (1 - known) * prior;
}

int surface_find(
	struct surface *s, const struct surface_point *points, size_t n, const double up[3], struct err *e)
{
	struct two_colours c = {.is_second = mem_alloc(n + 1, 1, "surfaces", e)};
	struct quantile_item *along = mem_alloc(n + 1, sizeof *along, "surfaces", e);
	struct cell *cells = mem_alloc(SIDE * SIDE * SIDE, sizeof *cells, "surfaces", e);
	const int bad = !c.is_second || !along || !cells;

	s->stripes = s->spots = prior;
	if (!bad && n > 1) {
		find_colours(&c, points, n, along);
		judge(s, &c, points, n, up, cells);
	}
	free(c.is_second);
	free(along);
	free(cells);
	return bad ? -1 : 0;
}

void surface_set_gloss(struct surface *s, double low, double high)
{
	const double x = s->view_dependence;

	s->gloss = x > 0 ? fmax(-1, fmin(1, log2(x / sqrt(low * high)))) : 0;
}

/* -1 where P is 0, 0 where it is as great as before, 1 where it is 1. */
static double evidence(double p, double before)
{
	return p > before ? (p - before) / (1 - before) : p / before - 1;
}

double surface_fits(const struct surface *s, int finish)
{
	switch (finish) {
	case FINISH_STRIPES:
		return evidence(s->stripes, prior);
	case FINISH_SPOTS:
		return evidence(s->spots, prior);
	case FINISH_PLAIN:
		return evidence(1 - s->stripes - s->spots, 1 - 2 * prior);
	case FINISH_SHINY:
		return s->gloss;
	case FINISH_DULL:
		return -s->gloss;
	default:
		return 0;
	}
}
