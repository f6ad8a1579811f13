#include "cmd/import/photographs.h"

#include "base/file.h"
#include "base/mem.h"
#include "base/name.h"
#include "base/path.h"
#include "base/utf8.h"
#include "geom/views.h"

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
	static const char *const suffixes[] = {"", ".jpg", ".JPG", ".jpeg", ".JPEG", ".png", ".PNG"};
	const size_t tries = image[view_stem(image)] ? 1 : sizeof suffixes / sizeof *suffixes;
	const int leaves = path_leaves(image);
	SCOPED char *decomposed = name_decomposed(image, e);
	char *path = NULL;

	for (size_t i = 0; decomposed && !path && i < 2 * tries; i++) {
		const char *name = i % 2 ? decomposed : image, *suffix = suffixes[i / 2];
		path = leaves ? NULL : try_file(dir, name, suffix, e);
		if (!path)
			path = try_file(dir, view_base(name), suffix, e);
	}
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

int photographs_find(struct cameras *c, const char *images, const char *scene, size_t *missing, struct err *e)
{
	*missing = 0;
	for (size_t i = 0; i < c->n; i++) {
		struct camera *v = &c->views[i];
		SCOPED char *path = images ? find_image(images, v->image, e) : NULL;
		free(v->image);
		v->image = NULL;
		if (path) {
			*e = (struct err){0};
			v->image = image_path(scene, path, e);
			if (!v->image && e->code)
				return -1;
		}
		*missing += !v->image;
	}
	return 0;
}
