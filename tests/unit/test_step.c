/* The folded float32 step against the plain float64 reference: losses, responses and every gradient; with
 * features of several widths. */
#include "unit.h"

#include "reference_floats.h"

#include "base/mem.h"

#include <omp.h>
#include <sys/resource.h>

/* One, a part of a tile, the default and the most. */
static const int widths[4] = {1, 5, 16, REFER_MAX_X};

/* The contrasts of a sample: of all sentences; of the target with one of its own and of the others; the same
 * of rows that Gaussians share. */
static const struct {
	const char *name;
	size_t others[2];
	double times[5]; /* how often each sentence counts then */
	int is_shared;
} samples[3] = {{"all", {0}, {1, 1, 1, 1, 1}, 0}, {"some", {4, 1}, {0, 2, 1.5, 0, 1.5}, 0},
	{"some, of shared rows", {4, 1}, {0, 2, 1.5, 0, 1.5}, 1}};

enum { KERNELS = 3 };
static const char *const kernels[KERNELS] = {"plain", "avx2", "avx512"};

/* What the reference says of a sample. */
struct expected {
	struct refer_result result;
	double *dx, *dparameters;
};

/* The gradients of a sample's parameters against the reference; returns the worst relative error. */
static double compare_parameters(
	const struct reference_sample *s, const struct floats *f, const struct expected *x, const char *name)
{
	double worst = 0;

	for (int t = 0; t < REFER_TENSORS; t++) {
		size_t count = (size_t)s->layout.tensors[t].rows * (size_t)s->layout.tensors[t].columns;
		size_t at = s->layout.tensors[t].offset;
		double own = distance(f->gradient + at, x->dparameters + at, count);
		if (t == KEY_BIAS || t == KEY_POSITION_BIAS) { /* 0 but for rounding; ours is exactly 0 */
			for (size_t k = 0; k < count; k++)
				CHECK(f->gradient[at + k] == 0 && fabs(x->dparameters[at + k]) < 1e-12,
					"%s: %s is not 0", name, s->layout.tensors[t].name);
			continue;
		}
		CHECK(own < 2e-4, "%s: gradient of %s differs by %.3g", name, s->layout.tensors[t].name, own);
		worst = fmax(worst, own);
	}
	return worst;
}

/* One step of a sample against the reference; returns the worst relative gradient error over the arrays. */
static double compare_step(const struct reference_sample *s, struct floats *f, const struct expected *x,
	const char *with, const struct step_others *others, const char *name)
{
	const struct refer_problem *p = &s->problem;
	const struct refer_result *result = &x->result;
	const int width = s->layout.feature_width;
	struct err e;

	struct step *step = make_step(s, f, 1, with);
	struct view_weights view = view_of(p, f);
	struct step_target target = {p->target, f->mask};
	struct step_losses losses = step_run(step, f->parameters, f->panels, &view, &target, 1, top_count(p),
		others, f->gradient, f->dpanels);
	float *m = mem_alloc(p->n, sizeof *m, "test", &e);
	step_respond(step, f->parameters, f->panels, p->target, m);
	double off = distance(m, result->m, p->n);
	CHECK(off < 1e-5, "%s: responses differ by %.3g", name, off);
	CHECK(fabs(losses.bce - result->bce) < 1e-5 * fabs(result->bce), "%s: bce %.9g, reference %.9g", name,
		losses.bce, result->bce);
	CHECK(fabs(losses.contrast - result->contrast) <= 1e-4 * fabs(result->contrast),
		"%s: contrast %.9g, reference %.9g", name, losses.contrast, result->contrast);
	panels_unpack(f->dpanels, p->n, width, f->dx);
	const double worst = distance(f->dx, x->dx, p->n * (size_t)width);
	CHECK(worst < 2e-4, "%s: dx differs by %.3g", name, worst);
	free(m);
	step_free(step);
	return fmax(worst, compare_parameters(s, f, x, name));
}

/* Several blocks, the last not full; and so many that in no sample a unit is so near to 0 that float32 takes
 * the other side of its kink. What sanitizers find in many they find in some. */
#ifdef __SANITIZE_ADDRESS__
enum { MANY = 150 };
#else
enum { MANY = 1500 };
#endif

/* One sample by all kernels that there are: worst (KERNELS) grows. */
static void compare(const struct reference_options *o, int sampled, const char *name, double *worst)
{
	const struct step_others some = {samples[sampled].others, 2}, *others = sampled ? &some : NULL;
	struct reference_sample s;
	struct expected x;
	struct floats f;
	struct err e;

	reference_sample_init(&s, o);
	struct refer_problem *p = &s.problem;
	uint32_t *counts = mem_alloc(p->n, sizeof *counts, "test", &e);
	for (size_t i = 0; i < p->n; i++)
		counts[i] = 1 + (uint32_t)(i * i % 7);
	p->times = samples[sampled].times;
	p->counts = samples[sampled].is_shared ? counts : NULL;
	x.dx = mem_alloc(p->n, (size_t)o->feature_width * sizeof *x.dx, "test", &e);
	x.dparameters = mem_alloc(s.layout.count, sizeof *x.dparameters, "test", &e);
	CHECK(!reference_forward(p, &x.result, &e) &&
			!reference_backward(p, &x.result, x.dx, x.dparameters, &e),
		"%s", name);
	for (int k = 0; k < KERNELS && block_select(kernels[k]); k++) {
		char with[160];
		snprintf(with, sizeof with, "%s, %s", kernels[k], name);
		floats_init(&f, &s);
		worst[k] = fmax(worst[k], compare_step(&s, &f, &x, kernels[k], others, with));
		floats_free(&f);
	}
	mem_free_all(x.dx, x.dparameters, counts);
	reference_free(&x.result);
	reference_sample_free(&s);
}

static void against_reference(void)
{
	for (int i = 0; i < REFER_INTERACTIONS; i++)
		for (int sim = 0; sim < (i == REFER_PCMI_PROJ ? 1 : 2); sim++) {
			const char *const of = refer_interaction_name((enum refer_interaction)i),
					  *const by = refer_similarity_name((enum refer_similarity)sim);
			double worst[KERNELS] = {0};
			for (int k = 0; k < 3 * REFER_CONTRASTS; k++) {
				const int c = k / 3;
				struct reference_options o =
					reference_defaults(7 + (uint64_t)c, (enum refer_interaction)i,
						(enum refer_similarity)sim, (enum refer_contrast)c);
				char name[128];
				o.n = MANY;
				o.feature_width = widths[k % 4];
				snprintf(name, sizeof name, "%s, %s, contrast %d with %s, width %d", of, by,
					c, samples[k % 3].name, o.feature_width);
				compare(&o, k % 3, name, worst);
			}
			printf("%s, %s: worst relative gradient error %.2g plain, %.2g avx2, %.2g avx512\n",
				of, by, worst[0], worst[1], worst[2]);
		}
}

/* AVX2 gives the bits of AVX-512. */
static void fused_kernels_are_equal(enum refer_interaction interaction)
{
	struct reference_options o = reference_defaults(5, interaction, REFER_DOT, REFER_CONTRAST_COSINE);
	struct reference_sample s;
	struct floats f;
	struct err e;

	o.n = 700;
	o.feature_width = widths[interaction % 4];
	reference_sample_init(&s, &o);
	floats_init(&f, &s);
	const size_t count = s.layout.count, features = panels_padded(s.problem.n) * (size_t)o.feature_width;
	float *kept = mem_zalloc(count + features, sizeof *kept, "test", &e);
	struct view_weights view = view_of(&s.problem, &f);
	const struct step_target target = {s.problem.target, f.mask};
	for (int i = 0; i < 2; i++) {
		struct step *step = make_step(&s, &f, 1, i ? "avx512" : "avx2");
		step_run(step, f.parameters, f.panels, &view, &target, 1, top_count(&s.problem), NULL,
			f.gradient, f.dpanels);
		step_free(step);
		if (i)
			CHECK(!memcmp(kept, f.gradient, sizeof *kept * count) &&
					!memcmp(kept + count, f.dpanels, sizeof *kept * features),
				"%s: other gradients", refer_interaction_name(interaction));
		memcpy(kept, f.gradient, sizeof *kept * count);
		memcpy(kept + count, f.dpanels, sizeof *kept * features);
	}
	free(kept);
	floats_free(&f);
	reference_sample_free(&s);
}

/* Several sentences in one step: the mean of their single steps. */
static void batch_is_the_mean(enum refer_interaction interaction, enum refer_similarity similarity)
{
	struct reference_options o = reference_defaults(3, interaction, similarity, REFER_CONTRAST_COSINE);
	struct reference_sample s;
	struct floats f;
	struct err e;

	o.n = 1100;
	o.feature_width = widths[interaction % 4];
	reference_sample_init(&s, &o);
	floats_init(&f, &s);
	const struct refer_problem *p = &s.problem;
	const size_t count = s.layout.count, features = panels_padded(p->n) * (size_t)o.feature_width;
	double *sum = mem_zalloc(count + features, sizeof *sum, "test", &e);
	struct view_weights view = view_of(p, &f);
	struct step_target targets[3] = {{0, f.mask}, {3, f.mask}, {1, f.mask}};
	struct step *one = make_step(&s, &f, 1, NULL), *three = make_step(&s, &f, 3, NULL);
	double loss = 0;
	for (int i = 0; i < 3; i++) {
		loss += step_run(one, f.parameters, f.panels, &view, &targets[i], 1, 50, NULL, f.gradient,
				f.dpanels)
				.total /
			3;
		for (size_t k = 0; k < count; k++)
			sum[k] += (double)f.gradient[k] / 3;
		for (size_t k = 0; k < features; k++)
			sum[count + k] += (double)f.dpanels[k] / 3;
	}
	double together =
		step_run(three, f.parameters, f.panels, &view, targets, 3, 50, NULL, f.gradient, f.dpanels)
			.total;
	CHECK(fabs(together - loss) < 1e-6 * loss, "%d: loss %.9g, mean of three %.9g", interaction, together,
		loss);
	CHECK(distance(f.gradient, sum, count) < 1e-4, "%d: gradients differ by %.3g", interaction,
		distance(f.gradient, sum, count));
	CHECK(distance(f.dpanels, sum + count, features) < 1e-4, "%d: dx differs by %.3g", interaction,
		distance(f.dpanels, sum + count, features));
	step_free(one);
	step_free(three);
	free(sum);
	floats_free(&f);
	reference_sample_free(&s);
}

/* The same bytes for any number of threads. */
static void threads_agree(enum refer_interaction interaction)
{
	struct reference_options o = reference_defaults(5, interaction, REFER_DOT, REFER_CONTRAST_COSINE);
	struct reference_sample s;
	struct floats f;
	struct err e;

	o.n = 4 * MANY;
	o.feature_width = widths[(interaction + 1) % 4];
	o.pixels = 3000;
	reference_sample_init(&s, &o);
	floats_init(&f, &s);
	const struct refer_problem *p = &s.problem;
	const size_t count = s.layout.count, features = panels_padded(p->n) * (size_t)o.feature_width;
	float *kept = mem_alloc(count + features, sizeof *kept, "test", &e);
	struct view_weights view = view_of(p, &f);
	struct step_target target = {p->target, f.mask};
	for (int threads = 1; threads <= 3; threads++) {
		omp_set_num_threads(threads);
		struct step *step = make_step(&s, &f, 1, NULL);
		step_run(step, f.parameters, f.panels, &view, &target, 1, 60, NULL, f.gradient, f.dpanels);
		step_free(step);
		if (threads > 1)
			CHECK(!memcmp(kept, f.gradient, sizeof *kept * count) &&
					!memcmp(kept + count, f.dpanels, sizeof *kept * features),
				"%d: %d threads give other bytes than one", interaction, threads);
		memcpy(kept, f.gradient, sizeof *kept * count);
		memcpy(kept + count, f.dpanels, sizeof *kept * features);
	}
	free(kept);
	floats_free(&f);
	reference_sample_free(&s);
}

/* Memory goes with the longest sentence, not with all words of a step: 64 sentences of 64 words in 1 GiB. The
 * address sanitizer takes more than that for itself. */
static void batches_fit_in_memory(void)
{
#ifndef __SANITIZE_ADDRESS__
	enum { BATCH = 64, WORDS = 64 };
	struct reference_options o = reference_defaults(5, REFER_PCMI, REFER_DOT, REFER_CONTRAST_COSINE);
	struct reference_sample s;
	struct floats f;
	struct rlimit before, least;

	o.sentences = BATCH;
	o.min_words = o.max_words = WORDS;
	reference_sample_init(&s, &o);
	floats_init(&f, &s);
	getrlimit(RLIMIT_AS, &before);
	least = before;
	least.rlim_cur = (rlim_t)1 << 30;
	if (CHECK(!setrlimit(RLIMIT_AS, &least), "no limit")) {
		omp_set_num_threads(1);
		struct step *step = make_step(&s, &f, BATCH, NULL);
		CHECK(step, "no memory for %d sentences", BATCH);
		step_free(step);
		setrlimit(RLIMIT_AS, &before);
	}
	floats_free(&f);
	reference_sample_free(&s);
#endif
}

int main(void)
{
	for (int i = 0; i < REFER_INTERACTIONS; i++) {
		batch_is_the_mean((enum refer_interaction)i, REFER_DOT);
		if (i != REFER_PCMI_PROJ)
			batch_is_the_mean((enum refer_interaction)i, REFER_COSINE);
		threads_agree((enum refer_interaction)i);
		if (block_select("avx512"))
			fused_kernels_are_equal((enum refer_interaction)i);
	}
	batches_fit_in_memory();
	against_reference();
	return unit_end();
}
