#include "fit/needed.h"

#include "base/mem.h"

enum { BISECTIONS = 7 };
#define EVALUATE_EVERY 0.05
#define GAIN_LEAST 0.05	     /* dB from one evaluation to the next */
#define GAINS_FROM 0.4	     /* progress: before, images grow and PSNR with them */
#define LOGIT_NONE (-100.0f) /* of a Gaussian that no view shows */

struct rank {
	float worth;
	uint32_t i;
};

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

static int compare(const void *a, const void *b)
{
	const struct rank *x = a, *y = b;

	return x->worth != y->worth ? (x->worth < y->worth ? -1 : 1) : (x->i > y->i) - (x->i < y->i);
}

static int rank(struct fit *f, struct rank *ranks, char *kept, struct err *e)
{
	const size_t n = f->gaussians.n;
	SCOPED float *worth = mem_alloc(n, sizeof *worth, "Gaussians", e);
	int bad = !worth || fit_shown(f, 0, kept, worth, e);

	for (size_t i = 0; i < n && !bad; i++)
		ranks[i] = (struct rank){worth[i], (uint32_t)i};
	if (!bad)
		qsort(ranks, n, sizeof *ranks, compare);
	return bad ? -1 : 0;
}

/* PSNR without the first `removed` of the ranks. */
static int judge_without(struct fit *f, const struct rank *ranks, size_t removed, const float *logits,
	double *psnr, struct err *e)
{
	float *logit = f->gaussians.at[FIT_VALUE][FIT_LOGIT];
	double ssim;

	memcpy(logit, logits, f->gaussians.n * sizeof *logit);
	for (size_t k = 0; k < removed; k++)
		logit[ranks[k].i] = LOGIT_NONE;
	const int bad = judge(f, psnr, &ssim, e);
	memcpy(logit, logits, f->gaussians.n * sizeof *logit);
	return bad;
}

static int prune(struct fit *f, struct rank *ranks, char *kept, float *logits, struct err *e)
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
		kept[ranks[k].i] = 0;
	fit_gaussians_keep(&f->gaussians, kept);
	f->state.most = (int64_t)f->gaussians.n;
	f->state.is_pruned = 1;
	return 0;
}

int fit_prune(struct fit *f, struct err *e)
{
	const size_t n = f->gaussians.n;
	SCOPED struct rank *ranks = mem_alloc(n, sizeof *ranks, "Gaussians", e);
	SCOPED char *kept = mem_alloc(n, 1, "Gaussians", e);
	SCOPED float *logits = mem_alloc(n, sizeof *logits, "Gaussians", e);
	const int bad = !ranks || !kept || !logits || prune(f, ranks, kept, logits, e);

	return bad ? -1 : 0;
}
