#include "score/score_best.h"

#include "base/largest.h"
#include "base/mem.h"
#include "base/names.h"
#include "mask/mask_index.h"

#include <math.h>

/* Masks by what they go by. */
struct things {
	size_t count;
	size_t *of; /* (masks) the number of each one's */
};

static int number_things(struct things *t, const struct mask *masks, size_t n, struct err *e)
{
	SCOPED const char **called = mem_alloc(n, sizeof *called, "masks", e);
	SCOPED_BY(names_free) struct names names = {0};

	t->of = mem_alloc(n, sizeof *t->of, "masks", e);
	for (size_t i = 0; i < n && called; i++)
		called[i] = mask_object(&masks[i]);
	if (!called || !t->of || names_make(&names, called, sizeof *called, 0, n, e))
		return -1;
	for (size_t i = 0; i < n; i++) {
		const size_t first = names_find(&names, called[i]);
		t->of[i] = first == i ? t->count++ : t->of[first];
	}
	return 0;
}

/* iou (things,objects): sums over views. */
static int compare_all(double *iou, const struct things *things, const struct things *objects,
	const struct mask *truth, size_t truth_n, const struct mask *predictions, size_t prediction_n,
	struct err *e)
{
	SCOPED_BY(mask_index_free) struct mask_index x = {0};
	int bad = mask_index_make(&x, predictions, prediction_n, MASK_BY_OBJECT, e);

	for (size_t t = 0; t < truth_n && !bad; t++) {
		size_t begin, end;
		mask_index_view(&x, truth[t].view, &begin, &end);
		for (size_t k = begin; k < end && !bad; k++) {
			const size_t at = x.keys[k].at;
			SCOPED_BY(rle_fitted_free) struct rle_fitted f = {.own = &predictions[at].rle};
			bad = rle_fit(&f, &truth[t].rle, e);
			iou[things->of[t] * objects->count + objects->of[at]] +=
				bad || !f.area ? 0 : rle_iou(f.now, &truth[t].rle);
		}
	}
	return bad ? -1 : 0;
}

/* The masks of an object, in the views in which the thing of mask `first` has truth. */
static int take(struct masks *named, const struct mask *first, const struct things *objects, size_t object,
	const struct mask *predictions, size_t prediction_n, const struct mask_index *truth, struct err *e)
{
	const char *name = mask_object(first);

	for (size_t i = 0; i < prediction_n; i++) {
		size_t begin, end, of_ref, of_ref_end;
		struct mask m;
		if (objects->of[i] != object)
			continue;
		mask_index_object(truth, predictions[i].view, name, &begin, &end);
		mask_index_ref(truth, predictions[i].view, name, &of_ref, &of_ref_end);
		if ((begin < end || of_ref < of_ref_end) &&
			(mask_copy(&m, &predictions[i], NULL, name, e) || masks_add(named, &m, e)))
			return -1;
	}
	return 0;
}

int score_best(struct masks *named, const struct mask *truth, size_t truth_n, const struct mask *predictions,
	size_t prediction_n, struct err *e)
{
	struct things things = {0}, objects = {0};
	SCOPED_BY(mask_index_free) struct mask_index x = {0};
	double *iou = NULL;
	int bad = number_things(&things, truth, truth_n, e) ||
		  number_things(&objects, predictions, prediction_n, e) ||
		  mask_index_make(&x, truth, truth_n, MASK_BY_OBJECT, e) ||
		  !(iou = mem_zalloc(things.count, objects.count * sizeof *iou, "masks", e)) ||
		  compare_all(iou, &things, &objects, truth, truth_n, predictions, prediction_n, e);
	size_t done = 0;

	for (size_t t = 0; t < truth_n && !bad && objects.count; t++) {
		if (things.of[t] < done) /* not the first of its thing */
			continue;
		const double *row = iou + things.of[t] * objects.count;
		const size_t best = best_of(row, objects.count);
		done++;
		if (row[best] > 0)
			bad = take(named, &truth[t], &objects, best, predictions, prediction_n, &x, e);
	}
	if (bad)
		masks_free(named);
	mem_free_all(iou, things.of, objects.of);
	return bad ? -1 : 0;
}
