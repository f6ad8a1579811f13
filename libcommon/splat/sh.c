#include "splat/sh.h"

#include <math.h>

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
	y[4] = 1.0925484305920792 * x * yy;
	y[5] = -1.0925484305920792 * yy * z;
	y[6] = 0.31539156525252005 * (2 * z2 - x2 - y2);
	y[7] = -1.0925484305920792 * x * z;
	y[8] = 0.5462742152960396 * (x2 - y2);
	if (coefficients < 16)
		return;
	y[9] = -0.5900435899266435 * yy * (3 * x2 - y2);
	y[10] = 2.890611442640554 * x * yy * z;
	y[11] = -0.4570457994644658 * yy * (4 * z2 - x2 - y2);
	y[12] = 0.3731763325901154 * z * (2 * z2 - 3 * x2 - 3 * y2);
	y[13] = -0.4570457994644658 * x * (4 * z2 - x2 - y2);
	y[14] = 1.445305721320277 * z * (x2 - y2);
	y[15] = -0.5900435899266435 * x * (x2 - 3 * y2);
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
