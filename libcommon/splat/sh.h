/* Colour from spherical harmonics, with 3DGS's basis and signs (Ramamoorthi and Hanrahan 2001). */
#pragma once

#define SH_C0 0.28209479177387814 /* Y_0 = 1 / (2 sqrt(pi)) */
#define SH_C1 0.4886025119029199  /* of Y_1 to Y_3: sqrt(3 / (4 pi)) */

enum { SH_MAX = 16 };

/* Y_0 ... Y_15 at the unit vector d, as far as `coefficients`. */
void sh_basis(const double d[3], int coefficients, double y[SH_MAX]);

/* slope[k][m] = dY_m/d(d[k]), of all 16, the polynomials of sh_basis as functions of three numbers. */
void sh_slopes(const double d[3], double slope[3][SH_MAX]);

/* rgb[c] = max(0, 1/2 + sum_k sh[k][c] Y_k(d)), d the direction from the camera's centre to the Gaussian's
 * mean, of any length but 0. sh is (coefficients,3), coefficients 1, 4, 9 or 16. */
void sh_color(const float *sh, int coefficients, const double direction[3], float rgb[3]);
