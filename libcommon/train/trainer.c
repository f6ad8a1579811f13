#include "train/trainer.h"

#include "base/mem.h"
#include "train/octree_input.h"

#include <stdlib.h>

/* The octree whose leaves share a feature. */
static int build_octree(struct trainer *t, const struct trainer_source *from, const struct trainer_options *o,
	const double *weight, struct err *e)
{
	const size_t n = from->scene_gaussians, k = OCTREE_SIGNATURE;
	float *finest = mem_alloc(n, sizeof *finest, "octree", e);
	float *signature = mem_alloc(n, k * sizeof *signature, "octree", e);
	int bad = !finest || !signature ||
		  octree_input_signatures(
			  from->views, from->view_count, from->objects, n, weight, signature, e);

	if (!bad) {
		octree_input_footprints(from->means, n, from->cameras, from->view_count, finest);
		const struct octree_points points = {
			t->learning, from->means, t->ids, finest, weight, signature};
		bad = octree_build(&t->octree, &points, o->share * (double)from->view_count, e);
	}
	free(finest);
	free(signature);
	return bad ? -1 : 0;
}

/* The Gaussians that learn, the rows that they share, and the rows' positions. */
static int choose_rows(struct trainer *t, const struct trainer_source *from, const struct trainer_options *o,
	const double *weight, struct err *e)
{
	const size_t n = from->scene_gaussians;

	t->ids = mem_alloc(n, sizeof *t->ids, "ids", e);
	if (!t->ids || train_active_set(weight, n, o->tolerance, t->ids, &t->learning, e))
		return -1;
	if (!t->learning)
		return err_set(e, ERR_FORMAT, "no Gaussian has weight in a view with masks");
	if (o->share > 0 && build_octree(t, from, o, weight, e))
		return -1;
	if (o->share > 0 ? rows_of_leaves(&t->rows, &t->octree, from->means, n, t->ids, t->learning, e)
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

/* The rows; what a warm start fits them to. */
static int make_rows(
	struct trainer *t, const struct trainer_source *from, const struct trainer_options *o, struct err *e)
{
	double *weight = mem_alloc(from->scene_gaussians, sizeof *weight, "weight", e);
	const struct warm_start_source source = {
		from->lifted, &t->rows, weight, from->sentences, from->object_names};

	if (!weight)
		return -1;
	train_weights(from->views, from->view_count, from->scene_gaussians, weight);
	int bad = choose_rows(t, from, o, weight, e) ||
		  (t->warm_steps &&
			  warm_start_init(&t->warm, &source, (size_t)o->negatives, (uint64_t)o->seed, e));
	free(weight);
	return bad ? -1 : 0;
}

/* The features that a warm start begins with. */
static int init_features(struct trainer *t, uint64_t seed, struct err *e)
{
	const int width = t->layout.feature_width;
	float *x = mem_alloc(t->rows.n, (size_t)width * sizeof *x, "features", e);

	if (!x || warm_start_features(&t->warm, width, seed, x, e)) {
		free(x);
		return -1;
	}
	panels_pack(x, t->rows.n, width, train_state_x(&t->state));
	free(x);
	return 0;
}

static int init_step(
	struct trainer *t, const struct trainer_source *from, const struct trainer_options *o, struct err *e)
{
	const size_t pixels = t->warm.view.weights.pixels;
	const int batch = (int)o->batch;
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
		.pixels = pixels > from->pixels ? pixels : from->pixels,
		.batch = t->warm_steps && batch < WARM_START_BATCH ? WARM_START_BATCH : batch};
	t->step = step_new(&setup, e);
	return t->step ? 0 : -1;
}

static int init(
	struct trainer *t, const struct trainer_source *from, const struct trainer_options *o, struct err *e)
{
	const uint64_t seed = (uint64_t)o->seed;

	if (make_rows(t, from, o, e) || make_views(t, from, e) || init_step(t, from, o, e) ||
		train_order_init(&t->order, t->views, t->view_count, (int)o->batch, from->sentences,
			(size_t)o->negatives, seed, e) ||
		train_state_init(&t->state, &t->layout, t->rows.n, o->hold_out > 0, seed, e) ||
		(t->warm_steps && init_features(t, seed, e)))
		return -1;
	t->order.begin = t->warm_steps;
	return o->hold_out > 0 ? held_out_init(&t->held, t->views, t->view_count, from->objects,
					 from->sentences, t->rows.n, e)
			       : 0;
}

int trainer_init(
	struct trainer *t, const struct trainer_source *from, const struct trainer_options *o, struct err *e)
{
	*t = (struct trainer){.rates = o->rates, .warm_steps = from->lifted ? (long)o->warm : 0};
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
	warm_start_free(&t->warm);
	held_out_free(&t->held);
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

float *trainer_features(const struct trainer *t, const float *values, struct err *e)
{
	const int width = t->layout.feature_width;
	float *x = mem_alloc(t->rows.n, (size_t)width * sizeof *x, "features", e);

	if (x)
		panels_unpack(values + t->state.parameters, t->rows.n, width, x);
	return x;
}

struct step_losses trainer_step(struct trainer *t)
{
	const struct train_rates rates = {t->rates.features, WARM_START_MLP_RATE * t->rates.mlps};

	if (t->state.iteration < t->warm_steps)
		return train_step(&t->state, t->step, &t->warm.order, &rates, t->rows.n);
	return train_step(&t->state, t->step, &t->order, &t->rates, t->rows.n);
}

struct held_out_score trainer_evaluate(struct trainer *t)
{
	const struct held_out_score score =
		held_out_evaluate(&t->held, t->step, t->state.values, train_state_x(&t->state));

	train_evaluated(&t->state, score.iou);
	return score;
}

const float *trainer_result(const struct trainer *t, long *iteration)
{
	const int is_best = t->state.best.iteration > 0;

	*iteration = is_best ? t->state.best.iteration : t->state.iteration;
	return is_best ? t->state.best.values : t->state.values;
}
