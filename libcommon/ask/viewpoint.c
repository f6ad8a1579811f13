#include "ask/viewpoint.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

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
