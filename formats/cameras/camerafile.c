#include "formats/cameras/camerafile.h"

#include "base/file.h"
#include "base/mem.h"
#include "base/name.h"
#include "base/path.h"
#include "base/textfile.h"
#include "base/utf8.h"
#include "formats/cameras/cameras3dgs.h"
#include "formats/cameras/colmap.h"
#include "formats/records/foreign.h"
#include "formats/records/json.h"
#include "formats/cameras/transforms.h"
#include "geom/lens.h"
#include "geom/views.h"

#include <stdlib.h>
#include <string.h>

char *camerafile_find(const char *dir, struct err *e)
{
	static const char *const places[] = {"cameras.json", "sparse/0", "sparse", "transforms.json"};

	if (colmap_is_model(dir))
		return mem_strdup(dir, e);
	for (size_t i = 0; i < sizeof places / sizeof *places; i++) {
		char *path = file_join(dir, places[i], "", e);
		if (!path)
			return NULL;
		if (strstr(places[i], ".json") ? file_exists(path) : colmap_is_model(path))
			return path;
		free(path);
	}
	err_set(e, ERR_FORMAT,
		"%s: no cameras here: no COLMAP model, cameras.json, sparse/0, sparse or transforms.json",
		dir);
	return NULL;
}

/* JSON, or what else the file is. */
static cJSON *read_json(const char *path, struct err *e)
{
	const char *name = file_name(path);
	cJSON *root = NULL;
	char *text;
	size_t len;

	if (textfile_read(path, &text, &len, e))
		return NULL;
	if (strchr("{[", text[strspn(text, " \t\r\n")]))
		root = json_parse(text, len, name, e);
	else if (!foreign_file(name, FOREIGN_CAMERAS, text, len, e))
		err_set(e, ERR_FORMAT,
			"%s: neither the folder of a COLMAP model, nor a 3DGS cameras.json or a transforms.json",
			name);
	free(text);
	return root;
}

int camerafile_read(struct cameras *c, const char *path, struct err *e)
{
	const char *name = file_name(path);
	cJSON *root = NULL;
	int bad = -1;

	*c = (struct cameras){0};
	if (file_is_dir(path)) {
		bad = colmap_read(c, path, e);
	} else {
		root = read_json(path, e);
		const cJSON *frames = cJSON_GetObjectItemCaseSensitive(root, "frames"),
			    *image = cJSON_GetObjectItemCaseSensitive(root ? root->child : NULL, "img_name");
		if (root && !frames && !image && foreign_json(root, name, e))
			bad = -1;
		else if (cJSON_IsArray(root))
			bad = cameras3dgs_parse(c, root, name, e);
		else if (root)
			bad = transforms_parse(c, root, name, e);
		cJSON_Delete(root);
	}
	if (!bad && !c->n)
		bad = err_set(e, ERR_FORMAT, "%s: no views", name);
	if (bad)
		cameras_free(c);
	return bad ? textfile_note(path, e) : 0;
}

int camerafile_need_pinholes(const struct cameras *c, const char *path, const char *images, struct err *e)
{
	size_t i = 0;

	while (i < c->n && !c->views[i].lens.model)
		i++;
	if (i == c->n)
		return 0;
	const struct camera *v = &c->views[i];
	const char *model = lens_model_name(v->lens.model);
	if (!file_is_dir(path))
		return err_set(e, ERR_FORMAT,
			"%s: view '%s': camera model %s distorts: gs-import --undistort takes the pinhole of the same view",
			file_name(path), v->name, model);
	return err_set(e, ERR_FORMAT,
		"%s: view '%s': camera model %s distorts: gs-import --undistort takes the pinhole of the same view, and so does 'colmap image_undistorter --image_path %s --input_path %s --output_path undistorted'",
		file_name(path), v->name, model, images ? images : "IMAGES", path);
}

/* The path of a file that exists, or NULL. *e is set only when memory is out. */
static char *try_file(const char *dir, const char *name, const char *suffix, struct err *e)
{
	char *path = file_join(dir, name, suffix, e);

	if (path && file_exists(path) && !file_is_dir(path))
		return path;
	free(path);
	return NULL;
}

/* The folder is the user's, the name another program's: it cannot lead out of the folder. */
static char *find_image(const char *dir, const char *image, struct err *e)
{
	const int leaves = path_leaves(image);
	static const char *const suffixes[] = {"", ".jpg", ".JPG", ".jpeg", ".JPEG", ".png", ".PNG"};
	size_t tries = image[view_stem(image)] ? 1 : sizeof suffixes / sizeof *suffixes;
	char *path = NULL, *decomposed = name_decomposed(image, e);

	for (size_t i = 0; decomposed && !path && i < 2 * tries; i++) {
		const char *name = i % 2 ? decomposed : image, *suffix = suffixes[i / 2];
		path = leaves ? NULL : try_file(dir, name, suffix, e);
		if (!path)
			path = try_file(dir, view_base(name), suffix, e);
	}
	free(decomposed);
	return path;
}

/* The photograph's path as the scene has it, or NULL: JSON cannot have a path that is not UTF-8. */
static char *image_path(const char *scene, const char *path, struct err *e)
{
	char *relative = path_relative(scene, path, e);

	if (relative && utf8_check(relative, strlen(relative)) < strlen(relative)) {
		free(relative);
		*e = (struct err){0};
		return NULL;
	}
	return relative;
}

int camerafile_images(
	struct cameras *c, const char *images, const char *scene, size_t *missing, struct err *e)
{
	*missing = 0;
	for (size_t i = 0; i < c->n; i++) {
		struct camera *v = &c->views[i];
		char *path = images ? find_image(images, v->image, e) : NULL;
		free(v->image);
		v->image = NULL;
		if (path) {
			*e = (struct err){0};
			v->image = image_path(scene, path, e);
			free(path);
			if (!v->image && e->code)
				return -1;
		}
		*missing += !v->image;
	}
	return 0;
}
