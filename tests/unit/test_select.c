#include "mask_help.h"
#include "mask/select.h"
#include "unit.h"

enum { H = 13, W = 17, PIXELS = H * W, MOST = 9 };

/* p_k by the definition, a sum over pixels in float64. */
static double naive_vote(
	uint8_t *const *m, const double *g, int n, int k, enum select_method method, double min_score)
{
	double sum = 0;
	int kept = 0;

	if (method == SELECT_TOP1)
		return g[k];
	for (int j = 0; j < n; j++) {
		double least = 0, most = 0;
		if (!(g[j] > min_score))
			continue;
		kept++;
		for (int v = 0; v < PIXELS; v++) {
			double a = m[k][v] * (method == SELECT_CIOU ? g[k] : 1);
			double b = m[j][v] * (method == SELECT_CIOU ? g[j] : 1);
			least += fmin(a, b);
			most += fmax(a, b);
		}
		sum += most > 0 ? least / most : 1;
	}
	return sum / kept;
}

static void test_naive(void)
{
	struct rng rng;

	rng_seed(&rng, 3, 1);
	for (int round = 0; round < 300; round++) {
		uint8_t *m[MOST];
		double g[MOST], votes[MOST], min_score = round % 3 * 0.25;
		struct mask masks[MOST];
		const struct mask *c[MOST];
		size_t areas[MOST];
		int n = 1 + (int)rng_below(&rng, MOST);
		enum select_method method = (enum select_method)(round % 3);
		for (int k = 0; k < n; k++) {
			m[k] = mask_random(&rng, H, W, k % 4 ? 1 : (int)rng_below(&rng, 3));
			g[k] = rng_uniform(&rng);
			masks[k] = (struct mask){.rle = mask_rle(m[k], H, W), .score = g[k]};
			areas[k] = rle_area(&masks[k].rle);
			c[k] = &masks[k];
		}
		long best = select_winner(c, areas, (size_t)n, method, min_score, votes), naive_best = -1;
		double naive_most = -1;
		for (int k = 0; k < n; k++) {
			double naive = g[k] > min_score ? naive_vote(m, g, n, k, method, min_score) : 0;
			CHECK(fabs(votes[k] - naive) < 1e-12, "round %d: %g, expected %g", round, votes[k],
				naive);
			if (g[k] > min_score && naive > naive_most + 1e-12) {
				naive_most = naive;
				naive_best = k;
			}
		}
		CHECK(naive_best < 0 ? best < 0 : best >= 0 && fabs(votes[best] - naive_most) < 1e-11,
			"round %d: %ld, expected %ld", round, best, naive_best);
		for (int k = 0; k < n; k++) {
			rle_free(&masks[k].rle);
			free(m[k]);
		}
	}
}

/* By hand: on a row of 6 pixels, A = 1-3 (0.9), B = 2-4 (0.5), C = 2-4 (0.6). */
static void test_by_hand(void)
{
	const uint8_t a[6] = {0, 1, 1, 1, 0, 0}, b[6] = {0, 0, 1, 1, 1, 0};
	struct mask m[3] = {{.rle = mask_rle(a, 1, 6), .score = 0.9},
		{.rle = mask_rle(b, 1, 6), .score = 0.5}, {.rle = mask_rle(b, 1, 6), .score = 0.6}};
	const struct mask *const c[3] = {&m[0], &m[1], &m[2]};
	const size_t areas[3] = {3, 3, 3};
	double v[3];

	CHECK(select_winner(c, areas, 3, SELECT_TOP1, 0.3, v) == 0 && v[0] == 0.9 && v[1] == 0.5, "top1");
	/* A with B and C: 2/4 each; B with C: 1. A tie, which the higher score decides */
	CHECK(select_winner(c, areas, 3, SELECT_IOU, 0.3, v) == 2, "iou");
	CHECK(fabs(v[0] - 2.0 / 3) < 1e-15 && fabs(v[1] - 2.5 / 3) < 1e-15 && v[1] == v[2], "%g %g %g", v[0],
		v[1], v[2]);
	/* A,B: 2*0.5 / (0.9 + 0.5 + 2*0.9); A,C: 2*0.6 / (0.9 + 0.6 + 1.8); B,C: 0.5/0.6 */
	double ab = 1 / 3.2, ac = 1.2 / 3.3, bc = 0.5 / 0.6;
	CHECK(select_winner(c, areas, 3, SELECT_CIOU, 0.3, v) == 2, "ciou");
	CHECK(fabs(v[0] - (1 + ab + ac) / 3) < 1e-15 && fabs(v[1] - (1 + ab + bc) / 3) < 1e-15 &&
			fabs(v[2] - (1 + ac + bc) / 3) < 1e-15,
		"%g %g %g", v[0], v[1], v[2]);
	/* B at the cut does not take part, nor vote */
	CHECK(select_winner(c, areas, 3, SELECT_IOU, 0.5, v) == 0 && v[0] == 0.75 && v[1] == 0, "%g %g", v[0],
		v[1]);
	CHECK(select_winner(c, areas, 3, SELECT_CIOU, 0.9, v) == -1 && v[0] == 0, "none above 0.9");
	/* equal votes and scores: the earlier */
	m[1].score = 0.6;
	CHECK(select_winner(c, areas, 3, SELECT_CIOU, 0.3, v) == 1, "the earlier of two equals");
	for (int i = 0; i < 3; i++)
		rle_free(&m[i].rle);
}

int main(void)
{
	test_naive();
	test_by_hand();
	return unit_end();
}
