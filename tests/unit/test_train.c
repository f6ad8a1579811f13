/* Training but for its step: which Gaussians learn, their positions, the order of the views, which mask
 * teaches what, and a state that goes on to the same bytes. */
#include "unit.h"

#include "base/mem.h"
#include "base/rng.h"
#include "formats/scene/checkpoint.h"
#include "mask/bits.h"
#include "splat/backproject.h"
#include "train/trainer.h"

#include <unistd.h>

enum { GAUSSIANS = 60, PIXELS = 25, ENTRIES = 4, VIEWS = 4 };

/* Random weights of a view over the scene's Gaussians, of which every fifth has none. */
struct random_view {
	int64_t indptr[PIXELS + 1];
	int32_t index[PIXELS * ENTRIES];
	float weight[PIXELS * ENTRIES];
};

static void random_views(struct random_view *r, struct train_view *views, uint64_t seed)
{
	struct rng rng;

	rng_seed(&rng, seed, 1);
	for (int v = 0; v < VIEWS; v++) {
		for (int p = 0; p <= PIXELS; p++)
			r[v].indptr[p] = (int64_t)p * ENTRIES;
		for (int k = 0; k < PIXELS * ENTRIES; k++) {
			r[v].index[k] =
				(int32_t)(rng_below(&rng, GAUSSIANS / 5) * 5 + 1 + rng_below(&rng, 4));
			r[v].weight[k] = (float)(rng_uniform(&rng) * rng_uniform(&rng) / ENTRIES);
		}
		views[v] = (struct train_view){
			.weights = {PIXELS, GAUSSIANS, r[v].indptr, r[v].index, r[v].weight}};
	}
}

/* weight (GAUSSIANS) over all views. */
static void sum_weights(const struct train_view *views, double *weight)
{
	memset(weight, 0, sizeof *weight * GAUSSIANS);
	for (int v = 0; v < VIEWS; v++)
		backproject_weight(&views[v].weights, weight);
}

static void test_active_set(void)
{
	struct random_view random[VIEWS];
	struct train_view views[VIEWS];
	const double tolerances[] = {0, 0.01, 0.1, 0.5, 0.9};
	struct err e;

	random_views(random, views, 3);
	double total[GAUSSIANS] = {0}, all = 0, weight[GAUSSIANS];
	sum_weights(views, weight);
	for (int v = 0; v < VIEWS; v++)
		for (int k = 0; k < PIXELS * ENTRIES; k++) {
			total[random[v].index[k]] += (double)random[v].weight[k];
			all += (double)random[v].weight[k];
		}
	for (size_t t = 0; t < sizeof tolerances / sizeof *tolerances; t++) {
		int32_t ids[GAUSSIANS];
		size_t n = 0;
		char is_in[GAUSSIANS] = {0};
		double left_out = 0, smallest = INFINITY, largest_out = 0;

		CHECK(!train_active_set(weight, GAUSSIANS, tolerances[t], ids, &n, &e), "%s", e.message);
		for (size_t i = 0; i < n; i++) {
			CHECK(!i || ids[i] > ids[i - 1], "ids do not rise at %zu", i);
			is_in[ids[i]] = 1;
			smallest = fmin(smallest, total[ids[i]]);
		}
		for (int g = 0; g < GAUSSIANS; g++) {
			left_out += is_in[g] ? 0 : total[g];
			largest_out = is_in[g] ? largest_out : fmax(largest_out, total[g]);
		}
		CHECK(left_out <= tolerances[t] * all, "tolerance %g: %g left out of %g", tolerances[t],
			left_out, all);
		CHECK(left_out + smallest > tolerances[t] * all, "tolerance %g: more could go",
			tolerances[t]);
		CHECK(largest_out <= smallest, "tolerance %g: a larger one went first", tolerances[t]);
	}
	for (int v = 0; v < VIEWS; v++)
		memset(random[v].weight, 0, sizeof random[v].weight);
	int32_t ids[GAUSSIANS];
	size_t n = 1;
	sum_weights(views, weight);
	CHECK(!train_active_set(weight, GAUSSIANS, 0, ids, &n, &e) && n == 0, "%zu Gaussians without weight",
		n);
}

static void test_bounds(void)
{
	enum { N = 500 };
	float means[N * 3], position[N * 3];
	int32_t ids[N];
	double low[3], high[3];
	struct err e;

	for (int i = 0; i < N; i++) {
		ids[i] = i;
		means[3 * i] = (float)((i * 7) % N); /* 0 to 499 in some order */
		means[3 * i + 1] = -(float)i;
		means[3 * i + 2] = 4;
	}
	CHECK(!train_bounds(means, ids, N, low, high, &e), "%s", e.message);
	CHECK(low[0] == 5 && high[0] == 494, "x: %g to %g", low[0], high[0]);
	CHECK(low[1] == -494 && high[1] == -5, "y: %g to %g", low[1], high[1]);
	CHECK(low[2] == 3 && high[2] == 5, "z is widened: %g to %g", low[2], high[2]);
	struct rows rows;
	CHECK(!rows_of_ids(&rows, ids, N, N, &e) && !rows_positions(&rows, means, low, high, position, &e),
		"%s", e.message);
	rows_free(&rows);
	for (int i = 0; i < N; i++) {
		double x = fmax(-1, fmin(1, 2 * ((double)means[3 * i] - 5) / 489 - 1));
		CHECK(fabs((double)position[3 * i] - x) < 1e-6, "position of %d is %g, not %g", i,
			(double)position[3 * i], x);
		CHECK(position[3 * i + 2] == 0, "z of %d is %g", i, (double)position[3 * i + 2]);
	}
	/* Only the Gaussians that learn count. */
	CHECK(!train_bounds(means, ids + 100, 1, low, high, &e) && low[1] == -101 && high[1] == -99,
		"y of one: %g to %g", low[1], high[1]);
	CHECK(!rows_of_ids(&rows, ids + 100, 1, N, &e) &&
			!rows_positions(&rows, means, low, high, position, &e),
		"%s", e.message);
	rows_free(&rows);
	CHECK(position[0] == 0 && position[1] == 0, "one Gaussian is in the middle");
}

enum { COUNTS = 5, MOST = 7 };

/* Every pair once an epoch, in groups of one view that are full but for one a view. */
static void check_epoch(struct train_order *o, const int *counts, int batch, long first)
{
	int seen[COUNTS][MOST] = {{0}}, partial[COUNTS] = {0};

	for (uint32_t g = 0; g < o->groups; g++) {
		uint32_t picks[MOST];
		int count = 0;
		size_t view = train_order_at(o, first + (long)g, picks, &count);
		if (!CHECK(view < COUNTS && count >= 1 && count <= batch, "view %zu, %d sentences", view,
			    count))
			return;
		partial[view] += count < batch;
		for (int i = 0; i < count; i++)
			if (CHECK(picks[i] < (uint32_t)counts[view], "pick %u of %d", picks[i], counts[view]))
				seen[view][picks[i]]++;
	}
	for (int v = 0; v < COUNTS; v++) {
		CHECK(partial[v] == (counts[v] % batch != 0), "view %d has %d smaller groups", v, partial[v]);
		for (int k = 0; k < counts[v]; k++)
			CHECK(seen[v][k] == 1, "batch %d: pair %d of view %d came %d times", batch, k, v,
				seen[v][k]);
	}
}

static void test_order(void)
{
	const int counts[COUNTS] = {3, 0, 7, 1, 4};
	const struct train_contrast all = {20, 0, NULL};
	struct train_view views[COUNTS] = {{.count = 0}};
	struct err e;

	for (int v = 0; v < COUNTS; v++)
		views[v].count = counts[v];
	for (int batch = 1; batch <= 4; batch++) {
		struct train_order o, other;
		uint32_t groups = 0;
		int differ = 0;

		for (int v = 0; v < COUNTS; v++)
			groups += (uint32_t)((counts[v] + batch - 1) / batch);
		CHECK(!train_order_init(&o, views, COUNTS, batch, &all, 9, &e), "%s", e.message);
		CHECK(!train_order_init(&other, views, COUNTS, batch, &all, 9, &e), "%s", e.message);
		CHECK(o.groups == groups, "batch %d: %u groups", batch, o.groups);
		for (long epoch = 0; epoch < 5; epoch++)
			check_epoch(&o, counts, batch, epoch * (long)groups);
		/* An iteration is found again from anywhere, and the epochs differ. */
		for (long i = 3 * (long)groups - 1; i >= 0; i--) {
			uint32_t a[MOST], b[MOST], c[MOST];
			int na, nb, nc;
			size_t va = train_order_at(&o, i, a, &na), vb, vc;
			train_order_at(&other, 1000 - i, b, &nb);
			vb = train_order_at(&other, i, b, &nb);
			CHECK(va == vb && na == nb && !memcmp(a, b, sizeof *a * (size_t)na),
				"iteration %ld differs", i);
			vc = train_order_at(&other, i + (long)groups, c, &nc);
			differ += vc != va || nc != na || memcmp(a, c, sizeof *a * (size_t)na);
		}
		CHECK(differ > 0, "batch %d: all epochs are alike", batch);
		train_order_free(&o);
		train_order_free(&other);
	}
}

/* A training of two sentences over the random views. */
struct sample {
	struct random_view random[VIEWS];
	struct train_view views[VIEWS];
	float means[GAUSSIANS * 3], words[5 * 8];
	int64_t offsets[3];
	int objects[2], sentences[2];
	uint8_t mask[2][PIXELS / 8 + 1]; /* bits */
	const uint8_t *masks[2];
	/* For a warm start: the second sentence's object. */
	struct lifted lifted;
	const char *object_names[2];
	int64_t shares[2];
	int32_t share_index[GAUSSIANS];
	float share[GAUSSIANS];
	double weight[GAUSSIANS + 1];
};

static void sample_init(struct sample *s)
{
	struct rng rng;

	*s = (struct sample){.offsets = {0, 2, 5}, .objects = {0, 1}, .sentences = {0, 1}};
	random_views(s->random, s->views, 11);
	sum_weights(s->views, s->weight);
	rng_seed(&rng, 12, 1);
	for (int i = 0; i < GAUSSIANS * 3; i++)
		s->means[i] = (float)rng_normal(&rng);
	for (int i = 0; i < 5 * 8; i++)
		s->words[i] = (float)rng_normal(&rng);
	for (int k = 0; k < 2; k++) {
		uint8_t pixels[PIXELS];
		for (int p = 0; p < PIXELS; p++)
			pixels[p] = (uint8_t)rng_below(&rng, 2);
		bits_pack(pixels, PIXELS, s->mask[k]);
	}
	s->masks[0] = s->mask[0];
	s->masks[1] = s->mask[1];
	for (int v = 0; v < VIEWS; v++) {
		s->views[v].count = 2;
		s->views[v].sentences = s->sentences;
		s->views[v].masks = s->masks;
	}
}

static char lifted_name[] = "jug", *lifted_names[] = {lifted_name};

static void sample_lift(struct sample *s)
{
	s->object_names[0] = "mug";
	s->object_names[1] = "jug";
	s->shares[1] = GAUSSIANS / 2;
	for (int k = 0; k < GAUSSIANS / 2; k++) {
		s->share_index[k] = k;
		s->share[k] = 0.9f;
	}
	s->lifted = (struct lifted){.gaussians = GAUSSIANS,
		.objects = 1,
		.names = lifted_names,
		.indptr = s->shares,
		.index = s->share_index,
		.share = s->share};
}

static struct trainer_source source_of(const struct sample *s)
{
	return (struct trainer_source){.means = s->means,
		.scene_gaussians = GAUSSIANS,
		.text_width = 8,
		.sentences = 2,
		.offsets = s->offsets,
		.words = s->words,
		.objects = s->objects,
		.views = {.views = s->views, .n = VIEWS},
		.pixels = PIXELS,
		.weight = s->weight,
		.room = {.bytes = SIZE_MAX},
		.object_names = s->object_names};
}

/* A warm start where the options say so. */
static int start(struct trainer *t, const struct sample *s, const struct trainer_options *o)
{
	struct trainer_source source = source_of(s);
	struct err e;

	source.lifted = o->warm ? &s->lifted : NULL;

	return CHECK(!trainer_init(t, &source, o, &e), "%s", e.message);
}

static int same_state(const struct train_state *a, const struct train_state *b)
{
	const size_t bytes = a->count * sizeof(float);

	return a->iteration == b->iteration && a->count == b->count && !memcmp(a->values, b->values, bytes) &&
	       !memcmp(a->m, b->m, bytes) && !memcmp(a->v, b->v, bytes) &&
	       !memcmp(&a->sum, &b->sum, sizeof a->sum);
}

/* Steps [from,to). */
static void steps(struct trainer *t, int from, int to)
{
	struct step_losses losses;
	struct err e;

	for (int i = from; i < to; i++)
		CHECK(!trainer_step(t, &losses, &e), "%s", e.message);
}

/* Goes on after `cut` steps, with a warm start of so many. */
static void test_resume(int cut, long long warm)
{
	const struct trainer_options options = {.warm = warm,
		.interaction = REFER_PCMI,
		.contrast = REFER_CONTRAST_COSINE,
		.feature_width = 5,
		.temperature = 0.1,
		.lambda = 0.02,
		.batch = 1,
		.rates = {0.0025, 0.0001},
		.seed = 7};
	struct sample s;
	struct trainer whole, part, fresh;
	char path[] = "/tmp/test_train.XXXXXX";
	struct checkpoint_of own = {.scene_path = "scene", .text_path = "text"}, other = own;
	struct err e;
	int fd = mkstemp(path);

	sample_init(&s);
	sample_lift(&s);
	if (!CHECK(fd >= 0, "no temporary file") || !start(&whole, &s, &options) ||
		!start(&part, &s, &options) || !start(&fresh, &s, &options))
		return;
	close(fd);
	checkpoint_identity(own.identity, &options, 0x1234abcd);
	steps(&whole, 0, 25);
	steps(&part, 0, cut);
	CHECK(whole.warm_steps == warm && !warm == !whole.warm.objects, "%ld warm steps", whole.warm_steps);
	CHECK(part.state.iteration == cut && part.state.sum.total > 0, "%ld steps", part.state.iteration);
	CHECK(!checkpoint_write(&part.state, path, &own, &e), "%s", e.message);
	CHECK(!checkpoint_read(&fresh.state, path, &own, &e), "%s", e.message);
	CHECK(same_state(&fresh.state, &part.state), "the checkpoint is not the state");
	steps(&fresh, cut, 25);
	CHECK(same_state(&fresh.state, &whole.state), "going on is not the same");
	CHECK(!same_state(&fresh.state, &part.state), "nothing was learned");
	checkpoint_identity(other.identity, &options, 0x1234abce);
	CHECK(checkpoint_read(&fresh.state, path, &other, &e) && e.code == ERR_FORMAT,
		"another training's inputs");
	struct trainer_options wider = options;
	wider.feature_width = 6;
	checkpoint_identity(other.identity, &wider, 0x1234abcd);
	CHECK(checkpoint_read(&fresh.state, path, &other, &e) && e.code == ERR_FORMAT,
		"features of another width");
	struct trainer_options warmer = options;
	warmer.warm++;
	checkpoint_identity(other.identity, &warmer, 0x1234abcd);
	CHECK(checkpoint_read(&fresh.state, path, &other, &e) && e.code == ERR_FORMAT, "another start");
	float *x = trainer_features(&whole, whole.state.values, &e);
	const size_t last = whole.rows.n - 1; /* in the first panel, of 64 */
	CHECK(x && whole.rows.n <= 64, "%zu rows", whole.rows.n);
	for (size_t c = 0; x && c < 5; c++)
		CHECK(x[last * 5 + c] == train_state_x(&whole.state)[c * 64 + last], "number %zu", c);
	free(x);
	unlink(path);
	trainer_free(&whole);
	trainer_free(&part);
	trainer_free(&fresh);
}

static void test_no_weight(void)
{
	const struct trainer_options options = {.batch = 1, .feature_width = 1, .temperature = 1};
	struct sample s;
	struct trainer t;
	struct err e = {0};

	sample_init(&s);
	for (int v = 0; v < VIEWS; v++)
		memset(s.random[v].weight, 0, sizeof s.random[v].weight);
	sum_weights(s.views, s.weight);
	const struct trainer_source source = source_of(&s);
	CHECK(trainer_init(&t, &source, &options, &e) && e.code == ERR_FORMAT, "%s", e.message);
	trainer_free(&t);
}

/* A Gaussian that no view sees, put first, changes nothing that is learned. */
static void test_unseen_first(void)
{
	static const struct trainer_options options = {.batch = 1,
		.feature_width = 5,
		.interaction = REFER_PCMI,
		.rates = {0.01, 0.001},
		.temperature = 0.1,
		.lambda = 0.02,
		.share = 0.01};
	static struct sample s, more;
	static struct camera cameras[VIEWS];
	struct trainer t, u;
	struct err e;

	sample_init(&s);
	sample_init(&more);
	for (int v = 0; v < VIEWS; v++) {
		cameras[v] = (struct camera){.width = 8, .height = 8, .fx = 8, .fy = 8, .cx = 4, .cy = 4};
		for (int k = 0; k < 4; k++)
			cameras[v].world_to_camera[k][k] = 1;
		cameras[v].world_to_camera[2][3] = 5;
	}
	static float means[(GAUSSIANS + 1) * 3];
	memcpy(means + 3, s.means, sizeof s.means);
	for (int v = 0; v < VIEWS; v++) {
		int32_t *index = more.random[v].index;
		for (int64_t k = 0; k < more.random[v].indptr[PIXELS]; k++)
			index[k]++;
		more.views[v].weights.gaussians++;
	}
	memcpy(more.weight + 1, s.weight, sizeof(double) * GAUSSIANS);
	more.weight[0] = 0;
	struct trainer_source with = source_of(&more), without = source_of(&s);
	with.means = means;
	with.scene_gaussians = GAUSSIANS + 1;
	with.cameras = without.cameras = cameras;
	if (!CHECK(!trainer_init(&t, &without, &options, &e), "%s", e.message) ||
		!CHECK(!trainer_init(&u, &with, &options, &e), "%s", e.message))
		return;
	CHECK(t.rows.n > 1 && t.rows.n < t.learning, "%zu rows of %zu", t.rows.n, t.learning);
	CHECK(u.rows.n == t.rows.n && u.learning == t.learning, "%zu rows, and %zu with one more", t.rows.n,
		u.rows.n);
	CHECK(t.octree.n == u.octree.n &&
			!memcmp(t.octree.codes, u.octree.codes, t.octree.n * sizeof(int64_t)),
		"other leaves");
	steps(&t, 0, 5);
	steps(&u, 0, 5);
	CHECK(same_state(&t.state, &u.state), "it is learned from");
	trainer_free(&t);
	trainer_free(&u);
}

/* The sentences of a contrast: so many different ones, and some of the target's object, the same for the same
 * step, each as often as any. */
static void test_others(void)
{
	enum { SENTENCES = 20, PICKED = 6, STEPS = 4000, OWN = TRAIN_POSITIVES };
	struct train_view views[1] = {{.count = 1, .sentences = (int[]){0}}};
	const struct step_target targets[2] = {{3, NULL}, {6, NULL}};
	struct train_order o;
	int objects[SENTENCES], drawn[2][SENTENCES] = {0}, repeats = 0;
	size_t kept[PICKED] = {0};
	struct err e;

	for (int r = 0; r < SENTENCES; r++)
		objects[r] = r % 2 ? 1 : r % 6 == 0 ? 0 : 2; /* 4 sentences are of object 0, 10 of object 1 */
	struct train_contrast contrast = {SENTENCES, PICKED, objects};
	CHECK(!train_order_init(&o, views, 1, 2, &contrast, 3, &e), "%s", e.message);
	for (long i = 0; i < STEPS; i++) {
		const struct step_others others = train_order_others(&o, i, targets, 2);
		const size_t *list = others.list + 2 * OWN;
		if (!CHECK(others.count == PICKED + 2 * OWN, "step %ld: %zu", i, others.count))
			break;
		for (int k = 0; k < PICKED + 2 * OWN; k++) {
			const size_t r = others.list[k];
			int is_new = r < SENTENCES;
			for (int j = k < 2 * OWN ? 0 : 2 * OWN; j < k; j++)
				is_new &= others.list[j] != r;
			CHECK(is_new && (k >= OWN || objects[r] == 0) &&
					(k < OWN || k >= 2 * OWN || objects[r] == 1),
				"step %ld draws %zu", i, r);
			drawn[k < 2 * OWN][r]++;
		}
		repeats += i && !memcmp(kept, list, sizeof kept);
		memcpy(kept, list, sizeof kept);
		const struct step_others again = train_order_others(&o, i, targets, 2);
		CHECK(!memcmp(kept, again.list + 2 * OWN, sizeof kept), "step %ld again", i);
	}
	CHECK(repeats < 5, "%d steps draw as the one before", repeats);
	for (int r = 0; r < SENTENCES; r++) { /* 1200 +- 29, 1600 +- 31; four times that */
		CHECK(abs(drawn[0][r] - STEPS * PICKED / SENTENCES) < 116, "%d: drawn %d times", r,
			drawn[0][r]);
		CHECK(abs(drawn[1][r] - (objects[r] == 1     ? STEPS * OWN / 10
						: objects[r] ? 0
							     : STEPS)) < 124,
			"%d: drawn %d times as its object's", r, drawn[1][r]);
	}
	train_order_free(&o);
	for (size_t all = 0; all <= SENTENCES; all += SENTENCES) {
		contrast.negatives = all;
		CHECK(!train_order_init(&o, views, 1, 1, &contrast, 3, &e), "%s", e.message);
		CHECK(!train_order_others(&o, 0, targets, 1).list, "%zu are all", all);
		train_order_free(&o);
	}
}

int main(void)
{
	test_active_set();
	test_bounds();
	test_order();
	test_resume(11, 0);
	test_resume(11, 17); /* within the warm start, and after it */
	test_resume(11, 6);
	test_no_weight();
	test_unseen_first();
	test_others();
	return unit_end();
}
