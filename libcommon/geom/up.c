#include "geom/up.h"

#include <math.h>
#include <string.h>

/* What the mean of the cameras' ups counts beside their level axes: enough to settle what these leave open,
 * too little to tilt what they settle. */
static const double pull = 1e-3;

/* The eigenvector of the smallest eigenvalue of a symmetric matrix (3,3), destroyed (Jacobi's rotations). */
static void least_vector(double m[3][3], double out[3])
{
	double v[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};

	for (int sweep = 0; sweep < 32; sweep++)
		for (int p = 0; p < 2; p++)
			for (int q = p + 1; q < 3; q++) {
				if (m[p][q] == 0)
					continue;
				double angle = 0.5 * atan2(2 * m[p][q], m[q][q] - m[p][p]);
				double c = cos(angle), s = sin(angle);
				for (int k = 0; k < 3; k++) {
					double a = m[k][p], b = m[k][q];
					m[k][p] = c * a - s * b;
					m[k][q] = s * a + c * b;
				}
				for (int k = 0; k < 3; k++) {
					double a = m[p][k], b = m[q][k];
					m[p][k] = c * a - s * b;
					m[q][k] = s * a + c * b;
					a = v[k][p], b = v[k][q];
					v[k][p] = c * a - s * b;
					v[k][q] = s * a + c * b;
				}
			}
	int least = m[1][1] < m[0][0] ? 1 : 0;
	least = m[2][2] < m[least][least] ? 2 : least;
	for (int k = 0; k < 3; k++)
		out[k] = v[k][least];
}

void cameras_up(const struct cameras *c, double up[3])
{
	double mean[3] = {0}, m[3][3] = {{0}};

	for (size_t i = 0; i < c->n; i++)
		for (int k = 0; k < 3; k++) {
			const double *x = c->views[i].world_to_camera[0], *y = c->views[i].world_to_camera[1];
			mean[k] -= y[k];
			for (int l = 0; l < 3; l++)
				m[k][l] += x[k] * x[l];
		}
	double length = sqrt(mean[0] * mean[0] + mean[1] * mean[1] + mean[2] * mean[2]);
	if (!(length > 0)) {
		memcpy(up, (double[3]){0, 0, 1}, 3 * sizeof *up);
		return;
	}
	for (int k = 0; k < 3; k++)
		for (int l = 0; l < 3; l++)
			m[k][l] -= pull * (double)c->n * mean[k] * mean[l] / (length * length);
	least_vector(m, up);
	if (up[0] * mean[0] + up[1] * mean[1] + up[2] * mean[2] < 0)
		for (int k = 0; k < 3; k++)
			up[k] = -up[k];
}
