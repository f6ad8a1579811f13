/* With d = x - mean, (u,v) = L d and h = log2(e)/2, the inverse of the projected covariance C is L^T L / h.
 * From the moments M of g = dL/de in (u,v), the mean of the projection has the gradient 2 L^T M_1, and C has
 * L^T M_2 L / h: no inverse is taken and nothing cancels. C = B B^T + 0.3 I with B = T R S, T = J W
 * (splat/project_kernel.h), and the rest is the chain rule. Gaussians stand side by side, so that the
 * compiler makes vectors of them. */
#include "fit/project_back.h"

#include "fit/back.h"
#include "splat/sh.h"
#include "splat/view.h"

#include <math.h>
#include <string.h>

#define LN2 0.69314718055994530942
#define HALF_LOG2E 0.72134752044448170368

enum { LANES = 32, BLOCK = 1024 };

struct lanes {
	double mean[3][LANES], scale[3][LANES], quat[4][LANES]; /* scale: with activation */
	double l11[LANES], l21[LANES], l22[LANES];
	double sums[BACK_VV + 1][LANES];
	/* gradients of mean, logarithm of the scale, and quat */
	double dmean[3][LANES], dscale[3][LANES], dquat[4][LANES];
};

/* x^T y */
#define DOT3(x, y) ((x)[0] * (y)[0] + (x)[1] * (y)[1] + (x)[2] * (y)[2])

/* The rows of T = J W at the lane's mean, and what they come from. */
struct jacobian {
	double t[2][3], at[3], per_z, tangent[2], inside[2];
};

static inline __attribute__((always_inline)) struct jacobian jacobian_at(
	const struct project_lens *lens, const struct lanes *b, int l)
{
	const double(*w)[4] = lens->world_to_camera, focal[2] = {lens->fx, lens->fy};
	struct jacobian j;

	for (int r = 0; r < 3; r++)
		j.at[r] =
			w[r][0] * b->mean[0][l] + w[r][1] * b->mean[1][l] + w[r][2] * b->mean[2][l] + w[r][3];
	j.per_z = 1 / j.at[2];
	for (int r = 0; r < 2; r++) {
		const double ray = j.at[r] * j.per_z, low = lens->low[r], high = lens->high[r];
		j.inside[r] = ray >= low && ray <= high ? 1.0 : 0.0;
		j.tangent[r] = ray < low ? low : ray > high ? high : ray;
		for (int k = 0; k < 3; k++)
			j.t[r][k] = focal[r] * j.per_z * (w[r][k] - j.tangent[r] * w[2][k]);
	}
	return j;
}

/* The gradient of the mean, from those of T and of the mean's pixel. */
static inline __attribute__((always_inline)) void mean_back(const struct project_lens *lens, struct lanes *b,
	int l, const struct jacobian *j, const double dt[2][3], const double dpixel[2])
{
	const double(*w)[4] = lens->world_to_camera, focal[2] = {lens->fx, lens->fy};
	double dat[3] = {0, 0, 0}, dper_z = 0;

	for (int r = 0; r < 2; r++) {
		const double dray = focal[r] * dpixel[r];
		const double dtangent = -focal[r] * j->per_z * DOT3(dt[r], w[2]) * j->inside[r];
		dper_z += DOT3(dt[r], j->t[r]) * j->at[2] + (dray + dtangent) * j->at[r];
		dat[r] = (dray + dtangent) * j->per_z;
	}
	dat[2] = -j->per_z * j->per_z * dper_z;
	for (int k = 0; k < 3; k++)
		b->dmean[k][l] = w[0][k] * dat[0] + w[1][k] * dat[1] + w[2][k] * dat[2];
}

/* The gradient of a quaternion of any length, from that of its rotation. */
static inline __attribute__((always_inline)) void quat_back(
	struct lanes *b, int l, const double q[4], double per_length, const double d[3][3])
{
	const double w = q[0], x = q[1], y = q[2], z = q[3];
	double dq[4];

	dq[0] = 2 * (x * (d[2][1] - d[1][2]) + y * (d[0][2] - d[2][0]) + z * (d[1][0] - d[0][1]));
	dq[1] = 2 * (y * (d[1][0] + d[0][1]) + z * (d[2][0] + d[0][2]) + w * (d[2][1] - d[1][2])) -
		4 * x * (d[1][1] + d[2][2]);
	dq[2] = 2 * (x * (d[1][0] + d[0][1]) + z * (d[2][1] + d[1][2]) + w * (d[0][2] - d[2][0])) -
		4 * y * (d[0][0] + d[2][2]);
	dq[3] = 2 * (x * (d[2][0] + d[0][2]) + y * (d[2][1] + d[1][2]) + w * (d[1][0] - d[0][1])) -
		4 * z * (d[0][0] + d[1][1]);
	const double along = dq[0] * w + dq[1] * x + dq[2] * y + dq[3] * z;
	for (int k = 0; k < 4; k++)
		b->dquat[k][l] = (dq[k] - along * q[k]) * per_length;
}

static inline __attribute__((always_inline)) void lane_back(
	const struct project_lens *lens, struct lanes *b, int l)
{
	const struct jacobian j = jacobian_at(lens, b, l);
	const double per_length = 1 / sqrt(b->quat[0][l] * b->quat[0][l] + b->quat[1][l] * b->quat[1][l] +
					      b->quat[2][l] * b->quat[2][l] + b->quat[3][l] * b->quat[3][l]);
	const double q[4] = {b->quat[0][l] * per_length, b->quat[1][l] * per_length,
		b->quat[2][l] * per_length, b->quat[3][l] * per_length};
	const double w = q[0], x = q[1], y = q[2], z = q[3];
	const double turn[3][3] = {{1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)},
		{2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)},
		{2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)}};
	const double l11 = b->l11[l], l21 = b->l21[l], l22 = b->l22[l];
	const double uu = LN2 * b->sums[BACK_UU][l], uv = LN2 * b->sums[BACK_UV][l],
		     vv = LN2 * b->sums[BACK_VV][l];
	const double u = 2 * LN2 * b->sums[BACK_U][l], v = 2 * LN2 * b->sums[BACK_V][l];
	const double dpixel[2] = {l11 * u, l21 * u + l22 * v};
	/* dL/dC, twice, as B is there twice */
	const double h = 2 / HALF_LOG2E, right[2] = {uu * l21 + uv * l22, uv * l21 + vv * l22};
	const double xx = h * l11 * uu * l11, xy = h * l11 * right[0],
		     yy = h * (l21 * right[0] + l22 * right[1]);
	double dt[2][3] = {{0}}, dturn[3][3];

	for (int k = 0; k < 3; k++) {
		const double s = b->scale[k][l], column[3] = {turn[0][k], turn[1][k], turn[2][k]};
		const double b0 = s * DOT3(j.t[0], column), b1 = s * DOT3(j.t[1], column);
		const double d0 = xx * b0 + xy * b1, d1 = xy * b0 + yy * b1;
		b->dscale[k][l] = d0 * b0 + d1 * b1;
		for (int i = 0; i < 3; i++) {
			dt[0][i] += d0 * s * column[i];
			dt[1][i] += d1 * s * column[i];
			dturn[i][k] = s * (j.t[0][i] * d0 + j.t[1][i] * d1);
		}
	}
	quat_back(b, l, q, per_length, dturn);
	mean_back(lens, b, l, &j, dt, dpixel);
}

/* The clones give the machine's vector width; every operation is correctly rounded, so they give the same
 * bytes. */
#if defined(__x86_64__) && defined(__GLIBC__)
__attribute__((target_clones("avx512f", "avx2", "default")))
#endif
static void
lanes_back(const struct project_lens *lens, struct lanes *b)
{
#if !defined __clang__ /* which warns where it cannot */
#pragma omp simd
#endif
	for (int l = 0; l < LANES; l++)
		lane_back(lens, b, l);
}

static void direction_of(const float *mean, const double centre[3], double d[3], double *length)
{
	for (int k = 0; k < 3; k++)
		d[k] = mean[k] - centre[k];
	*length = sqrt(DOT3(d, d));
	for (int k = 0; k < 3; k++)
		d[k] /= *length;
}

void fit_seen(const struct render_view *v, uint8_t *seen)
{
	memset(seen, 0, v->gaussians);
#pragma omp parallel for schedule(static)
	for (size_t i = 0; i < v->visible; i++)
		seen[v->sorted[i].index] = 1;
}

void fit_colors(
	const struct fit_gaussians *g, const uint8_t *seen, const struct camera *c, int degree, float *colors)
{
	const int parts = fit_parts(degree), coefficients = (degree + 1) * (degree + 1);
	double centre[3];

	camera_centre(c, centre);
#pragma omp parallel for schedule(dynamic, BLOCK)
	for (size_t at = 0; at < g->n; at++) {
		double d[3], length, y[SH_MAX];
		float sum[3] = {0.5f, 0.5f, 0.5f};
		if (!seen[at])
			continue;
		direction_of(g->splats.means + 3 * at, centre, d, &length);
		sh_basis(d, coefficients, y);
		for (int p = FIT_SH, k = 0; p < parts; p++) {
			const float *sh = g->at[FIT_VALUE][p] + fit_width[p] * at;
			for (int m = 0; m < fit_width[p]; m += 3, k++)
				for (int n = 0; n < 3; n++)
					sum[n] += (float)y[k] * sh[m + n];
		}
		for (int n = 0; n < 3; n++)
			colors[3 * at + (size_t)n] = fmaxf(0, sum[n]);
	}
}

/* Harmonics, and what the colour adds to the gradient of the mean, through the direction. */
static void color_back(struct fit_gaussians *g, size_t at, int degree, const double centre[3],
	const float *color, const float *dcolor, float *dmean)
{
	const int parts = fit_parts(degree), coefficients = (degree + 1) * (degree + 1);
	float d[3];
	double to[3], length, y[SH_MAX], slope[3][SH_MAX], dto[3] = {0};

	for (int n = 0; n < 3; n++)
		d[n] = color[n] > 0 ? dcolor[n] : 0;
	direction_of(g->splats.means + 3 * at, centre, to, &length);
	sh_basis(to, coefficients, y);
	if (degree)
		sh_slopes(to, slope);
	for (int p = FIT_SH, k = 0; p < parts; p++) {
		const float *sh = g->at[FIT_VALUE][p] + fit_width[p] * at;
		float *dsh = g->at[FIT_GRADIENT][p] + fit_width[p] * at;
		for (int m = 0; m < fit_width[p]; m += 3, k++) {
			const double along = DOT3(d, sh + m);
			for (int n = 0; n < 3; n++)
				dsh[m + n] = (float)(y[k] * d[n]);
			for (int n = 0; n < 3 && k; n++)
				dto[n] += along * slope[n][k];
		}
	}
	const double along = DOT3(dto, to);
	for (int n = 0; n < 3; n++)
		dmean[n] += (float)((dto[n] - along * to[n]) / length);
}

static void take(struct lanes *b, const struct fit_gaussians *g, const struct render_view *v, size_t at,
	int l, const float *sums)
{
	const struct projected *p = &v->projected[at];

	for (size_t k = 0; k < 3; k++) {
		b->mean[k][l] = g->splats.means[3 * at + k];
		b->scale[k][l] = g->splats.scales[3 * at + k];
	}
	for (size_t k = 0; k < 4; k++)
		b->quat[k][l] = g->splats.quats[4 * at + k];
	b->l11[l] = p->l11;
	b->l21[l] = p->l21;
	b->l22[l] = p->l22;
	for (size_t k = 0; k <= BACK_VV; k++)
		b->sums[k][l] = sums[at * BACK_SUMS + k];
}

static void put(struct fit_gaussians *g, const struct lanes *b, size_t at, int l)
{
	float *const *to = g->at[FIT_GRADIENT];
	const float o = g->splats.opacities[at];

	for (size_t k = 0; k < 3; k++) {
		to[FIT_MEAN][3 * at + k] = (float)b->dmean[k][l];
		to[FIT_SCALE][3 * at + k] = (float)b->dscale[k][l];
	}
	for (size_t k = 0; k < 4; k++)
		to[FIT_QUAT][4 * at + k] = (float)b->dquat[k][l];
	to[FIT_LOGIT][at] = (float)(b->sums[BACK_G][l] * (1 - o)); /* de/dlogit = (1-o) / ln 2 */
}

static void clear(struct fit_gaussians *g, int degree, size_t at)
{
	for (int p = 0; p < fit_parts(degree); p++)
		memset(g->at[FIT_GRADIENT][p] + fit_width[p] * at, 0, fit_width[p] * sizeof(float));
}

void fit_project_back(struct fit_gaussians *g, const struct render_view *v, const uint8_t *seen,
	const struct camera *c, int degree, const float *colors, const float *sums)
{
	struct project_lens lens;
	double centre[3];

	project_lens_make(&lens, c, g->splats.near);
	camera_centre(c, centre);
#pragma omp parallel for schedule(dynamic)
	for (size_t begin = 0; begin < g->n; begin += BLOCK) {
		const size_t end = begin + BLOCK < g->n ? begin + BLOCK : g->n;
		struct lanes b = {0}; /* lanes left over compute what is not looked at */
		for (size_t i = begin; i < end;) {
			size_t who[LANES];
			int n = 0;
			for (; i < end && n < LANES; i++)
				if (seen[i]) {
					take(&b, g, v, i, n, sums);
					who[n++] = i;
				} else {
					clear(g, degree, i);
				}
			lanes_back(&lens, &b);
			for (int l = 0; l < n; l++) {
				put(g, &b, who[l], l);
				color_back(g, who[l], degree, centre, colors + 3 * who[l],
					sums + who[l] * BACK_SUMS + BACK_RED,
					g->at[FIT_GRADIENT][FIT_MEAN] + 3 * who[l]);
			}
		}
	}
}
