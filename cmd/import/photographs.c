#include "cmd/import/photographs.h"

#include "base/file.h"
#include "base/mem.h"
#include "base/name.h"
#include "base/names.h"
#include "base/path.h"
#include "base/utf8.h"
#include "geom/views.h"

#include <dirent.h>
#include <strings.h>

/* The path of a file that exists, whatever the case of its letters: cameras that were made where case does
 * not count say IMG_1.JPG of IMG_1.jpg. NULL where there is none. *e is set only when memory is out. */
static char *try_file(const char *dir, const char *name, struct err *e)
{
	char *path = path_alike(dir, name, e);

	if (path && file_exists(path) && !file_is_dir(path))
		return path;
	free(path);
	return NULL;
}

/* The one file of that name with another ending. NULL where none or several are, or with *e. */
static char *find_ending(const char *dir, const char *name, struct err *e)
{
	const char *base = view_base(name);
	const size_t stem = view_stem(base);
	size_t count = 0;
	char *found = NULL;
	SCOPED char *path = file_join(dir, name, "", e), *folder = path ? file_dir(path, e) : NULL;
	DIR *listed = folder ? opendir(folder) : NULL;

	for (struct dirent *d = listed ? readdir(listed) : NULL; d; d = readdir(listed)) {
		if (strncasecmp(d->d_name, base, stem) != 0 || view_stem(d->d_name) != stem ||
			!d->d_name[stem])
			continue;
		free(found);
		found = count++ ? NULL : file_join(folder, d->d_name, "", e);
	}
	if (listed)
		closedir(listed);
	return found;
}

/* The folder is the user's, the name another program's: it cannot lead out of the folder. */
static char *find_image(const char *dir, const char *image, struct err *e)
{
	SCOPED char *decomposed = name_decomposed(image, e);
	char *path = NULL;

	for (int i = 0; decomposed && !path && i < 4; i++) {
		const char *name = i % 2 ? decomposed : image, *base = view_base(name);
		char *(*find)(const char *, const char *, struct err *) = i < 2 ? try_file : find_ending;
		if (i % 2 && !strcmp(decomposed, image))
			continue;
		path = path_leaves(image) ? NULL : find(dir, name, e);
		if (!path && base != name)
			path = find(dir, base, e);
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
	size_t twice, earlier;

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
	if (names_find_twice(
		    c->views, sizeof *c->views, offsetof(struct camera, image), c->n, &twice, &earlier, e))
		return -1;
	return twice == NAMES_NONE
		       ? 0
		       : err_set(e, ERR_FORMAT,
				 "%s: views '%.200s' and '%.200s' have one photograph, %s: give the folder that theirs are in",
				 images, c->views[earlier].name, c->views[twice].name,
				 view_base(c->views[twice].image));
}
