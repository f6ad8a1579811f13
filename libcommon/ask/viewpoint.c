#include "ask/viewpoint.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static int is_same_point(const double a[3], const double b[3])
{
	return a[0] == b[0] && a[1] == b[1] && a[2] == b[2];
}

int viewpoint_is_same(const struct viewpoint *a, const struct viewpoint *b)
{
	return a->kind == b->kind && (a->kind != VIEWPOINT_CAMERA || a->camera == b->camera) &&
	       (a->kind != VIEWPOINT_POINT || is_same_point(a->point, b->point)) &&
	       a->is_facing == b->is_facing && (!a->is_facing || is_same_point(a->faced, b->faced));
}

int viewpoint_read(
	struct viewpoint *v, const char *text, const struct cameras *cameras, const double offset[3])
{
	char *end;

	*v = (struct viewpoint){.kind = VIEWPOINT_POINT};
	for (size_t i = 0; i < cameras->n; i++)
		if (!strcmp(cameras->views[i].name, text)) {
			*v = (struct viewpoint){.kind = VIEWPOINT_CAMERA, .camera = &cameras->views[i]};
			return 0;
		}
	for (int k = 0; k < 3; k++) {
		v->point[k] = strtod(text, &end) - offset[k];
		if (end == text || !isfinite(v->point[k]) || *end != (k < 2 ? ',' : 0))
			return -1;
		text = end + 1;
	}
	return 0;
}
