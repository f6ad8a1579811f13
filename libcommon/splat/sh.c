#include "splat/sh.h"

#include <math.h>
#include <string.h>

#define C2 1.0925484305920792
#define C20 0.31539156525252005
#define C30 0.3731763325901154
#define C31 0.4570457994644658
#define C32 2.890611442640554
#define C33 0.5900435899266435

void sh_basis(const double d[3], int coefficients, double y[SH_MAX])
{
	double x = d[0], yy = d[1], z = d[2], x2 = x * x, y2 = yy * yy, z2 = z * z;

	y[0] = SH_C0;
	if (coefficients < 4)
		return;
	y[1] = -SH_C1 * yy;
	y[2] = SH_C1 * z;
	y[3] = -SH_C1 * x;
	if (coefficients < 9)
		return;
	y[4] = C2 * x * yy;
	y[5] = -C2 * yy * z;
	y[6] = C20 * (2 * z2 - x2 - y2);
	y[7] = -C2 * x * z;
	y[8] = C2 / 2 * (x2 - y2);
	if (coefficients < 16)
		return;
	y[9] = -C33 * yy * (3 * x2 - y2);
	y[10] = C32 * x * yy * z;
	y[11] = -C31 * yy * (4 * z2 - x2 - y2);
	y[12] = C30 * z * (2 * z2 - 3 * x2 - 3 * y2);
	y[13] = -C31 * x * (4 * z2 - x2 - y2);
	y[14] = C32 / 2 * z * (x2 - y2);
	y[15] = -C33 * x * (x2 - 3 * y2);
}

void sh_slopes(const double d[3], double slope[3][SH_MAX])
{
	const double x = d[0], y = d[1], z = d[2], xx = x * x, yy = y * y, zz = z * z;
	const double s[3][SH_MAX] = {
		{0, 0, 0, -SH_C1, C2 * y, 0, -2 * C20 * x, -C2 * z, C2 * x, -6 * C33 * x * y, C32 * y * z,
			2 * C31 * x * y, -6 * C30 * x * z, -C31 * (4 * zz - 3 * xx - yy), C32 * x * z,
			-3 * C33 * (xx - yy)},
		{0, -SH_C1, 0, 0, C2 * x, -C2 * z, -2 * C20 * y, 0, -C2 * y, -3 * C33 * (xx - yy),
			C32 * x * z, -C31 * (4 * zz - xx - 3 * yy), -6 * C30 * y * z, 2 * C31 * x * y,
			-C32 * y * z, 6 * C33 * x * y},
		{0, 0, SH_C1, 0, 0, -C2 * y, 4 * C20 * z, -C2 * x, 0, 0, C32 * x * y, -8 * C31 * y * z,
			3 * C30 * (2 * zz - xx - yy), -8 * C31 * x * z, C32 / 2 * (xx - yy), 0},
	};

	memcpy(slope, s, sizeof s);
}

void sh_color(const float *sh, int coefficients, const double direction[3], float rgb[3])
{
	double length =
		sqrt(direction[0] * direction[0] + direction[1] * direction[1] + direction[2] * direction[2]);
	double d[3] = {direction[0] / length, direction[1] / length, direction[2] / length}, y[SH_MAX];

	sh_basis(d, coefficients, y);
	for (int c = 0; c < 3; c++) {
		double sum = 0.5;
		for (int k = 0; k < coefficients; k++)
			sum += y[k] * sh[3 * k + c];
		rgb[c] = (float)fmax(0, sum);
	}
}
