/* Colour from spherical harmonics, with 3DGS's basis and signs (Kerbl et al. 2023; Ramamoorthi and Hanrahan
 * 2001). */
#ifndef SPLAT_SH_H
#define SPLAT_SH_H

/* rgb[c] = max(0, 1/2 + sum_k sh[k][c] Y_k(d)), d the direction from the camera's centre to the Gaussian's
 * mean, of any length but 0. sh is (coefficients,3), coefficients 1, 4, 9 or 16. */
void sh_color(const float *sh, int coefficients, const double direction[3], float rgb[3]);

#endif
