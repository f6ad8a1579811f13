#include "splat/move.h"

#include "geom/rotation.h"

#include <math.h>
#include <string.h>

/* turn[j][k] is the integral of Y_j(d) Y_k(R^T d) over the sphere. The product has degree 6 at most, so four
 * points of Gauss and Legendre along z and eight around it give the integral exactly. */
void sh_turn(const double rotation[3][3], double turn[SH_MAX][SH_MAX])
{
	static const double nodes[4] = {
		-0.86113631159405258, -0.33998104358485626, 0.33998104358485626, 0.86113631159405258};
	static const double weights[4] = {
		0.34785484513745386, 0.65214515486254614, 0.65214515486254614, 0.34785484513745386};
	const double pi = acos(-1);
	double here[SH_MAX], before[SH_MAX];

	memset(turn, 0, SH_MAX * sizeof *turn);
	for (int i = 0; i < 32; i++) {
		const double z = nodes[i / 8], radius = sqrt(1 - z * z), angle = 2 * pi * (i % 8) / 8;
		const double d[3] = {radius * cos(angle), radius * sin(angle), z};
		double back[3];
		for (int k = 0; k < 3; k++)
			back[k] = rotation[0][k] * d[0] + rotation[1][k] * d[1] + rotation[2][k] * d[2];
		sh_basis(d, SH_MAX, here);
		sh_basis(back, SH_MAX, before);
		for (int j = 0; j < SH_MAX; j++)
			for (int k = 0; k < SH_MAX; k++)
				turn[j][k] += weights[i / 8] * 2 * pi / 8 * here[j] * before[k];
	}
}

/* One Gaussian's, band by band. */
static void turn_sh(float *sh, int coefficients, const double turn[SH_MAX][SH_MAX])
{
	double out[SH_MAX][3] = {{0}};

	for (int l = 1; l * l < coefficients; l++)
		for (int j = l * l; j < (l + 1) * (l + 1); j++)
			for (int k = l * l; k < (l + 1) * (l + 1); k++)
				for (int c = 0; c < 3; c++)
					out[j][c] += turn[j][k] * (double)sh[3 * k + c];
	for (int j = 1; j < coefficients; j++)
		for (int c = 0; c < 3; c++)
			sh[3 * j + c] = (float)out[j][c];
}

/* q = r q, of q's own length. */
static void turn_quat(float *q, const double r[4])
{
	const double w = q[0], x = q[1], y = q[2], z = q[3];

	q[0] = (float)(r[0] * w - r[1] * x - r[2] * y - r[3] * z);
	q[1] = (float)(r[0] * x + r[1] * w + r[2] * z - r[3] * y);
	q[2] = (float)(r[0] * y - r[1] * z + r[2] * w + r[3] * x);
	q[3] = (float)(r[0] * z + r[1] * y - r[2] * x + r[3] * w);
}

static void place(
	double to[3], const double rotation[3][3], double scale, const double from[3], const double shift[3])
{
	for (int k = 0; k < 3; k++)
		to[k] = scale * (rotation[k][0] * from[0] + rotation[k][1] * from[1] +
					rotation[k][2] * from[2]) +
			shift[k];
}

void splats_move(struct splats *s, double offset[3], const struct move *m)
{
	static const double still[3];
	const double *q = m->quat, length = sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
	const double unit[4] = {q[0] / length, q[1] / length, q[2] / length, q[3] / length};
	const int is_far = offset[0] != 0 || offset[1] != 0 || offset[2] != 0;
	const int is_turned = q[1] != 0 || q[2] != 0 || q[3] != 0;
	double rotation[3][3], turn[SH_MAX][SH_MAX], to[3];

	rotation_of_quat(unit, rotation);
	sh_turn((const double(*)[3])rotation, turn);
	for (size_t i = 0; i < s->n; i++) {
		float *mean = s->means + 3 * i, *scale = s->scales + 3 * i;
		const double from[3] = {mean[0], mean[1], mean[2]};
		place(to, (const double(*)[3])rotation, m->scale, from, is_far ? still : m->shift);
		for (int k = 0; k < 3; k++) {
			mean[k] = (float)to[k];
			scale[k] = (float)((double)scale[k] * m->scale);
		}
		if (!is_turned)
			continue;
		turn_quat(s->quats + 4 * i, unit);
		turn_sh(s->sh + 3 * (size_t)s->sh_coefficients * i, s->sh_coefficients,
			(const double(*)[SH_MAX])turn);
	}
	if (!is_far)
		return;
	place(to, (const double(*)[3])rotation, m->scale, offset, m->shift);
	memcpy(offset, to, sizeof to);
}
