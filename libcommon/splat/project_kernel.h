/* The projection kernel, for the instruction set in force where this is included (splat/kernels.h). Plain
 * IEEE operations in a fixed order, so that all instruction sets give the same bits. Vectors are written out,
 * as compilers leave the loop over lanes scalar for its conditions.
 *
 * Covariance J W Sigma W^T J^T + 0.3 I. With M = J W R S (2x3) the determinant of M M^T is the sum of the
 * squared 2x2 minors of M (Cauchy-Binet), and a minor is s_j s_k times the third axis dot the cross product
 * of the rows of J W. With the low pass: det = sum of squares + 0.3 trace + 0.09. Nothing cancels, so needles
 * keep their width, where the difference of products loses it even when it is rounded once. */
#include "base/vecmath.h"
#include "splat/kernels.h"

#include <math.h>

#define PROJECT_HALF_LOG2E 0.72134752044448170368 /* e^(-q/2) = 2^(-this q) */

enum { PROJECT_REALS = VEC_LANES / 2 }; /* in a register */

typedef double project_real __attribute__((vector_size(8 * PROJECT_REALS)));
typedef int64_t project_mask __attribute__((vector_size(8 * PROJECT_REALS)));
typedef float project_float __attribute__((vector_size(4 * PROJECT_REALS)));
typedef int32_t project_int __attribute__((vector_size(4 * PROJECT_REALS)));

VEC_INLINE project_real project_load(const float *p)
{
	project_float x;

	memcpy(&x, p, sizeof x);
	return __builtin_convertvector(x, project_real);
}

VEC_INLINE void project_store(double *p, project_real x)
{
	memcpy(p, &x, sizeof x);
}

VEC_INLINE void project_store_int(int32_t *p, project_int x)
{
	memcpy(p, &x, sizeof x);
}

VEC_INLINE project_real project_choose(project_mask mask, project_real a, project_real b)
{
	return (project_real)((mask & (project_mask)a) | (~mask & (project_mask)b));
}

VEC_INLINE project_real project_splat(double x)
{
	return x - (project_real){0};
}

VEC_INLINE project_real project_min(project_real a, project_real b)
{
	return project_choose(a < b, a, b);
}

VEC_INLINE project_real project_max(project_real a, project_real b)
{
	return project_choose(a > b, a, b);
}

VEC_INLINE project_real project_sqrt(project_real x)
{
#if VEC_LANES == 16
	return (project_real)_mm512_sqrt_pd((__m512d)x);
#elif VEC_LANES == 8
	return (project_real)_mm256_sqrt_pd((__m256d)x);
#else
	project_real root;
	for (int l = 0; l < PROJECT_REALS; l++)
		root[l] = sqrt(x[l]);
	return root;
#endif
}

/* log2 of positive normal numbers, within 1e-12. */
VEC_INLINE project_real project_log2(project_real x)
{
	project_mask bits = (project_mask)x;
	/* the exponent such that the fraction is within sqrt(1/2) and sqrt(2) */
	project_mask exponent = (bits + (0x3ff0000000000000 - 0x3fe6a09e667f3bcd)) >> 52;
	project_real fraction = (project_real)(bits - ((exponent - 1023) << 52));
	project_real whole = (project_real)(exponent + 0x4330000000000000); /* 2^52 + exponent */
	/* log(f) = 2 atanh((f-1)/(f+1)) */
	project_real s = (fraction - 1) / (fraction + 1), q = s * s, p = project_splat(1.0 / 15);

	p = p * q + 1.0 / 13;
	p = p * q + 1.0 / 11;
	p = p * q + 1.0 / 9;
	p = p * q + 1.0 / 7;
	p = p * q + 1.0 / 5;
	p = p * q + 1.0 / 3;
	p = p * q + 1;
	return (whole - (4503599627370496.0 + 1023)) + 4 * PROJECT_HALF_LOG2E * s * p;
}

/* The pixel centres from 0.5 to size - 0.5 that are within half of x: *first and *last; returns where there
 * are any, given that x and half are finite. */
VEC_INLINE project_mask project_range(
	project_real x, project_real half, double size, project_int *first, project_int *last)
{
	project_real low = project_max(x - half - 0.5, project_splat(0)), high = x + half - 0.5;
	project_mask seen = (high >= 0) & (low <= size - 1);

	high = project_min(high, project_splat(size - 1));
	/* so that what is not seen fits int32 too */
	low = (project_real)(seen & (project_mask)low);
	high = (project_real)(seen & (project_mask)high);
	project_int whole = __builtin_convertvector(low, project_int);
	*first = whole - (project_int) __builtin_convertvector(
				 __builtin_convertvector(whole, project_real) < low, project_int);
	*last = __builtin_convertvector(high, project_int);
	return seen & __builtin_convertvector(*first <= *last, project_mask);
}

/* The lanes from `at` on, as many as a register holds. */
VEC_INLINE void project_some(const struct project_lens *lens, struct project_batch *b, int at)
{
	const double(*turn)[4] = lens->world_to_camera;
	project_real mx = project_load(b->mean[0] + at), my = project_load(b->mean[1] + at),
		     mz = project_load(b->mean[2] + at);
	project_real cx = turn[0][0] * mx + turn[0][1] * my + turn[0][2] * mz + turn[0][3];
	project_real cy = turn[1][0] * mx + turn[1][1] * my + turn[1][2] * mz + turn[1][3];
	project_real cz = turn[2][0] * mx + turn[2][1] * my + turn[2][2] * mz + turn[2][3];
	project_real per_z = 1 / cz, rx = cx * per_z, ry = cy * per_z;
	project_real fx = lens->fx * per_z, fy = lens->fy * per_z;
	project_real tx =
		project_min(project_max(rx, project_splat(lens->low[0])), project_splat(lens->high[0]));
	project_real ty =
		project_min(project_max(ry, project_splat(lens->low[1])), project_splat(lens->high[1]));

	/* the rows of J W, and their cross product */
	project_real ax = fx * (turn[0][0] - tx * turn[2][0]), bx = fy * (turn[1][0] - ty * turn[2][0]);
	project_real ay = fx * (turn[0][1] - tx * turn[2][1]), by = fy * (turn[1][1] - ty * turn[2][1]);
	project_real az = fx * (turn[0][2] - tx * turn[2][2]), bz = fy * (turn[1][2] - ty * turn[2][2]);
	project_real area = fx * fy;
	project_real nx = area * (lens->normal[2][0] + tx * lens->normal[0][0] + ty * lens->normal[1][0]);
	project_real ny = area * (lens->normal[2][1] + tx * lens->normal[0][1] + ty * lens->normal[1][1]);
	project_real nz = area * (lens->normal[2][2] + tx * lens->normal[0][2] + ty * lens->normal[1][2]);

	/* the Gaussian's axes: the columns of the rotation, for a quaternion of any length */
	project_real w = project_load(b->quat[0] + at), x = project_load(b->quat[1] + at),
		     y = project_load(b->quat[2] + at), z = project_load(b->quat[3] + at);
	project_real two = 2 / (w * w + x * x + y * y + z * z);
	project_real ux = 1 - two * (y * y + z * z), uy = two * (x * y + w * z), uz = two * (x * z - w * y);
	project_real vx = two * (x * y - w * z), vy = 1 - two * (x * x + z * z), vz = two * (y * z + w * x);
	project_real wx = two * (x * z + w * y), wy = two * (y * z - w * x), wz = 1 - two * (x * x + y * y);

	project_real su = project_load(b->scale[0] + at), sv = project_load(b->scale[1] + at),
		     sw = project_load(b->scale[2] + at);
	project_real au = su * (ax * ux + ay * uy + az * uz), bu = su * (bx * ux + by * uy + bz * uz);
	project_real av = sv * (ax * vx + ay * vy + az * vz), bv = sv * (bx * vx + by * vy + bz * vz);
	project_real aw = sw * (ax * wx + ay * wy + az * wz), bw = sw * (bx * wx + by * wy + bz * wz);
	project_real vw = sv * sw * (nx * ux + ny * uy + nz * uz),
		     wu = sw * su * (nx * vx + ny * vy + nz * vz);
	project_real uv = su * sv * (nx * wx + ny * wy + nz * wz);
	project_real xx = au * au + av * av + aw * aw, yy = bu * bu + bv * bv + bw * bw;
	project_real det = vw * vw + wu * wu + uv * uv + PROJECT_LOW_PASS * (xx + yy) +
			   PROJECT_LOW_PASS * PROJECT_LOW_PASS;
	xx += PROJECT_LOW_PASS;
	yy += PROJECT_LOW_PASS;
	project_real per_yy = 1 / yy, slope = (au * bu + av * bv + aw * bw) * per_yy;
	project_real l11 = project_sqrt(PROJECT_HALF_LOG2E * (yy / det)),
		     l22 = project_sqrt(PROJECT_HALF_LOG2E * per_yy);

	/* 2^(log2 o - radius^2) = 1/255, with room for the float kernels' rounding: each pixel decides by
	 * itself. The box has room for the rounding of its own sides. */
	project_real log_opacity = project_log2(project_load(b->opacity + at));
	project_real radius = project_sqrt(log_opacity + (7.9943534368588579 + 1e-4));
	project_real half_width = (1 + 1e-6) * (radius * project_sqrt(xx * (1 / PROJECT_HALF_LOG2E)));
	project_real half_height = (1 + 1e-6) * (radius * (yy * l22 * (1 / PROJECT_HALF_LOG2E)));
	project_real px = lens->fx * rx + lens->cx, py = lens->fy * ry + lens->cy;
	project_int columns[2], rows[2];
	/* a product with 0 is 0 where the other is finite */
	project_mask seen = (cz > lens->near) & (0 * px == 0) & (0 * py == 0) & (0 * det == 0) &
			    project_range(px, half_width, lens->width, &columns[0], &columns[1]) &
			    project_range(py, half_height, lens->height, &rows[0], &rows[1]);

	project_store_int(b->seen + at, __builtin_convertvector(seen, project_int));
	for (int i = 0; i < 2; i++) {
		project_store_int(b->columns[i] + at, columns[i]);
		project_store_int(b->rows[i] + at, rows[i]);
	}
	project_store(b->x + at, px);
	project_store(b->y + at, py);
	project_store(b->z + at, cz);
	project_store(b->l11 + at, l11);
	project_store(b->l21 + at, -l11 * slope);
	project_store(b->l22 + at, l22);
	project_store(b->log_opacity + at, log_opacity);
	project_store(b->radius + at, radius);
}

static void project_batch(const struct project_lens *lens, struct project_batch *b, int n)
{
	for (int at = 0; at < n; at += PROJECT_REALS)
		project_some(lens, b, at);
}
