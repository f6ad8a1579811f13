#include "formats/cameras/dataparser.h"

#include "base/file.h"
#include "base/mem.h"
#include "formats/records/json.h"

#include <math.h>

static const char file[] = "dataparser_transforms.json";

/* x -> scale (rotation x + shift) */
struct move {
	double rotation[3][3], shift[3], scale;
};

/* The file in the folder of another one. */
static char *find_beside(const char *path, struct err *e)
{
	SCOPED char *dir = file_is_dir(path) ? file_join(path, "", "", e) : file_dir(path, e);
	char *found = dir ? file_join(dir, file, "", e) : NULL;

	if (found && file_exists(found))
		return found;
	free(found);
	return NULL;
}

char *dataparser_find(const char *splats, const char *cameras, struct err *e)
{
	char *found = strcmp(splats, "-") ? find_beside(splats, e) : NULL;

	return found || !strcmp(cameras, "-") ? found : find_beside(cameras, e);
}

static int check_rotation(double m[3][3], const char *name, const char *key, struct err *e)
{
	for (int i = 0; i < 3; i++)
		for (int k = 0; k < 3; k++) {
			const double product = m[i][0] * m[k][0] + m[i][1] * m[k][1] + m[i][2] * m[k][2];
			if (fabs(product - (i == k)) > 1e-3)
				return err_file(e, name, "key '%s' is not a rotation and a shift", key);
		}
	return 0;
}

/* A 3x4 matrix and a scale; nothing where neither is there and they are not needed. */
static int read_move(struct move *m, const cJSON *root, const char *matrix, const char *scale, int need,
	const char *name, struct err *e)
{
	const cJSON *rows = json_get(root, matrix);
	double values[4][4];

	*m = (struct move){{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {0}, 1};
	if (need || rows) {
		if (json_matrix(root, matrix, cJSON_GetArraySize(rows) == 4 ? 4 : 3, 4, values[0], name, e))
			return -1;
		for (int i = 0; i < 3; i++) {
			memcpy(m->rotation[i], values[i], sizeof m->rotation[i]);
			m->shift[i] = values[i][3];
		}
	}
	if (json_number(root, scale, need, &m->scale, name, e) < 0 ||
		check_rotation(m->rotation, name, matrix, e))
		return -1;
	return m->scale > 0 ? 0 : err_file(e, name, "key '%s' is not positive", scale);
}

/* What nerfstudio did after the frame of the transforms.json: the file tells of both steps as one, m = now o
 * before, with shifts before scales. */
static void without(struct move *m, const struct move *before)
{
	struct move now = {.scale = m->scale / before->scale};

	for (int i = 0; i < 3; i++)
		for (int k = 0; k < 3; k++)
			for (int j = 0; j < 3; j++)
				now.rotation[i][k] += m->rotation[i][j] * before->rotation[k][j];
	for (int i = 0; i < 3; i++) {
		now.shift[i] = m->shift[i];
		for (int j = 0; j < 3; j++)
			now.shift[i] -= now.rotation[i][j] * before->shift[j];
	}
	*m = now;
}

static void move_camera(struct camera *c, const struct move *m)
{
	double centre[3], to[3], rotation[3][3] = {{0}};

	camera_centre(c, centre);
	for (int i = 0; i < 3; i++) {
		to[i] = m->shift[i];
		for (int j = 0; j < 3; j++)
			to[i] += m->rotation[i][j] * centre[j];
		to[i] *= m->scale;
		for (int k = 0; k < 3; k++)
			for (int j = 0; j < 3; j++)
				rotation[i][k] += c->world_to_camera[i][j] * m->rotation[k][j];
	}
	camera_set_centre(c, rotation, to);
}

int dataparser_move(struct cameras *c, const char *path, const char *cameras, struct err *e)
{
	SCOPED_BY(json_release) cJSON *root = json_read(path, e), *source = NULL;
	struct move m, applied;
	struct err ignored;

	if (!root)
		return -1;
	if (strcmp(cameras, "-") && !file_is_dir(cameras))
		source = json_read(cameras, &ignored);
	const int is_3dgs = cJSON_IsArray(source); /* in the frame of its splats already */
	if (read_move(&m, root, "transform", "scale", 1, file_name(path), e) ||
		read_move(&applied, source, "applied_transform", "applied_scale", 0, cameras, e))
		return -1;
	without(&m, &applied);
	for (size_t i = 0; i < c->n && !is_3dgs; i++)
		move_camera(&c->views[i], &m);
	return 0;
}
