#include "ask/viewpoint.h"

#include <math.h>
#include <stdlib.h>

int viewpoint_read(
	struct viewpoint *v, const char *text, const struct cameras *cameras, const double offset[3])
{
	char *end;

	*v = (struct viewpoint){.kind = VIEWPOINT_CAMERA, .camera = cameras_find(cameras, text)};
	if (v->camera)
		return 0;
	v->kind = VIEWPOINT_POINT;
	for (int k = 0; k < 3; k++) {
		v->point[k] = strtod(text, &end) - offset[k];
		if (end == text || !isfinite(v->point[k]) || *end != (k < 2 ? ',' : 0))
			return -1;
		text = end + 1;
	}
	return 0;
}
