#include "formats/cameras/cameras3dgs.h"

#include "base/mem.h"
#include "formats/records/json.h"
#include "geom/views.h"

#include <math.h>
#include <stdio.h>

static int read_view(struct camera *c, const cJSON *item, const char *where, struct err *e)
{
	const char *image = NULL;
	double width, height, rows[9], centre[3], rotation[3][3];

	if (json_string(item, "img_name", 1, &image, where, e) < 0 ||
		json_number(item, "width", 1, &width, where, e) < 0 ||
		json_number(item, "height", 1, &height, where, e) < 0 ||
		json_number(item, "fx", 1, &c->fx, where, e) < 0 ||
		json_number(item, "fy", 1, &c->fy, where, e) < 0 ||
		json_matrix(item, "position", 3, 0, centre, where, e) ||
		json_matrix(item, "rotation", 3, 3, rows, where, e))
		return -1;
	if (view_set_size(c, width, height))
		return err_file(e, where, "size %gx%g is not whole numbers in 1 to 65536", width, height);
	c->cx = width / 2;
	c->cy = height / 2;
	/* The file has camera to world. */
	for (int r = 0; r < 3; r++)
		for (int k = 0; k < 3; k++)
			rotation[r][k] = rows[3 * k + r];
	camera_set_centre(c, rotation, centre);
	c->image = view_image(image, e);
	return c->image ? 0 : -1;
}

int cameras3dgs_parse(struct cameras *c, const cJSON *list, const char *path, struct err *e)
{
	const cJSON *item;
	char where[512];
	int bad = 0;

	*c = (struct cameras){0};
	if (!cJSON_IsArray(list))
		return err_file(e, path, "not a list of cameras");
	c->views = mem_zalloc((size_t)cJSON_GetArraySize(list), sizeof *c->views, path, e);
	if (!c->views)
		return -1;
	cJSON_ArrayForEach(item, list)
	{
		snprintf(where, sizeof where, "%s: camera %zu", path, c->n);
		bad = read_view(&c->views[c->n++], item, where, e);
		if (bad)
			break;
	}
	if (!bad)
		bad = views_finish(c, path, e);
	if (bad)
		cameras_free(c);
	return bad;
}
