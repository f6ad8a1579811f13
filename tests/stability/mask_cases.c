/* Hard cases of choosing and lifting masks. */
#include "stability.h"

#include "tests/unit/lift_twin.h"

#include "mask/select.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { CANDIDATES = 50 };

/* CANDIDATES masks of the columns 0..to-1, all with one score. */
static void equal_case(const char *name, int to, enum select_method method, const char *does)
{
	struct lift_problem *q = lift_plain();
	const struct mask *c[CANDIDATES];
	size_t areas[CANDIDATES];
	double votes[CANDIDATES], worst = 0;

	for (int k = 0; k < CANDIDATES; k++) {
		lift_add_mask(q, k % VIEWS, 0, 0, to, 1);
		q->shown[k].score = 0.7;
		areas[k] = rle_area(&q->shown[k].rle);
		c[k] = &q->shown[k];
	}
	const long winner = select_winner(c, areas, CANDIDATES, method, 0.3, votes);
	for (int k = 0; k < CANDIDATES; k++)
		worst = fmax(worst, fabs(votes[k] - 1));
	row(name, "votes, which are 1", winner == 0 ? worst : NAN, 1e-12, does);
	lift_problem_free(q);
}

static void lift_row(const char *name, struct lift_problem *q, const char *does)
{
	struct lift_objects l;
	struct lifted got;

	if (lift_problem(q, O, &got, &l))
		abort();
	row(name, compared("shares and confidences; %lld shares", (long long)got.indptr[O]),
		lift_twin_error(q, &got), 1e-4, does);
	lifted_free(&got);
	lift_objects_free(&l);
	lift_problem_free(q);
}

static struct lift_problem *with_masks(int from, int to)
{
	struct lift_problem *q = lift_plain();

	for (int v = 0; v < VIEWS; v++)
		lift_add_mask(q, v, 0, from, to, 1);
	return q;
}

void mask_cases(void)
{
	struct lift_problem *q;

	equal_case("50 equal candidates", W / 2, SELECT_CIOU, "the first wins");
	equal_case("50 candidates that are all", W, SELECT_CIOU, "the first wins");
	equal_case("50 candidates that are nothing", 0, SELECT_IOU, "the first wins: empty masks agree");
	lift_row("lifting from ordinary masks", lift_random(1), "lifts");
	lift_row("lifting from masks that are all", with_masks(0, W),
		"every Gaussian that is seen is the object's");
	lift_row("lifting from masks that are nothing", with_masks(0, 0), "an object without Gaussians");
	q = with_masks(0, W / 2);
	for (int v = 0; v < VIEWS; v++)
		memset(q->views[v].indptr, 0, sizeof q->views[v].indptr);
	lift_row("lifting with weights that are all dropped", q, "an object without Gaussians");
	q = with_masks(2, 8);
	for (int v = 0; v < VIEWS; v++)
		for (int p = 0; p < P; p++)
			q->views[v].weight[p] = 1e-38f;
	lift_row("lifting with weights of 1e-38", q, "an object without Gaussians");
}
