#include "splat/project.h"

#include <string.h>

void project_lens_make(struct project_lens *lens, const struct camera *c, double near)
{
	double half_x = 0.5 * c->width / c->fx, half_y = 0.5 * c->height / c->fy;

	memcpy(lens->world_to_camera, c->world_to_camera, sizeof lens->world_to_camera);
	lens->fx = c->fx;
	lens->fy = c->fy;
	lens->cx = c->cx;
	lens->cy = c->cy;
	lens->width = c->width;
	lens->height = c->height;
	lens->near = near;
	for (int k = 0; k < 3; k++) {
		const double *a = c->world_to_camera[(k + 1) % 3], *b = c->world_to_camera[(k + 2) % 3];
		for (int i = 0; i < 3; i++)
			lens->normal[k][i] =
				a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3];
	}
	/* 1.3 times the half field of view where the principal point is central: 0.3 beyond each edge */
	lens->low[0] = -c->cx / c->fx - 0.3 * half_x;
	lens->high[0] = (c->width - c->cx) / c->fx + 0.3 * half_x;
	lens->low[1] = -c->cy / c->fy - 0.3 * half_y;
	lens->high[1] = (c->height - c->cy) / c->fy + 0.3 * half_y;
}

int project_take(struct project_batch *b, const struct splats *s, size_t i, int lane)
{
	if (!(255 * (double)s->opacities[i] >= 1))
		return 0;
	for (size_t k = 0; k < 3; k++) {
		b->mean[k][lane] = s->means[3 * i + k];
		b->scale[k][lane] = s->scales[3 * i + k];
	}
	for (size_t k = 0; k < 4; k++)
		b->quat[k][lane] = s->quats[4 * i + k];
	b->opacity[lane] = s->opacities[i];
	return 1;
}
