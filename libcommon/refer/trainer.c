#include "refer/trainer.h"

#include "base/mem.h"
#include "refer/detail.h"

#include <stdlib.h>

/* The octree whose leaves share a feature. */
static int build_octree(struct trainer *t, const struct trainer_source *from, const struct trainer_options *o,
	const double *weight, struct err *e)
{
	const size_t n = from->scene_gaussians, k = OCTREE_SIGNATURE;
	float *finest = mem_alloc(n, sizeof *finest, "octree", e);
	float *signature = mem_alloc(n, k * sizeof *signature, "octree", e);
	int bad = !finest || !signature ||
		  detail_signatures(from->views, from->view_count, from->objects, n, weight, signature, e);

	if (!bad) {
		detail_footprints(from->means, n, from->cameras, from->view_count, finest);
		const struct octree_points points = {
			t->learning, from->means, t->ids, finest, weight, signature};
		bad = octree_build(&t->octree, &points, o->share * (double)from->view_count, e);
	}
	free(finest);
	free(signature);
	return bad ? -1 : 0;
}

/* The Gaussians that learn, the rows that they share, and the rows' positions. */
static int choose_rows(
	struct trainer *t, const struct trainer_source *from, const struct trainer_options *o, struct err *e)
{
	const size_t n = from->scene_gaussians;

	double *weight = mem_alloc(n, sizeof *weight, "weight", e);
	t->ids = mem_alloc(n, sizeof *t->ids, "ids", e);
	int bad = !t->ids || !weight;
	if (!bad) {
		train_weights(from->views, from->view_count, n, weight);
		bad = train_active_set(weight, n, o->tolerance, t->ids, &t->learning, e);
	}
	if (!bad && !t->learning)
		bad = err_set(e, ERR_FORMAT, "no Gaussian has weight in a view with masks");
	if (!bad && o->share > 0)
		bad = build_octree(t, from, o, weight, e);
	free(weight);
	if (bad)
		return -1;
	if (o->share > 0 ? rows_of_leaves(&t->rows, &t->octree, from->means, n, e)
			 : rows_of_ids(&t->rows, t->ids, t->learning, n, e))
		return -1;
	t->position = mem_alloc(t->rows.n, 3 * sizeof(float), "positions", e);
	return !t->position || train_bounds(from->means, t->ids, t->learning, t->low, t->high, e) ||
			       rows_positions(&t->rows, from->means, t->low, t->high, t->position, e)
		       ? -1
		       : 0;
}

/* The views with weights over rows. */
static int make_views(struct trainer *t, const struct trainer_source *from, struct err *e)
{
	t->views = mem_zalloc(from->view_count, sizeof *t->views, "views", e);
	if (!t->views)
		return -1;
	t->view_count = from->view_count;
	int failed = 0;
#pragma omp parallel for schedule(dynamic) reduction(| : failed)
	for (size_t v = 0; v < from->view_count; v++) {
		struct err mine;
		t->views[v] = from->views[v];
		if (rows_view(&t->rows, &from->views[v].weights, &t->views[v].weights, &mine)) {
			failed = 1;
#pragma omp critical
			*e = mine;
		}
	}
	return failed ? -1 : 0;
}

static int init(
	struct trainer *t, const struct trainer_source *from, const struct trainer_options *o, struct err *e)
{
	if (choose_rows(t, from, o, e) || make_views(t, from, e))
		return -1;
	const struct step_setup setup = {.layout = &t->layout,
		.similarity = o->similarity,
		.contrast = o->contrast,
		.temperature = o->temperature,
		.lambda = o->lambda,
		.gaussians = t->rows.n,
		.position = t->position,
		.sentences = from->sentences,
		.offsets = from->offsets,
		.words = from->words,
		.objects = from->objects,
		.pixels = from->pixels,
		.batch = (int)o->batch};
	t->step = step_new(&setup, e);
	if (!t->step ||
		train_order_init(&t->order, t->views, t->view_count, (int)o->batch, from->sentences,
			(size_t)o->negatives, (uint64_t)o->seed, e) ||
		train_state_init(&t->state, &t->layout, t->rows.n, (uint64_t)o->seed, e))
		return -1;
	return 0;
}

int trainer_init(
	struct trainer *t, const struct trainer_source *from, const struct trainer_options *o, struct err *e)
{
	*t = (struct trainer){.rates = o->rates};
	refer_layout_init(&t->layout, o->interaction, from->text_width, (int)o->feature_width);
	int bad = init(t, from, o, e);
	if (bad)
		trainer_free(t);
	return bad;
}

void trainer_free(struct trainer *t)
{
	for (size_t v = 0; v < t->view_count; v++)
		rows_view_free(&t->views[v].weights);
	free(t->views);
	step_free(t->step);
	train_order_free(&t->order);
	train_state_free(&t->state);
	octree_free(&t->octree);
	rows_free(&t->rows);
	free(t->ids);
	free(t->position);
	*t = (struct trainer){0};
}

double trainer_weights(const struct trainer *t)
{
	double weights = 0, pixels = 0;

	for (size_t v = 0; v < t->view_count; v++) {
		const struct view_weights *w = &t->views[v].weights;
		weights += (double)w->indptr[w->pixels];
		pixels += (double)w->pixels;
	}
	return pixels > 0 ? weights / pixels : 0;
}

float *trainer_features(const struct trainer *t, struct err *e)
{
	const int width = t->layout.feature_width;
	float *x = mem_alloc(t->rows.n, (size_t)width * sizeof *x, "features", e);

	if (x)
		step_unpack(train_state_x(&t->state), t->rows.n, width, x);
	return x;
}

struct step_losses trainer_step(struct trainer *t)
{
	return train_step(&t->state, t->step, &t->order, &t->rates, t->rows.n);
}
