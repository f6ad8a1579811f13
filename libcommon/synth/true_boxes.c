#include "synth/true_boxes.h"

#include <math.h>

/* The smallest box around o along x and y axes that are turned by `angle`. */
static struct box box_at(const struct synth_object *o, const struct synth_surface *s, double angle)
{
	const double c = cos(angle), n = sin(angle);
	struct box b = {{o->x, o->y, o->z}, {{c, n, 0}, {-n, c, 0}, {0, 0, 1}}, {0}};
	const double turn = angle - o->yaw; /* from the surface's own axes */
	const double axes[3][3] = {{cos(turn), sin(turn), 0}, {-sin(turn), cos(turn), 0}, {0, 0, 1}};

	for (int k = 0; k < 3; k++) {
		const double back[3] = {-axes[k][0], -axes[k][1], -axes[k][2]};
		double high = o->scale * synth_surface_reach(s, axes[k]);
		double low = -o->scale * synth_surface_reach(s, back);
		b.half[k] = (high - low) / 2;
		for (int d = 0; d < 3; d++)
			b.centre[d] += (high + low) / 2 * b.axes[k][d];
	}
	return b;
}

void synth_object_boxes(const struct synth_object *o, struct box *aligned, struct box *turned)
{
	struct synth_surface s;

	synth_object_surface(&s, o->shape);
	*aligned = box_at(o, &s, 0);
	*turned = synth_surface_is_round(&s) ? *aligned : box_at(o, &s, o->yaw);
}
