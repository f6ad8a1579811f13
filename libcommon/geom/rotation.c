#include "geom/rotation.h"

#include <math.h>

/* Whichever of the four is largest is found first, so nothing small is divided by. */
void rotation_to_quat(const double m[3][3], double q[4])
{
	double trace = m[0][0] + m[1][1] + m[2][2];
	int a = m[1][1] > m[0][0] ? 1 : 0;

	a = m[2][2] > m[a][a] ? 2 : a;
	if (trace > m[a][a]) {
		double s = 2 * sqrt(1 + trace);
		q[0] = s / 4;
		q[1] = (m[2][1] - m[1][2]) / s;
		q[2] = (m[0][2] - m[2][0]) / s;
		q[3] = (m[1][0] - m[0][1]) / s;
	} else {
		int b = (a + 1) % 3, c = (a + 2) % 3;
		double s = 2 * sqrt(1 + m[a][a] - m[b][b] - m[c][c]);
		q[0] = (m[c][b] - m[b][c]) / s;
		q[1 + a] = s / 4;
		q[1 + b] = (m[b][a] + m[a][b]) / s;
		q[1 + c] = (m[c][a] + m[a][c]) / s;
	}
	for (int i = 0, flip = q[0] < 0; flip && i < 4; i++)
		q[i] = -q[i];
}

void rotation_of_quat(const double q[4], double m[3][3])
{
	double length = hypot(hypot(q[0], q[1]), hypot(q[2], q[3]));
	double w = q[0] / length, x = q[1] / length, y = q[2] / length, z = q[3] / length;

	m[0][0] = 1 - 2 * (y * y + z * z);
	m[0][1] = 2 * (x * y - w * z);
	m[0][2] = 2 * (x * z + w * y);
	m[1][0] = 2 * (x * y + w * z);
	m[1][1] = 1 - 2 * (x * x + z * z);
	m[1][2] = 2 * (y * z - w * x);
	m[2][0] = 2 * (x * z - w * y);
	m[2][1] = 2 * (y * z + w * x);
	m[2][2] = 1 - 2 * (x * x + y * y);
}
