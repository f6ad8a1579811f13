#include "lift_twin.h"

#include "base/rng.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static struct view_matrix rows_of(const struct random_view *v)
{
	return (struct view_matrix){H, W, N, {P, N, v->indptr, v->index, v->weight}, NULL};
}

static struct view_matrix make_view(struct random_view *v, struct rng *r)
{
	int64_t n = 0;

	for (int p = 0; p < P; p++) {
		v->indptr[p] = n;
		/* near Gaussians have near numbers, as they would have places */
		for (uint32_t left = rng_below(r, ENTRIES + 1); left; left--, n++) {
			v->index[n] = (int32_t)(((uint32_t)p / 2 + rng_below(r, 30)) % (N - UNSEEN));
			v->weight[n] = (float)(rng_uniform(r) / ENTRIES);
		}
	}
	v->indptr[P] = n;
	return rows_of(v);
}

void lift_add_mask(struct lift_problem *q, int view, size_t object, int from, int to, int times)
{
	const int h = H * times, w = W * times;
	uint8_t *pixels = malloc((size_t)h * (size_t)w);
	struct mask *mask = &q->shown[q->shown_count++];
	struct err e;

	for (int y = 0; y < h; y++)
		for (int x = 0; x < w; x++)
			pixels[y * w + x] = x >= from * times && x < to * times;
	if (rle_encode(&mask->rle, pixels, h, w, &e))
		abort();
	free(pixels);
	q->masks[view][q->count[view]++] = (struct lift_mask){mask, object};
}

void lift_problem_free(struct lift_problem *q)
{
	for (size_t i = 0; i < q->shown_count; i++)
		rle_free(&q->shown[i].rle);
	free(q);
}

struct lift_problem *lift_random(uint64_t seed)
{
	struct lift_problem *q = calloc(1, sizeof *q);
	struct rng r;

	rng_seed(&r, seed, 1);
	for (int v = 0; v < VIEWS; v++) {
		q->weights[v] = make_view(&q->views[v], &r);
		for (size_t o = 0; o < O; o++)
			for (uint32_t left = rng_below(&r, 3); left; left--) {
				const int from = (int)((o + rng_below(&r, 3)) % W);
				lift_add_mask(q, v, o, from, from + (int)rng_below(&r, 6),
					1 + (int)rng_below(&r, 2));
			}
	}
	return q;
}

/* The mean of an object's masks in a view; how many it has. */
static int naive_mask(const struct lift_problem *q, int v, size_t o, double *mask)
{
	uint8_t pixels[P];
	int n = 0;

	memset(mask, 0, P * sizeof *mask);
	for (size_t k = 0; k < q->count[v]; k++)
		if (q->masks[v][k].object == o) {
			struct rle r;
			struct err e;
			if (rle_resize(&r, &q->masks[v][k].mask->rle, H, W, &e))
				abort();
			rle_decode(&r, pixels);
			rle_free(&r);
			for (int p = 0; p < P; p++)
				mask[p] += pixels[p];
			n++;
		}
	for (int p = 0; p < P && n; p++)
		mask[p] /= n;
	return n;
}

static double naive_agreement(const struct view_weights *w, const double *mask, const double *share)
{
	double both = 0, either = 0;

	for (int p = 0; p < P; p++) {
		double rendered = 0, total = 0;
		for (int64_t k = w->indptr[p]; k < w->indptr[p + 1]; k++) {
			total += (double)w->weight[k];
			rendered += (double)w->weight[k] * share[w->index[k]];
		}
		const double a = total > 0 ? rendered / total : 0;
		both += fmin(a, mask[p]);
		either += fmax(a, mask[p]);
	}
	return either > 0 ? both / either : 1;
}

static double share_of[O][N], weight_of[O][N], mean_agreement[O], cut_of[O];

/* fit[k] += agreement times the IoU of a mask, cut at one half, with what is above the k-th cut. */
static void naive_fit(
	const struct view_weights *w, const double *mask, const double *share, double agreement, double *fit)
{
	for (int cut = 0; cut < LIFT_CUTS; cut++) {
		double both = 0, either = 0;
		for (int p = 0; p < P; p++) {
			double rendered = 0;
			for (int64_t k = w->indptr[p]; k < w->indptr[p + 1]; k++)
				rendered += (double)w->weight[k] * share[w->index[k]];
			const int on =
				rendered > 0 && rendered >= (double)LIFTED_CUT - cut * LIFT_CUT_STEP - 1e-9;
			both += on && mask[p] >= 0.5;
			either += mask[p] + (on && mask[p] < 0.5);
		}
		fit[cut] += agreement * (either > 0 ? both / either : 1);
	}
}

static double naive_cut(const double *fit, double votes)
{
	double best = 0;
	int cut = 0;

	for (int k = 0; k < LIFT_CUTS; k++)
		best = fmax(best, fit[k]);
	while (fit[cut] < best - LIFT_CUT_GAIN * votes)
		cut++;
	return (double)LIFTED_CUT - cut * LIFT_CUT_STEP;
}

static void naive_round(const struct lift_problem *q, int round)
{
	static double sum[O][N];

	memset(sum, 0, sizeof sum);
	memset(weight_of, 0, sizeof weight_of);
	for (size_t o = 0; o < O; o++) {
		double mask[P], fit[LIFT_CUTS] = {0}, votes = 0;
		int n = 0;
		mean_agreement[o] = 0;
		for (int v = 0; v < VIEWS; v++) {
			const struct view_weights *w = &q->weights[v].rows;
			if (!naive_mask(q, v, o, mask))
				continue;
			const double a = round ? naive_agreement(w, mask, share_of[o]) : 1;
			const double vote = fmax(a * a, 0.01);
			naive_fit(w, mask, share_of[o], a, fit);
			votes += a;
			mean_agreement[o] += a;
			n++;
			for (int p = 0; p < P; p++)
				for (int64_t k = w->indptr[p]; k < w->indptr[p + 1]; k++) {
					sum[o][w->index[k]] += vote * (double)w->weight[k] * mask[p];
					weight_of[o][w->index[k]] += vote * (double)w->weight[k];
				}
		}
		cut_of[o] = naive_cut(fit, votes);
		mean_agreement[o] /= n ? n : 1;
		for (int i = 0; i < N; i++)
			share_of[o][i] = sum[o][i] / (weight_of[o][i] + 0.01);
	}
}

static void naive_settle(int is_last)
{
	double level[O];

	for (size_t o = 0; o < O; o++) {
		double sum = 0, squares = 0;
		for (int i = 0; i < N; i++) {
			sum += share_of[o][i] * weight_of[o][i];
			squares += share_of[o][i] * share_of[o][i] * weight_of[o][i];
		}
		level[o] = sum > 0 ? squares / sum : 1;
	}
	for (int i = 0; i < N; i++) {
		size_t winner = 0;
		for (size_t o = 1; o < O; o++)
			if (share_of[o][i] > share_of[winner][i])
				winner = o;
		const double most = share_of[winner][i];
		for (size_t o = 0; o < O; o++) {
			double *a = &share_of[o][i];
			if (o != winner)
				*a = is_last && most > 0 ? *a * *a / most : 0;
		}
		for (size_t o = 0; o < O; o++)
			share_of[o][i] = fmin(1, share_of[o][i] / level[o]);
	}
}

struct lift_problem *lift_plain(void)
{
	struct lift_problem *q = calloc(1, sizeof *q);

	for (int v = 0; v < VIEWS; v++) {
		for (int p = 0; p < P; p++) {
			q->views[v].indptr[p + 1] = p + 1;
			q->views[v].index[p] = p % W;
			q->views[v].weight[p] = 0.9f;
		}
		q->weights[v] = rows_of(&q->views[v]);
	}
	return q;
}

int lift_problem(const struct lift_problem *q, size_t objects, struct lifted *to, struct lift_objects *l)
{
	struct err e;
	int bad = 0;

	*to = (struct lifted){0};
	if (lift_objects_init(l, N, objects, VIEWS, &e))
		return -1;
	for (int round = 0; round < LIFT_ROUNDS; round++) {
		for (int k = 0; k < VIEWS; k++) {
			const int v = round % 2 ? VIEWS - 1 - k : k; /* any order */
			bad |= round ? lift_objects_vote(l, (size_t)v, &q->weights[v], &e)
				     : lift_objects_view(
					       l, (size_t)v, &q->weights[v], q->masks[v], q->count[v], &e);
		}
		bad |= lift_objects_settle(l, &e);
	}
	return bad || lift_objects_finish(l, to, &e) ? -1 : 0;
}

double lift_twin_error(const struct lift_problem *q, const struct lifted *got)
{
	double worst = 0;

	for (int round = 0; round < LIFT_ROUNDS; round++) {
		naive_round(q, round);
		naive_settle(round == LIFT_ROUNDS - 1);
	}
	for (size_t o = 0; o < got->objects; o++) {
		double shares[N] = {0};
		for (int64_t k = got->indptr[o]; k < got->indptr[o + 1]; k++)
			shares[got->index[k]] = (double)got->share[k];
		/* those below half a step are left out */
		for (int i = 0; i < N; i++)
			worst = fmax(worst,
				fmax(0, fabs(shares[i] - share_of[o][i]) - (shares[i] > 0 ? 0 : 0.5 / 255)));
		worst = fmax(worst, fabs((double)got->confidence[o] - mean_agreement[o]));
		worst = fmax(worst, fabs((double)got->cut[o] - cut_of[o]));
	}
	return worst;
}
