#include "fit/grow.h"

#include "base/compare.h"
#include "base/mem.h"

#include <math.h>

enum { COPIES_MOST = 51, STEPS = 64 };
#define NOISE 5e5	 /* times the positions' rate, in scenes of FIT_SIZE */
#define NOISE_STEEP 100	 /* how fast noise fades above GROW_DEAD */
#define NOISE_ABOVE 0.2f /* more opaque than this there is less than 1e-8 of it */

/* The integral over s of 1 - (1 - o e^(-s^2))^n, the profile of n Gaussians on one spot: it is the double sum
 * over binomials of their equation 9, without the cancellation. */
static double profile(double o, int n)
{
	double sum = 0;
	const double end = 6, step = end / STEPS;

	for (int i = 0; i <= STEPS; i++) { /* Simpson */
		const double s = i * step, y = 1 - pow(1 - o * exp(-s * s), n);
		sum += y * (i == 0 || i == STEPS ? 1 : i % 2 ? 4 : 2);
	}
	return sum * step / 3;
}

void grow_split(double opacity, int copies, double *part, double *factor)
{
	copies = copies > COPIES_MOST ? COPIES_MOST : copies;
	*part = 1 - pow(1 - opacity, 1.0 / copies);
	*factor = profile(opacity, 1) / profile(*part, copies);
}

/* cumulative (n): sums of the opacities of those alive. */
static double accumulate(const struct fit_gaussians *g, const uint8_t *dead, double *cumulative)
{
	double sum = 0;

	for (size_t i = 0; i < g->n; i++) {
		sum += dead[i] ? 0 : (double)g->splats.opacities[i];
		cumulative[i] = sum;
	}
	return sum;
}

static size_t draw(const double *cumulative, size_t n, struct rng *rng)
{
	const double at = rng_uniform(rng) * cumulative[n - 1];
	size_t low = 0, high = n - 1;

	while (low < high) {
		const size_t middle = low + (high - low) / 2;
		if (cumulative[middle] > at)
			high = middle;
		else
			low = middle + 1;
	}
	return low;
}

/* Gaussian `to` becomes a copy of `from`, with no history. */
static void copy(struct fit_gaussians *g, size_t from, size_t to)
{
	for (int p = 0; p < fit_parts(g->degree); p++) {
		const size_t w = fit_width[p];
		memcpy(g->at[FIT_VALUE][p] + w * to, g->at[FIT_VALUE][p] + w * from, w * sizeof(float));
		for (int s = FIT_MOMENT1; s <= FIT_MOMENT2; s++)
			memset(g->at[s][p] + w * to, 0, w * sizeof(float));
	}
}

/* Original and copies share what the original showed. */
static void share(struct fit_gaussians *g, size_t i, int copies)
{
	float *scale = g->at[FIT_VALUE][FIT_SCALE] + 3 * i;
	double part, factor;

	grow_split(g->splats.opacities[i], copies, &part, &factor);
	part = fmin(fmax(part, (double)GROW_DEAD), 1 - 1e-6);
	g->at[FIT_VALUE][FIT_LOGIT][i] = (float)log(part / (1 - part));
	for (int k = 0; k < 3; k++)
		scale[k] += (float)log(factor);
	copy(g, i, i);
}

static void place(struct fit_gaussians *g, const uint8_t *dead, size_t wanted, const double *cumulative,
	uint32_t *originals, uint16_t *copies, struct rng *rng)
{
	const size_t n = g->n, all = wanted > n ? wanted : n;

	for (size_t i = 0; i < all; i++) {
		originals[i] = (uint32_t)i;
		if (i < n && !dead[i])
			continue;
		originals[i] = (uint32_t)draw(cumulative, n, rng);
		copies[originals[i]] += copies[originals[i]] < COPIES_MOST;
	}
	for (size_t i = 0; i < n; i++)
		if (copies[i])
			share(g, i, copies[i] + 1);
	for (size_t i = 0; i < all; i++)
		if (originals[i] != i)
			copy(g, originals[i], i);
	g->n = all;
}

int grow(struct fit_gaussians *g, const uint8_t *dead, size_t wanted, struct rng *rng, struct err *e)
{
	wanted = wanted < g->capacity ? wanted : g->capacity;
	const size_t all = wanted > g->n ? wanted : g->n;
	SCOPED double *cumulative = mem_alloc(g->n, sizeof *cumulative, "Gaussians", e);
	SCOPED uint32_t *originals = mem_alloc(all, sizeof *originals, "Gaussians", e);
	SCOPED uint16_t *copies = mem_zalloc(g->n, sizeof *copies, "Gaussians", e);
	const int bad = !cumulative || !originals || !copies;

	if (!bad && g->n && accumulate(g, dead, cumulative) > 0)
		place(g, dead, wanted, cumulative, originals, copies, rng);
	return bad ? -1 : 0;
}

/* mean += R S^2 R^T noise */
static void shake(float *mean, const float *scale, const float *quat, const double noise[3])
{
	const double w = quat[0], x = quat[1], y = quat[2], z = quat[3],
		     two = 2 / (w * w + x * x + y * y + z * z);
	const double turn[3][3] = {{1 - two * (y * y + z * z), two * (x * y - w * z), two * (x * z + w * y)},
		{two * (x * y + w * z), 1 - two * (x * x + z * z), two * (y * z - w * x)},
		{two * (x * z - w * y), two * (y * z + w * x), 1 - two * (x * x + y * y)}};

	for (int k = 0; k < 3; k++) {
		const double along = turn[0][k] * noise[0] + turn[1][k] * noise[1] + turn[2][k] * noise[2];
		const double by = (double)scale[k] * scale[k] * along;
		for (int i = 0; i < 3; i++)
			mean[i] += (float)(turn[i][k] * by);
	}
}

void grow_noise(struct fit_gaussians *g, double rate, double size, uint64_t seed, long step)
{
	const double scale = NOISE * rate * pow(FIT_SIZE / size, 2);

#pragma omp parallel for schedule(static)
	for (size_t i = 0; i < g->n; i++) {
		const float o = g->splats.opacities[i];
		double noise[3];
		struct rng r;
		if (o > NOISE_ABOVE)
			continue;
		const double most = scale / (1 + exp(NOISE_STEEP * (double)(o - GROW_DEAD)));
		rng_seed(&r, seed * 0x9e3779b97f4a7c15 + (uint64_t)step, i);
		for (int k = 0; k < 3; k++)
			noise[k] = most * rng_normal(&r);
		shake(g->splats.means + 3 * i, g->splats.scales + 3 * i, g->splats.quats + 4 * i, noise);
	}
}

enum { BISECTIONS = 7 };
#define EVALUATE_EVERY 0.05
#define GAIN_LEAST 0.05	     /* dB from one evaluation to the next */
#define GAINS_FROM 0.4	     /* progress: before, images grow and PSNR with them */
#define LOGIT_NONE (-100.0f) /* of a Gaussian that no view shows */

int fit_judge_all(
	struct fit *f, const struct photograph *first, size_t n, double *psnr, double *ssim, struct err *e)
{
	*psnr = *ssim = 0;
	for (size_t i = 0; i < n; i++) {
		struct photo_loss l;
		if (fit_judge(f, first + i, &l, e))
			return -1;
		*psnr += fit_psnr(l.squares) / (double)n;
		*ssim += l.ssim / (double)n;
	}
	return 0;
}

static int judge(struct fit *f, double *psnr, double *ssim, struct err *e)
{
	const size_t n = f->held_out ? f->held_out : f->views;

	return fit_judge_all(f, f->photographs + f->views - n, n, psnr, ssim, e);
}

int fit_evaluate(struct fit *f, double progress, int *is_due, double *psnr, double *ssim, struct err *e)
{
	struct fit_state *s = &f->state;

	*is_due = progress >= s->judged + EVALUATE_EVERY;
	if (!*is_due)
		return 0;
	if (judge(f, psnr, ssim, e))
		return -1;
	if (progress >= GAINS_FROM && s->psnr > 0 && *psnr < s->psnr + GAIN_LEAST &&
		(size_t)s->most > f->gaussians.n)
		s->most = (int64_t)f->gaussians.n;
	s->psnr = *psnr;
	s->judged = progress;
	return 0;
}

static int rank(struct fit *f, struct ranked *ranks, char *kept, struct err *e)
{
	const size_t n = f->gaussians.n;
	SCOPED float *worth = mem_alloc(n, sizeof *worth, "Gaussians", e);
	int bad = !worth || fit_shown(f, 0, kept, worth, e);

	for (size_t i = 0; i < n && !bad; i++)
		ranks[i] = (struct ranked){worth[i], i};
	if (!bad)
		qsort(ranks, n, sizeof *ranks, ranked_rising);
	return bad ? -1 : 0;
}

/* PSNR without the first `removed` of the ranks. */
static int judge_without(struct fit *f, const struct ranked *ranks, size_t removed, const float *logits,
	double *psnr, struct err *e)
{
	float *logit = f->gaussians.at[FIT_VALUE][FIT_LOGIT];
	double ssim;

	memcpy(logit, logits, f->gaussians.n * sizeof *logit);
	for (size_t k = 0; k < removed; k++)
		logit[ranks[k].at] = LOGIT_NONE;
	const int bad = judge(f, psnr, &ssim, e);
	memcpy(logit, logits, f->gaussians.n * sizeof *logit);
	return bad;
}

static int prune(struct fit *f, struct ranked *ranks, char *kept, float *logits, struct err *e)
{
	const size_t n = f->gaussians.n;
	size_t low = 0, high = n / 2;
	double whole, psnr;

	memcpy(logits, f->gaussians.at[FIT_VALUE][FIT_LOGIT], n * sizeof *logits);
	if (rank(f, ranks, kept, e) || judge_without(f, ranks, 0, logits, &whole, e))
		return -1;
	for (int k = 0; k < BISECTIONS && low + 1 < high; k++) {
		const size_t middle = low + (high - low) / 2;
		if (judge_without(f, ranks, middle, logits, &psnr, e))
			return -1;
		*(psnr >= whole - FIT_PRUNE_LOSS ? &low : &high) = middle;
	}
	memset(kept, 1, n);
	for (size_t k = 0; k < low; k++)
		kept[ranks[k].at] = 0;
	fit_gaussians_keep(&f->gaussians, kept);
	f->state.most = (int64_t)f->gaussians.n;
	f->state.is_pruned = 1;
	return 0;
}

int fit_prune(struct fit *f, struct err *e)
{
	const size_t n = f->gaussians.n;
	SCOPED struct ranked *ranks = mem_alloc(n, sizeof *ranks, "Gaussians", e);
	SCOPED char *kept = mem_alloc(n, 1, "Gaussians", e);
	SCOPED float *logits = mem_alloc(n, sizeof *logits, "Gaussians", e);
	return -(!ranks || !kept || !logits || prune(f, ranks, kept, logits, e));
}
