/* Lifting by the definitions of lift/lift_objects.h, in plain float64, on small problems. */
#ifndef LIFT_TWIN_H
#define LIFT_TWIN_H

#include "lift/lift_objects.h"

#include <stdint.h>

enum {
	H = 12,
	W = 20,
	P = H * W,
	N = 150,
	UNSEEN = 10,
	ENTRIES = 8,
	VIEWS = 6,
	O = 19,
	MOST = VIEWS * O * 2
};

/* Pixels have none to ENTRIES weights; the last Gaussians have none. */
struct random_view {
	int64_t indptr[P + 1];
	int32_t index[P * ENTRIES];
	float weight[P * ENTRIES];
};

struct lift_problem {
	struct random_view views[VIEWS];
	struct view_matrix weights[VIEWS]; /* rows; lifted by tiles where there are some */
	size_t count[VIEWS];
	struct lift_mask masks[VIEWS][2 * O];
	struct mask shown[MOST];
	size_t shown_count;
};

/* Masks of different places in each view, some missing, some twice, some empty, of two sizes. */
struct lift_problem *lift_random(uint64_t seed);

/* Every view sees Gaussian c in column c, and the others not at all. */
struct lift_problem *lift_plain(void);

void lift_problem_free(struct lift_problem *q);

/* Adds a mask of the columns from..to-1 of a view, as large as its weights or `times` as large. */
void lift_add_mask(struct lift_problem *q, int view, size_t object, int from, int to, int times);

/* Lifts the problem; *l is not released. Returns 0, or -1 where memory is out. */
int lift_problem(const struct lift_problem *q, size_t objects, struct lifted *to, struct lift_objects *l);

/* The largest difference of a share or confidence from the definition's. */
double lift_twin_error(const struct lift_problem *q, const struct lifted *got);

#endif
