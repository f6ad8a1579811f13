#include "cmd/check/check.h"

#include "base/file.h"
#include "base/mem.h"
#include "formats/cameras/colmap.h"
#include "formats/scene/weights.h"

#include <dirent.h>
#include <stdlib.h>
#include <string.h>

static int check_scene(struct check *c, const char *path, struct err *e)
{
	SCOPED_BY(scene_free) struct scene s = {0};

	if (scene_read(&s, path, e))
		return -1;
	c->kind = "scene";
	c->scene = s.fingerprint;
	check_add_splats(c, &s.splats);
	check_add_views(c, &s.cameras);
	return 0;
}

/* One view of a folder, which is of the scene that the folder's first one with a fingerprint is of. */
static int add_view_weights(struct check *c, const char *file, char **first, long long *total, struct err *e)
{
	SCOPED_BY(weights_close) struct weights w = {0};

	if (weights_open_file(&w, file, e))
		return -1;
	int bad = *first ? fingerprint_check("scene", file, &w.scene, *first, &c->scene, e) : 0;
	if (!bad && !*first && *w.scene.hex) {
		c->scene = w.scene;
		*first = mem_strdup(file, e);
		bad = *first ? 0 : -1;
	}
	*total += (long long)w.indptr[(int64_t)w.width * w.height];
	return bad;
}

/* Adds the views of a folder of gs-weigh, in the order of their names; *views says how many there are. */
static int add_weights(
	struct check *c, const char *path, struct dirent **names, int n, long long *views, struct err *e)
{
	long long total = 0;
	SCOPED char *first = NULL;
	int bad = 0;

	*views = 0;
	for (int i = 0; i < n && !bad; i++) {
		const char *dot = strrchr(names[i]->d_name, '.');
		if (!dot || strcmp(dot, ".safetensors"))
			continue;
		SCOPED char *file = file_join(path, names[i]->d_name, "", e);
		bad = file ? add_view_weights(c, file, &first, &total, e) : -1;
		++*views;
	}
	if (bad)
		return -1;
	c->kind = "weights";
	check_add(c, "views", *views);
	check_add(c, "weights", total);
	return 0;
}

/* Each kind of folder is known by what lies in it. */
int check_folder(struct check *c, const char *path, struct err *e)
{
	static const char *const parts[] = {"splats.safetensors", "cameras.json"};
	SCOPED struct dirent **names = NULL;
	long long views = 0;
	int found = 0;

	for (int i = 0; i < 2; i++) {
		SCOPED char *part = file_join(path, parts[i], "", e);
		if (!part)
			return -1;
		found |= file_exists(part) << i;
	}
	if (found == 3)
		return check_scene(c, path, e);
	if (found & 1)
		return err_set(e, ERR_FORMAT, "%s: a scene without %s", path, parts[1]);
	if (colmap_is_model(path))
		return check_cameras(c, path, "COLMAP model", e);
	int n = scandir(path, &names, NULL, alphasort);
	if (n < 0)
		return err_errno(e, "%s", path);
	int bad = add_weights(c, path, names, n, &views, e);
	for (int i = 0; i < n; i++)
		free(names[i]);
	if (!bad && !views)
		return err_set(e, ERR_FORMAT, "%s: not a scene, COLMAP model or folder of weights", path);
	return bad;
}
