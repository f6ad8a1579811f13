/* Rotations as matrices and as quaternions (w,x,y,z). */
#pragma once

/* The unit quaternion of a rotation (3,3), w >= 0. */
void rotation_to_quat(const double m[3][3], double q[4]);

/* The rotation of a quaternion of any length but 0. */
void rotation_of_quat(const double q[4], double m[3][3]);
