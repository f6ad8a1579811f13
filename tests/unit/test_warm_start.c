/* A warm start: shares of rows against plain sums, the view whose pixels are rows, its step against the
 * float64 reference, and the features that it begins with. */
#include "unit.h"

#include "reference_problem.h"

#include "base/mem.h"
#include "base/rng.h"
#include "mask/bits.h"
#include "train/step.h"
#include "train/warm_start.h"

enum { N = 200, ROWS = 100, OBJECTS = 3, SENTENCES = 6 };

/* Two Gaussians a row, but for the first 2 of 202, which have none. Object 0 is most of rows 0 to 29, object
 * 1 is row 50 alone, object 2 lies where nothing learns. Sentence 3 is of something that was not lifted. */
struct scene {
	struct rows rows;
	struct lifted lifted;
	int32_t of[N + 2], index[N + 2];
	int64_t indptr[OBJECTS + 1];
	float share[N + 2], plain[OBJECTS][N + 2];
	double weight[N + 2];
	char *names[OBJECTS];
	const char *sentences[SENTENCES];
	struct warm_start_source source;
};

static void scene_init(struct scene *s)
{
	static char cup[] = "cup", plate[] = "plate", spoon[] = "spoon";
	struct rng rng;
	int64_t at = 0;

	*s = (struct scene){
		.names = {spoon, cup, plate}, .sentences = {"cup", "plate", "cup", "fork", "spoon", ""}};
	rng_seed(&rng, 3, 1);
	for (int i = 0; i < N + 2; i++) {
		s->of[i] = i < 2 ? -1 : (i - 2) / 2;
		s->weight[i] = 0.1 + rng_uniform(&rng);
	}
	for (int o = 0; o < OBJECTS; o++) {
		for (int i = 0; i < N + 2; i++) {
			const int row = s->of[i];
			const int is_in = o == 1 ? row >= 0 && row < 30 : o == 2 ? row == 50 : row < 0;
			if (!is_in)
				continue;
			s->plain[o][i] = o == 1 ? (float)rng_uniform(&rng) : 1;
			s->index[at] = i;
			s->share[at++] = s->plain[o][i];
		}
		s->indptr[o + 1] = at;
	}
	s->rows = (struct rows){N + 2, ROWS, s->of};
	s->lifted = (struct lifted){.gaussians = N + 2,
		.objects = OBJECTS,
		.names = s->names,
		.indptr = s->indptr,
		.index = s->index,
		.share = s->share};
	s->source = (struct warm_start_source){&s->lifted, &s->rows, s->weight, SENTENCES, s->sentences};
}

/* Matched objects are in the order in which sentences name them. */
static const int lifted_of[OBJECTS] = {1, 2, 0};

static void test_view(void)
{
	static struct scene s;
	struct warm_start w;
	struct err e;
	int wrong = 0, times[ROWS] = {0};

	scene_init(&s);
	if (!CHECK(!warm_start_init(
			   &w, &s.source, &(struct train_contrast){s.source.sentences, 0, NULL}, 1, &e),
		    "%s", e.message))
		return;
	CHECK(w.objects == OBJECTS, "%zu objects", w.objects);
	for (int k = 0; k < OBJECTS; k++)
		for (int r = 0; r < ROWS; r++) {
			double sum = 0, all = 0;
			for (int i = 2 + 2 * r; i < 4 + 2 * r; i++) {
				sum += s.weight[i] * (double)s.plain[lifted_of[k]][i];
				all += s.weight[i];
			}
			wrong += fabs(sum / all - (double)w.share[k * ROWS + r]) > 1e-6;
		}
	CHECK(!wrong, "%d shares are wrong", wrong);
	const struct view_weights *v = &w.view.weights;
	/* One row of 100 is less than 2 in 100: twice. */
	CHECK(v->pixels == ROWS + 1 && v->gaussians == ROWS, "%zu pixels", v->pixels);
	for (size_t p = 0; p < v->pixels; p++) {
		wrong += v->indptr[p + 1] - v->indptr[p] != 1 || v->weight[p] != 1;
		times[v->index[p]]++;
	}
	for (int r = 0; r < ROWS; r++)
		wrong += times[r] != (r == 50 ? 2 : 1);
	CHECK(!wrong, "%d pixels are wrong", wrong);
	const int expected[5] = {0, 1, 2, 4, 5};
	CHECK(w.view.count == 5, "%d sentences", w.view.count);
	for (int k = 0; k < w.view.count; k++) {
		const char *name = s.sentences[expected[k]];
		const int own = !strcmp(name, "cup") ? 0 : !strcmp(name, "plate") ? 1 : 2;
		uint8_t mask[ROWS + 1];
		bits_expand(w.view.masks[k], 0, ROWS + 1, mask);
		wrong += w.view.sentences[k] != expected[k];
		for (int p = 0; p <= ROWS; p++)
			wrong += mask[p] != (*name && w.share[own * ROWS + v->index[p]] > 0.5f);
	}
	CHECK(!wrong, "%d masks are wrong", wrong);
	warm_start_free(&w);
}

static void test_features(void)
{
	static struct scene s;
	struct warm_start w;
	struct err e;

	scene_init(&s);
	if (!CHECK(!warm_start_init(
			   &w, &s.source, &(struct train_contrast){s.source.sentences, 0, NULL}, 1, &e),
		    "%s", e.message))
		return;
	for (int width = 1; width <= 16; width += 15) {
		float x[ROWS * 16], again[ROWS * 16], other[ROWS * 16];
		double longest = 0, off = 0;
		CHECK(!warm_start_features(&w, width, 1, x, &e) &&
				!warm_start_features(&w, width, 1, again, &e) &&
				!warm_start_features(&w, width, 2, other, &e),
			"%s", e.message);
		CHECK(!memcmp(x, again, sizeof *x * ROWS * (size_t)width), "not the same twice");
		CHECK(width == 1 || memcmp(x, other, sizeof *x * ROWS * (size_t)width),
			"seed 2 is as seed 1");
		for (int c = 0; c < width; c++)
			longest += (double)x[50 * width + c] * (double)x[50 * width + c];
		CHECK(fabs(sqrt(longest) - 8) < 1e-5, "width %d: length %g", width, sqrt(longest));
		/* Rows of one object have its direction, as far as they are of it. */
		for (int r = 0; r < 30; r++)
			for (int c = 0; c < width; c++)
				off += fabs((double)x[r * width + c] * (double)w.share[0] -
					    (double)x[c] * (double)w.share[r]);
		CHECK(off < 1e-4, "width %d: directions differ by %g", width, off);
		for (int c = 0; c < width; c++)
			CHECK(x[70 * width + c] == 0, "a row of nothing");
	}
	warm_start_free(&w);
}

static void to_floats(const double *from, size_t count, float *to)
{
	for (size_t i = 0; i < count; i++)
		to[i] = (float)from[i];
}

static double distance(const float *a, const double *b, size_t count)
{
	double difference = 0, size = 0;

	for (size_t i = 0; i < count; i++) {
		difference += ((double)a[i] - b[i]) * ((double)a[i] - b[i]);
		size += b[i] * b[i];
	}
	return sqrt(difference / size);
}

/* The reference on that view: its problem with the view's weights and the mask of a sentence. */
static void test_step(void)
{
	static struct scene s;
	struct reference_options o = reference_defaults(5, REFER_PCMI, REFER_DOT, REFER_CONTRAST_COSINE);
	struct reference_sample sample;
	struct refer_result result;
	struct warm_start w;
	struct err e;

	scene_init(&s);
	o.n = ROWS;
	o.pixels = ROWS + 1;
	o.sentences = SENTENCES;
	reference_sample_init(&sample, &o);
	if (!CHECK(!warm_start_init(
			   &w, &s.source, &(struct train_contrast){s.source.sentences, 0, NULL}, 1, &e),
		    "%s", e.message))
		return;
	struct refer_problem p = sample.problem;
	const size_t features = ROWS * (size_t)o.feature_width, parameters = sample.layout.count;
	double ones[ROWS + 1];
	uint8_t mask[ROWS + 1];
	int64_t offsets[SENTENCES + 1];
	for (int i = 0; i <= ROWS; i++)
		ones[i] = 1;
	for (int r = 0; r <= SENTENCES; r++)
		offsets[r] = (int64_t)p.offsets[r];
	bits_expand(w.view.masks[2], 0, ROWS + 1, mask);
	p.indptr = w.indptr;
	p.index = w.index;
	p.weight = ones;
	p.mask = mask;
	p.target = (size_t)w.view.sentences[2];
	const size_t words = p.offsets[SENTENCES] * (size_t)o.text_width;
	float *floats = mem_alloc(
		2 * parameters + 4 * panels_padded(ROWS) * 32 + words + 3 * ROWS, sizeof(float), "test", &e);
	float *values = floats, *gradient = values + parameters, *x = gradient + parameters;
	float *panels = x + features, *dpanels = panels + panels_padded(ROWS) * 32;
	float *position = dpanels + panels_padded(ROWS) * 32, *vectors = position + 3 * ROWS;
	double *dx = mem_alloc(features + parameters, sizeof *dx, "test", &e);
	to_floats(p.parameters, parameters, values);
	to_floats(p.x, features, x);
	to_floats(p.position, 3 * ROWS, position);
	to_floats(p.words, words, vectors);
	panels_pack(x, ROWS, o.feature_width, panels);
	const struct step_setup setup = {&sample.layout, p.similarity, p.contrast, p.temperature, p.lambda,
		ROWS, position, NULL, SENTENCES, offsets, vectors, p.objects, ROWS + 1, WARM_START_BATCH,
		NULL};
	struct step *step = step_new(&setup, &e);
	const struct step_target target = {p.target, w.view.masks[2]};
	CHECK(step && !reference_forward(&p, &result, &e) &&
			!reference_backward(&p, &result, dx, dx + features, &e),
		"%s", e.message);
	const struct step_losses losses = step_run(step, values, panels, &w.view.weights, &target, 1,
		(size_t)(p.tau * ROWS), NULL, gradient, dpanels);
	CHECK(fabs(losses.bce - result.bce) < 1e-5 * result.bce, "bce %.9g, reference %.9g", losses.bce,
		result.bce);
	for (int i = 0; i <= ROWS; i++)
		CHECK(fabs(result.image[i] - result.m[w.index[i]]) < 1e-12, "pixel %d is not its row's m", i);
	panels_unpack(dpanels, ROWS, o.feature_width, x);
	CHECK(distance(x, dx, features) < 2e-4, "dx differs by %.3g", distance(x, dx, features));
	CHECK(distance(gradient, dx + features, parameters) < 2e-4, "parameters differ by %.3g",
		distance(gradient, dx + features, parameters));
	step_free(step);
	reference_free(&result);
	reference_sample_free(&sample);
	warm_start_free(&w);
	free(floats);
	free(dx);
}

int main(void)
{
	test_view();
	test_features();
	test_step();
	return unit_end();
}
