#include "unit.h"

#include "base/rng.h"
#include "reference_problem.h"

enum {
	SAMPLES = UNIT_DRAWS(12, 2), /* entries of each array */
	ARRAYS = REFER_TENSORS + 1,  /* the slab's, and x */
	CONTRASTS = REFER_CONTRASTS,
};

/* Norms over the sampled entries of one array. */
struct agreement {
	double difference, gradient, numeric;
};

struct tally {
	int samples, skips;
	double worst;
	const char *worst_name;
};

static const char *array_name(const struct refer_layout *l, int a)
{
	return a == REFER_TENSORS ? "x" : l->tensors[a].name;
}

static int same_signs(const double *a, const double *b, size_t count)
{
	for (size_t i = 0; i < count; i++)
		if ((a[i] > 0) != (b[i] > 0))
			return 0;
	return 1;
}

/* 1 when no ReLU switched and f_g is over the same Gaussians, of which the last is cut: the loss is smooth
 * between the two. */
static int same_piece(
	const struct refer_problem *p, const struct refer_result *a, const struct refer_result *b)
{
	const size_t N = p->n, W = p->offsets[p->sentences], last = a->top_count - 1;

	if (p->counts && (b->top_count != a->top_count || b->top[last] != a->top[last]))
		return 0;
	for (size_t t = 0; t < a->top_count; t++) {
		size_t u = 0;
		while (u < b->top_count && b->top[u] != a->top[t])
			u++;
		if (u == b->top_count)
			return 0;
	}
	return same_signs(a->text_hidden0, b->text_hidden0, W * REFER_T1) &&
	       same_signs(a->text_hidden1, b->text_hidden1, W * REFER_T2) &&
	       same_signs(a->feature_hidden0, b->feature_hidden0, N * REFER_XH) &&
	       same_signs(a->feature_hidden1, b->feature_hidden1, N * REFER_H) &&
	       same_signs(a->position_hidden0, b->position_hidden0, N * REFER_PH) &&
	       same_signs(a->position_hidden1, b->position_hidden1, N * REFER_H);
}

static struct refer_problem with_contrast(const struct reference_sample *s, int contrast)
{
	struct refer_problem with = s->problem;

	with.contrast = (enum refer_contrast)contrast;
	if (contrast == REFER_CONTRAST_DOT)
		with.temperature *= 50; /* the sample's is for cosines */
	return with;
}

/* The loss under each kind of contrast, from one forward pass: the kinds differ only in what f_g and e give.
 */
static void losses(
	const struct reference_sample *s, const struct refer_result *result, double loss[CONTRASTS])
{
	for (int c = 0; c < CONTRASTS; c++) {
		const struct refer_problem with = with_contrast(s, c);
		struct err e = {0};
		double contrast;
		if (reference_contrast(&with, result, &contrast, &e))
			exit(1);
		loss[c] = result->bce + with.lambda * contrast;
	}
}

/* Four-point central differences of the loss by one entry, for each contrast. Returns 0, or -1 where the loss
 * is not smooth over the stencil. */
static int differentiate(struct reference_sample *s, const struct refer_result *at, double *entry,
	double step, double slope[CONTRASTS])
{
	static const double places[4] = {-2, -1, 1, 2}, factors[4] = {1, -8, 8, -1};
	const double kept = *entry;
	int is_smooth = 1;

	memset(slope, 0, CONTRASTS * sizeof *slope);
	for (int k = 0; k < 4 && is_smooth; k++) {
		struct refer_result moved;
		struct err e = {0};
		double loss[CONTRASTS];
		*entry = kept + places[k] * step;
		if (reference_forward(&s->problem, &moved, &e))
			exit(1);
		losses(s, &moved, loss);
		is_smooth = same_piece(&s->problem, at, &moved);
		for (int c = 0; c < CONTRASTS; c++)
			slope[c] += factors[k] * loss[c] / (12 * step);
		reference_free(&moved);
	}
	*entry = kept;
	return is_smooth ? 0 : -1;
}

/* Samples entries of array a; adds to found[c]. Returns how many samples were skipped. */
static int sample_array(const struct reference_sample *sample, const struct refer_result *at, int a,
	double *const dx[CONTRASTS], double *const dparameters[CONTRASTS], struct agreement found[CONTRASTS])
{
	const struct refer_layout *l = &sample->layout;
	const size_t count = a == REFER_TENSORS ? sample->problem.n * (size_t)l->feature_width
						: (size_t)l->tensors[a].rows * (size_t)l->tensors[a].columns;
	const size_t offset = a == REFER_TENSORS ? 0 : l->tensors[a].offset;
	struct reference_sample s;
	struct rng r;
	int skips = 0, done = 0;

	reference_sample_copy(&s, sample);
	rng_seed(&r, 11, (uint64_t)a);
	while (done < SAMPLES && skips < 2 * SAMPLES) {
		const size_t k = offset + rng_below(&r, (uint32_t)count);
		double slope[CONTRASTS];
		if (differentiate(&s, at, (a == REFER_TENSORS ? s.x : s.parameters) + k, 1e-4, slope)) {
			skips++;
			continue;
		}
		done++;
		for (int c = 0; c < CONTRASTS; c++) {
			const double g = (a == REFER_TENSORS ? dx : dparameters)[c][k];
			found[c].difference += (g - slope[c]) * (g - slope[c]);
			found[c].gradient += g * g;
			found[c].numeric += slope[c] * slope[c];
		}
	}
	reference_sample_free(&s);
	return skips;
}

/* A gradient that is zero by its nature (the keys' biases, which a softmax over the keys does not see; the
 * first layer where x is 0) has no relative error: there the differences must vanish, but for rounding. */
static void judge(const struct reference_sample *s, int a, int contrast, const struct agreement *found,
	double noise, struct tally *tally)
{
	const double larger = sqrt(fmax(found->gradient, found->numeric));
	const double difference = sqrt(found->difference), relative = larger > 0 ? difference / larger : 0;

	if (sqrt(found->gradient) < 1e-11) {
		CHECK(sqrt(found->numeric) < noise, "%s, contrast %d: 0, differences give %g",
			array_name(&s->layout, a), contrast, sqrt(found->numeric));
		return;
	}
	CHECK(relative < 1e-6, "%s, %s, contrast %d, %s: %g of %g",
		refer_interaction_name(s->layout.interaction), refer_similarity_name(s->problem.similarity),
		contrast, array_name(&s->layout, a), relative, larger);
	if (relative > tally->worst) {
		tally->worst = relative;
		tally->worst_name = array_name(&s->layout, a);
	}
}

/* All arrays and all contrasts of one sample. */
static void gradients(const struct reference_sample *s, struct tally *tally)
{
	struct agreement found[ARRAYS][CONTRASTS] = {0};
	int skips[ARRAYS] = {0};
	double *dx[CONTRASTS], *dparameters[CONTRASTS], loss[CONTRASTS];
	struct refer_result at;
	struct err e = {0};

	if (!CHECK(!reference_forward(&s->problem, &at, &e), "%s", e.message))
		exit(1);
	losses(s, &at, loss);
	for (int c = 0; c < CONTRASTS; c++) {
		const struct refer_problem with = with_contrast(s, c);
		dx[c] = malloc(with.n * (size_t)s->layout.feature_width * sizeof **dx);
		dparameters[c] = malloc(s->layout.count * sizeof **dparameters);
		CHECK(!reference_backward(&with, &at, dx[c], dparameters[c], &e), "%s", e.message);
	}
#pragma omp parallel for schedule(dynamic)
	for (int a = 0; a < ARRAYS; a++)
		if (a == REFER_TENSORS || s->layout.tensors[a].rows)
			skips[a] = sample_array(s, &at, a, dx, dparameters, found[a]);
	for (int a = 0; a < ARRAYS; a++) {
		if (a < REFER_TENSORS && !s->layout.tensors[a].rows)
			continue;
		for (int c = 0; c < CONTRASTS; c++)
			judge(s, a, c, &found[a][c], 1e-9 * fmax(1, loss[c]), tally);
		tally->skips += skips[a];
		tally->samples += SAMPLES;
	}
	for (int c = 0; c < CONTRASTS; c++) {
		free(dx[c]);
		free(dparameters[c]);
	}
	reference_free(&at);
}

/* Fewer Gaussians and words than the default, since the differences take thousands of forward passes. */
static struct reference_options small_options(
	enum refer_interaction interaction, enum refer_similarity similarity)
{
	struct reference_options o = reference_defaults(21, interaction, similarity, REFER_CONTRAST_COSINE);

	o.n = 20;
	o.sentences = 4; /* two of each object */
	o.min_words = 2;
	o.max_words = 3;
	o.tau = 0.2;
	return o;
}

static void check_gradients(const struct reference_options *o, struct tally *tally)
{
	static const uint32_t counts[20] = {3, 1, 2, 2, 1, 5, 1, 3, 3, 1, 2, 2, 3, 1, 1, 2, 4, 1, 2, 3};
	struct reference_sample s;

	reference_sample_init(&s, o);
	if (o->similarity == REFER_COSINE && o->n == 20)
		s.problem.counts = counts;
	gradients(&s, tally);
	reference_sample_free(&s);
}

/* Of features of several widths: those of pcmi, the method, are 1 and 5. */
static void all_gradients(void)
{
	static const int widths[4] = {1, 5, 16, REFER_MAX_X};

	for (int i = 0; i < REFER_INTERACTIONS; i++) {
		struct tally tally = {0};
		for (int k = REFER_DOT; k <= (i == REFER_PCMI_PROJ ? REFER_DOT : REFER_COSINE); k++) {
			struct reference_options o =
				small_options((enum refer_interaction)i, (enum refer_similarity)k);
			o.feature_width = widths[(i + k) % 4];
			check_gradients(&o, &tally);
		}
		printf("reference: %-12s worst relative error of a gradient %.1e (%s), %d entries, %d skipped\n",
			refer_interaction_name((enum refer_interaction)i), tally.worst, tally.worst_name,
			tally.samples, tally.skips);
		CHECK(tally.skips < tally.samples / 5, "%d skips, %d samples", tally.skips, tally.samples);
	}
}

/* A contrast that is saturated, or that has no weight beside the masks, would let the gradients above pass
 * unseen. */
static void contrast_is_live(void)
{
	const struct reference_options o = small_options(REFER_PCMI, REFER_DOT);
	struct reference_sample s;
	struct refer_result r;
	struct err e = {0};
	double loss[CONTRASTS];

	reference_sample_init(&s, &o);
	CHECK(!reference_forward(&s.problem, &r, &e), "%s", e.message);
	losses(&s, &r, loss);
	for (int c = 1; c < CONTRASTS; c++)
		CHECK(loss[c] - loss[0] > 0.1 && loss[c] - loss[0] < 2, "contrast %d is %g", c,
			loss[c] - loss[0]);
	reference_free(&r);
	reference_sample_free(&s);
}

/* Losses that PyTorch float64 gives for the default problem of seed 1 (tests/peers/model_torch.py). */
static void known_answers(void)
{
	static const double expected[REFER_INTERACTIONS][2][2] = {
		[REFER_NONE] = {{4.89252153154621, 4.90297984638212}, {1.47889273762324, 1.48935105245915}},
		[REFER_ATTENTION] = {{46.7298669835472, 46.6816257428792},
			{1.57861616938952, 1.57280651525714}},
		[REFER_ATTENTION_FP] = {{76.6355882113937, 76.471272644194},
			{1.83742459575044, 1.68868143380091}},
		[REFER_ADD] = {{4.01859512412862, 4.00986079651458}, {1.49225340050808, 1.48351907289405}},
		[REFER_PCMI] = {{76.5829157442819, 76.4180424008107}, {1.8157325748702, 1.68564441024751}},
		[REFER_PCMI_PROJ] = {{6.05326831523635, 6.06174089479996}},
	};

	for (int i = 0; i < REFER_INTERACTIONS; i++)
		for (int k = 0; k < 4 && expected[i][k / 2][k % 2] > 0; k++) {
			const double loss = expected[i][k / 2][k % 2];
			const struct reference_options o = reference_defaults(1, (enum refer_interaction)i,
				(enum refer_similarity)(k / 2), (enum refer_contrast)(1 + k % 2));
			struct reference_sample s;
			struct refer_result r;
			struct err e = {0};
			reference_sample_init(&s, &o);
			CHECK(!reference_forward(&s.problem, &r, &e), "%s", e.message);
			CHECK(fabs(r.loss / loss - 1) < 1e-9, "%s, case %d: %.15g, not %.15g",
				refer_interaction_name(o.interaction), k, r.loss, loss);
			reference_free(&r);
			reference_sample_free(&s);
		}
}

/* The start of training: every f_i is the same. */
static void from_zero(void)
{
	struct reference_options o = small_options(REFER_PCMI, REFER_DOT);
	struct tally tally = {0};
	struct reference_sample s;
	struct refer_result r;
	struct err e = {0};

	o.x_scale = 0;
	check_gradients(&o, &tally);
	o.interaction = REFER_ATTENTION;
	reference_sample_init(&s, &o);
	CHECK(!reference_forward(&s.problem, &r, &e), "%s", e.message);
	for (size_t t = 0; t < 4; t++)
		CHECK(r.top_count == 4 && r.top[t] == t, "of equal responses, place %zu has Gaussian %zu", t,
			r.top[t]);
	reference_free(&r);
	reference_sample_free(&s);
}

/* |M| ~ 1e4 and scores of the contrast ~ 1e4. */
static void huge_logits(void)
{
	const struct reference_options o = small_options(REFER_PCMI, REFER_DOT);
	struct reference_sample s;
	struct refer_result r;
	struct tally tally = {0};
	struct err e = {0};
	double largest = 0, expected = 0;

	CHECK(reference_bce(1e4, 0) == 1e4 && reference_bce(1e4, 1) == 0 && reference_bce(-1e300, 1) == 1e300,
		"bce");
	CHECK(reference_bce_slope(1e4, 0) == 1 && reference_bce_slope(-1e4, 1) == -1 &&
			reference_bce_slope(1e300, 1) == 0 && reference_bce_slope(0, 1) == -0.5,
		"slope");
	reference_sample_init(&s, &o);
	CHECK(!reference_forward(&s.problem, &r, &e), "%s", e.message);
	for (size_t v = 0; v < o.pixels; v++)
		largest = fmax(largest, fabs(r.image[v]));
	for (int64_t k = 0; k < s.indptr[o.pixels]; k++)
		s.weight[k] *= 1e4 / largest;
	s.problem.temperature *= 1e-5;
	reference_free(&r);

	CHECK(!reference_forward(&s.problem, &r, &e), "%s", e.message);
	for (size_t v = 0; v < o.pixels; v++)
		if (r.image[v] == 0)
			expected += log(2) / (double)o.pixels;
		else if ((r.image[v] > 0) != (s.mask[v] != 0))
			expected += fabs(r.image[v]) / (double)o.pixels;
	CHECK(expected > 100 && fabs(r.bce / expected - 1) < 1e-3, "bce %g, wrong pixels cost %g", r.bce,
		expected);
	CHECK(r.contrast > 1e3 && r.contrast < 1e7, "contrast %g", r.contrast);
	reference_free(&r);
	gradients(&s, &tally);
	reference_sample_free(&s);
}

/* One word takes all attention: f' = f + w, and e is the word. */
static void one_word(void)
{
	struct reference_options o = small_options(REFER_PCMI, REFER_DOT);
	struct reference_sample s;
	struct refer_result r;
	struct tally tally = {0};
	struct err e = {0};
	double worst = 0;

	o.min_words = o.max_words = 1;
	reference_sample_init(&s, &o);
	CHECK(!reference_forward(&s.problem, &r, &e), "%s", e.message);
	const double *w = r.w + s.problem.target * REFER_D;
	for (size_t i = 0; i < o.n * REFER_D; i++)
		worst = fmax(worst, fabs(r.refined[i] - r.f[i] - w[i % REFER_D]));
	CHECK(worst < 1e-15, "f' is not f + w by %g", worst);
	CHECK(!memcmp(r.e, r.w, o.sentences * REFER_D * sizeof *r.e), "the embedding is the word");
	reference_free(&r);
	gradients(&s, &tally);
	reference_sample_free(&s);
}

/* A view that sees nothing: M = 0, ln 2 a pixel, and nothing to learn but the contrast. */
static void empty_view(void)
{
	const struct reference_options o =
		reference_defaults(5, REFER_PCMI, REFER_COSINE, REFER_CONTRAST_NONE);
	struct reference_sample s;
	struct refer_result r;
	struct err e = {0};
	double sum = 0;

	reference_sample_init(&s, &o);
	memset(s.indptr, 0, (o.pixels + 1) * sizeof *s.indptr);
	const size_t features = o.n * (size_t)o.feature_width;
	double *dx = malloc(features * sizeof *dx), *d = malloc(s.layout.count * sizeof *d);
	CHECK(!reference_forward(&s.problem, &r, &e) && !reference_backward(&s.problem, &r, dx, d, &e), "%s",
		e.message);
	for (size_t k = 0; k < features; k++)
		sum += fabs(dx[k]);
	for (size_t k = 0; k < s.layout.count; k++)
		sum += fabs(d[k]);
	CHECK(fabs(r.loss - log(2)) < 1e-15 && r.contrast == 0 && sum == 0, "loss %g, gradient %g", r.loss,
		sum);
	free(dx);
	free(d);
	reference_free(&r);
	reference_sample_free(&s);
}

/* Rows i and i+20 of x are equal, so their responses tie, and an odd k splits a tie. */
static void top_set(void)
{
	struct reference_options o = reference_defaults(6, REFER_NONE, REFER_DOT, REFER_CONTRAST_DOT);
	const double shares[4] = {0, 0.03, 0.13, 1};
	const size_t counts[4] = {1, 1, 5, 40};
	struct reference_sample s;
	struct err e = {0};

	reference_sample_init(&s, &o);
	const size_t twenty = 20 * (size_t)o.feature_width;
	memcpy(s.x + twenty, s.x, twenty * sizeof *s.x);
	for (int k = 0; k < 4; k++) {
		struct refer_result r;
		double mean = 0;
		int ordered = 1;
		s.problem.tau = shares[k];
		CHECK(!reference_forward(&s.problem, &r, &e), "%s", e.message);
		CHECK(r.top_count == counts[k], "tau %g of 40 gives %zu", shares[k], r.top_count);
		for (size_t t = 0; t < r.top_count; t++)
			ordered &= t % 2 ? r.top[t] == r.top[t - 1] + 20
					 : r.top[t] < 20 && (!t || r.m[r.top[t]] < r.m[r.top[t - 1]]);
		CHECK(ordered, "k %zu: pairs of equal m in falling order, the lower index first",
			r.top_count);
		for (size_t i = 0; i < o.n; i++)
			ordered &= r.m[i] <= r.m[r.top[0]];
		CHECK(ordered, "the first is the largest");
		for (size_t t = 0; t < r.top_count; t++)
			mean += r.refined[r.top[t] * REFER_D + 3] / (double)r.top_count;
		CHECK(fabs(mean - r.f_g[3]) < 1e-15, "f_g is their mean");
		reference_free(&r);
	}
	reference_sample_free(&s);
}

static void expect_refusal(const struct reference_sample *s, const char *message)
{
	struct refer_result r;
	struct err e = {0};

	CHECK(reference_forward(&s->problem, &r, &e) < 0 && e.code == ERR_FORMAT && !r.slab, "%s", message);
	CHECK(!strcmp(e.message, message), "\"%s\" for \"%s\"", e.message, message);
}

static void refusals(void)
{
	const struct reference_options o =
		reference_defaults(8, REFER_PCMI_PROJ, REFER_COSINE, REFER_CONTRAST_NONE);
	struct reference_sample s;

	reference_sample_init(&s, &o);
	expect_refusal(&s, "reference: pcmi-proj has no cosine similarity");
	s.problem.similarity = REFER_DOT;
	s.problem.target = 5;
	expect_refusal(&s, "reference: target 5 of 5 sentences");
	s.problem.target = 0;
	s.index[1] = 40;
	expect_refusal(&s, "reference: entry 1 is of Gaussian 40 of 40");
	s.index[1] = 0;
	s.indptr[3] = -1;
	expect_refusal(&s, "reference: indptr falls at pixel 2");
	s.offsets[2] = s.offsets[1];
	expect_refusal(&s, "reference: sentence 1 has no words");
	s.problem.tau = 1.5;
	expect_refusal(&s, "reference: temperature 0.2, tau 1.5");
	s.problem.n = 0;
	expect_refusal(&s, "reference: 0 Gaussians, 5 sentences, 30 pixels: at least one of each");
	reference_sample_free(&s);
}

/* test_reference --dump INTERACTION SIMILARITY CONTRAST WIDTH, the last two as numbers. */
static int dump(char **words)
{
	const int interaction = refer_interaction_parse(words[0]),
		  similarity = refer_similarity_parse(words[1]);
	const int contrast = atoi(words[2]), width = atoi(words[3]);

	if (interaction < 0 || similarity < 0 || contrast < 0 || contrast >= CONTRASTS || width < 1 ||
		width > REFER_MAX_X)
		return 2;
	struct reference_options o = reference_defaults(1, (enum refer_interaction)interaction,
		(enum refer_similarity)similarity, (enum refer_contrast)contrast);
	struct reference_sample s;
	o.feature_width = width;
	reference_sample_init(&s, &o);
	reference_dump(&s);
	reference_sample_free(&s);
	return 0;
}

int main(void)
{
	char **words = unit_arguments;

	if (words[0] && !strcmp(words[0], "--dump"))
		return words[1] && words[2] && words[3] && words[4] && !words[5] ? dump(words + 1) : 2;
	all_gradients();
	contrast_is_live();
	known_answers();
	from_zero();
	huge_logits();
	one_word();
	empty_view();
	top_set();
	refusals();
	return unit_end();
}
