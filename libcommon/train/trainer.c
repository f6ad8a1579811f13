#include "train/trainer.h"

#include "base/mem.h"
#include "train/octree_input.h"

/* The octree whose leaves share a feature. */
static int build_octree(
	struct trainer *t, const struct trainer_source *from, const struct trainer_options *o, struct err *e)
{
	const size_t n = from->scene_gaussians, k = OCTREE_SIGNATURE;
	SCOPED float *finest = mem_alloc(n, sizeof *finest, "octree", e);
	SCOPED float *signature = mem_alloc(n, k * sizeof *signature, "octree", e);
	int bad = !finest || !signature ||
		  octree_input_signatures(&from->views, from->objects, n, from->weight, signature, e);

	if (!bad) {
		octree_input_footprints(from->means, n, from->cameras, from->views.n, finest);
		const struct octree_points points = {
			t->learning, from->means, t->ids, finest, from->weight, signature};
		bad = octree_build(&t->octree, &points, o->share * (double)from->views.n, e);
	}
	return bad ? -1 : 0;
}

/* The Gaussians that learn, the rows that they share, and the rows' positions. */
static int choose_rows(
	struct trainer *t, const struct trainer_source *from, const struct trainer_options *o, struct err *e)
{
	const size_t n = from->scene_gaussians;

	t->ids = mem_alloc(n, sizeof *t->ids, "ids", e);
	if (!t->ids || train_active_set(from->weight, n, o->tolerance, t->ids, &t->learning, e))
		return -1;
	if (!t->learning)
		return err_set(e, ERR_FORMAT, "no Gaussian has weight in a view with masks");
	if (o->share > 0 && build_octree(t, from, o, e))
		return -1;
	if (o->share > 0 ? rows_of_leaves(&t->rows, &t->octree, from->means, n, t->ids, t->learning, e)
			 : rows_of_ids(&t->rows, t->ids, t->learning, n, e))
		return -1;
	t->position = mem_alloc(t->rows.n, 3 * sizeof(float), "positions", e);
	t->counts = mem_zalloc(t->rows.n, sizeof *t->counts, "rows", e);
	for (size_t k = 0; t->counts && k < n; k++)
		if (t->rows.of[k] >= 0)
			t->counts[t->rows.of[k]]++;
	return -(!t->position || !t->counts ||
		 train_bounds(from->means, t->ids, t->learning, t->low, t->high, e) ||
		 rows_positions(&t->rows, from->means, t->low, t->high, t->position, e));
}

/* The rows; what a warm start fits them to; the views over them. */
static int make_rows(
	struct trainer *t, const struct trainer_source *from, const struct trainer_options *o, struct err *e)
{
	const struct warm_start_source source = {
		from->lifted, &t->rows, from->weight, from->sentences, from->object_names};
	const struct train_contrast contrast = {from->sentences, (size_t)o->negatives, from->objects};

	if (choose_rows(t, from, o, e) ||
		(t->warm_steps && warm_start_init(&t->warm, &source, &contrast, (uint64_t)o->seed, e)))
		return -1;
	return row_views_make(&t->views, &t->rows, &from->views, &from->room, e);
}

/* The features that a warm start begins with. */
static int init_features(struct trainer *t, uint64_t seed, struct err *e)
{
	const int width = t->layout.feature_width;
	SCOPED float *x = mem_alloc(t->rows.n, (size_t)width * sizeof *x, "features", e);

	if (!x || warm_start_features(&t->warm, width, seed, x, e))
		return -1;
	panels_pack(x, t->rows.n, width, train_state_x(&t->state));
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
		.counts = t->counts,
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
	const struct train_contrast contrast = {from->sentences, (size_t)o->negatives, from->objects};

	if (make_rows(t, from, o, e) || init_step(t, from, o, e) ||
		train_order_init(&t->order, t->views.views, t->views.n, (int)o->batch, &contrast, seed, e) ||
		train_state_init(&t->state, &t->layout, t->rows.n, seed, e) ||
		(t->warm_steps && init_features(t, seed, e)))
		return -1;
	t->order.begin = t->warm_steps;
	return 0;
}

int trainer_init(
	struct trainer *t, const struct trainer_source *from, const struct trainer_options *o, struct err *e)
{
	*t = (struct trainer){.rates = o->rates, .warm_steps = from->lifted ? (long)o->warm : 0};
	refer_layout_init(&t->layout, o->interaction, from->text_width, (int)o->feature_width);
	int bad = init(t, from, o, e);
	return bad;
}

void trainer_free(struct trainer *t)
{
	row_views_free(&t->views);
	step_free(t->step);
	train_order_free(&t->order);
	train_state_free(&t->state);
	warm_start_free(&t->warm);
	octree_free(&t->octree);
	rows_free(&t->rows);
	mem_free_all(t->ids, t->position, t->counts);
	*t = (struct trainer){0};
}

double trainer_weights(const struct trainer *t)
{
	double pixels = 0;

	for (size_t v = 0; v < t->views.n; v++)
		pixels += (double)t->views.views[v].weights.pixels;
	return pixels > 0 ? t->views.weights / pixels : 0;
}

float *trainer_features(const struct trainer *t, const float *values, struct err *e)
{
	const int width = t->layout.feature_width;
	float *x = mem_alloc(t->rows.n, (size_t)width * sizeof *x, "features", e);

	if (x)
		panels_unpack(values + t->state.parameters, t->rows.n, width, x);
	return x;
}

/* A step of the views, while the system reads the next one's. */
static int step_of_views(struct trainer *t, struct step_losses *losses, struct err *e)
{
	const struct view_source views = row_views_source(&t->views);
	const size_t view = train_order_view(&t->order, t->state.iteration);
	const size_t next = train_order_next(&t->order, t->state.iteration);
	struct view_weights w;

	if (next < views.n)
		row_views_ahead(&t->views, next);
	if (view_source_open(&views, view, &w, e))
		return -1;
	*losses = train_step(&t->state, t->step, &t->order, &t->rates, &w);
	view_source_close(&views, view);
	return 0;
}

int trainer_step(struct trainer *t, struct step_losses *losses, struct err *e)
{
	if (t->state.iteration >= t->warm_steps)
		return step_of_views(t, losses, e);
	const double left = 1 - (double)t->state.iteration / (double)t->warm_steps;
	const struct train_rates rates = {
		left * t->rates.features, left * WARM_START_MLP_RATE * t->rates.mlps};
	*losses = train_step(&t->state, t->step, &t->warm.order, &rates, &t->warm.view.weights);
	return 0;
}
