/* The projection kernel, for the instruction set in force where this is included (splat/kernels.h). Plain
 * IEEE operations in a fixed order, so that all instruction sets give the same bits.
 *
 * Covariance J W Sigma W^T J^T + 0.3 I. With M = J W R S (2x3) the determinant of M M^T is the sum of the
 * squared 2x2 minors of M (Cauchy-Binet), and a minor is s_j s_k times the third axis dot the cross product
 * of the rows of J W. With the low pass: det = sum of squares + 0.3 trace + 0.09. Nothing cancels, so needles
 * keep their width, where the difference of products loses it even when it is rounded once. */
#include "splat/kernels.h"

#define PROJECT_LOW_PASS 0.3 /* px^2 */

static void project_batch(const struct project_lens *lens, struct project_batch *b)
{
	const double(*turn)[4] = lens->world_to_camera;

#pragma omp simd
	for (int l = 0; l < PROJECT_LANES; l++) {
		double mx = b->mean[0][l], my = b->mean[1][l], mz = b->mean[2][l];
		double cx = turn[0][0] * mx + turn[0][1] * my + turn[0][2] * mz + turn[0][3];
		double cy = turn[1][0] * mx + turn[1][1] * my + turn[1][2] * mz + turn[1][3];
		double cz = turn[2][0] * mx + turn[2][1] * my + turn[2][2] * mz + turn[2][3];
		double rx = cx / cz, ry = cy / cz, fx = lens->fx / cz, fy = lens->fy / cz;
		double tx = rx < lens->low[0] ? lens->low[0] : rx > lens->high[0] ? lens->high[0] : rx;
		double ty = ry < lens->low[1] ? lens->low[1] : ry > lens->high[1] ? lens->high[1] : ry;

		/* the rows of J W, and their cross product */
		double ax = fx * (turn[0][0] - tx * turn[2][0]), bx = fy * (turn[1][0] - ty * turn[2][0]);
		double ay = fx * (turn[0][1] - tx * turn[2][1]), by = fy * (turn[1][1] - ty * turn[2][1]);
		double az = fx * (turn[0][2] - tx * turn[2][2]), bz = fy * (turn[1][2] - ty * turn[2][2]);
		double area = fx * fy;
		double nx = area * (lens->normal[2][0] + tx * lens->normal[0][0] + ty * lens->normal[1][0]);
		double ny = area * (lens->normal[2][1] + tx * lens->normal[0][1] + ty * lens->normal[1][1]);
		double nz = area * (lens->normal[2][2] + tx * lens->normal[0][2] + ty * lens->normal[1][2]);

		/* the Gaussian's axes: the columns of the rotation, for a quaternion of any length */
		double w = b->quat[0][l], x = b->quat[1][l], y = b->quat[2][l], z = b->quat[3][l];
		double two = 2 / (w * w + x * x + y * y + z * z);
		double ux = 1 - two * (y * y + z * z), uy = two * (x * y + w * z), uz = two * (x * z - w * y);
		double vx = two * (x * y - w * z), vy = 1 - two * (x * x + z * z), vz = two * (y * z + w * x);
		double wx = two * (x * z + w * y), wy = two * (y * z - w * x), wz = 1 - two * (x * x + y * y);

		double su = b->scale[0][l], sv = b->scale[1][l], sw = b->scale[2][l];
		double au = su * (ax * ux + ay * uy + az * uz), bu = su * (bx * ux + by * uy + bz * uz);
		double av = sv * (ax * vx + ay * vy + az * vz), bv = sv * (bx * vx + by * vy + bz * vz);
		double aw = sw * (ax * wx + ay * wy + az * wz), bw = sw * (bx * wx + by * wy + bz * wz);
		double vw = sv * sw * (nx * ux + ny * uy + nz * uz),
		       wu = sw * su * (nx * vx + ny * vy + nz * vz);
		double uv = su * sv * (nx * wx + ny * wy + nz * wz);
		double xx = au * au + av * av + aw * aw, yy = bu * bu + bv * bv + bw * bw;

		b->x[l] = lens->fx * rx + lens->cx;
		b->y[l] = lens->fy * ry + lens->cy;
		b->z[l] = cz;
		b->xx[l] = xx + PROJECT_LOW_PASS;
		b->xy[l] = au * bu + av * bv + aw * bw;
		b->yy[l] = yy + PROJECT_LOW_PASS;
		b->det[l] = vw * vw + wu * wu + uv * uv + PROJECT_LOW_PASS * (xx + yy) +
			    PROJECT_LOW_PASS * PROJECT_LOW_PASS;
	}
}
