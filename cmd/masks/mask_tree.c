#include "cmd/masks/painting.h"

#include "base/file.h"
#include "base/mem.h"
#include "base/name.h"
#include "base/path.h"
#include "base/textfile.h"
#include "geom/views.h"

#include <dirent.h>
#include <strings.h>

struct walk {
	const char *dir;
	char *classes; /* the text of classes.txt, a line each; NULL: every name is one */
	mask_tree_put *put;
	void *to;
	size_t pictures, others, beside; /* PNGs; pictures of other kinds; those beside PNGs */
	int is_by_thing; /* the folders are things', and pictures views'; -1 while that is looked for */
};

static int is_shown(const struct dirent *d)
{
	return d->d_name[0] != '.';
}

/* Whether a line of classes.txt is this name, but for blanks around it. */
static int is_class(const char *classes, const char *name)
{
	const size_t length = strlen(name);

	for (const char *line = classes; line && *line; line += strcspn(line, "\n"), line += *line == '\n') {
		const char *from = line + strspn(line, " \t\r");
		size_t n = strcspn(from, "\n");
		while (n && strchr(" \t\r", from[n - 1]))
			n--;
		if (n == length && !memcmp(from, name, n))
			return 1;
	}
	return !classes;
}

/* CVAT and Pascal VOC have pictures of colours, one for each class, in such a folder, and others beside it.
 */
static const char classes_folder[] = "SegmentationClass";

/* A picture in a folder, of which `view` is the name as a view's. */
static int walk_picture(struct walk *w, const char *path, const char *folder, const char *view,
	const char *file, struct err *e)
{
	SCOPED char *stem = path_ends(file, ".png") ? mem_strdup(file, e) : NULL;

	if (!stem) {
		w->others += file[view_stem(file)] && w->is_by_thing >= 0;
		return path_ends(file, ".png") ? -1 : 0;
	}
	stem[strlen(stem) - 4] = 0;
	const size_t bare = view_stem(stem);
	if (!strncmp(folder, classes_folder, sizeof classes_folder - 1))
		return w->is_by_thing < 0 ? 0 : (w->pictures++, w->put(w->to, path, NULL, NULL, e));
	if (stem[bare] && !w->is_by_thing)
		return err_set(e, ERR_FORMAT,
			"%s: the mask of a photograph, as COLMAP names them, not of a thing: give such pictures by themselves, with --names",
			path);
	SCOPED char *name = name_from_file(w->is_by_thing ? folder : stem, e);
	stem[bare] = 0;
	SCOPED char *own = name ? name_to_view(stem, e) : NULL;
	if (!own)
		return -1;
	if (w->is_by_thing < 0)
		return w->put(w->to, path, view, own, e);
	if (!is_class(w->classes, name))
		return 0;
	w->pictures++;
	return w->put(w->to, path, w->is_by_thing ? own : view, name, e);
}

/* What a folder has, in order of names: their count, or -1 with *e. free() all. */
static int list(const char *folder, struct dirent ***names, struct err *e)
{
	*names = NULL;
	const int n = scandir(folder, names, is_shown, alphasort);

	return n < 0 ? err_errno(e, "%s", folder) : n;
}

static int walk_folder(struct walk *w, const char *path, const char *folder, const char *view, struct err *e)
{
	const int is_beside = !strncmp(folder, classes_folder, strlen("Segmentation")) &&
			      strcmp(folder, classes_folder) != 0;
	struct dirent **names = NULL;
	const int n = is_beside ? 0 : list(path, &names, e);
	const size_t pictures = w->pictures, others = w->others;
	int bad = n < 0;

	for (int i = 0; i < n && !bad; i++) {
		SCOPED char *picture = file_join(path, names[i]->d_name, "", e);
		bad = !picture || walk_picture(w, picture, folder, view, names[i]->d_name, e);
	}
	w->beside += w->pictures > pictures ? w->others - others : 0;
	mem_free_strings((char **)names, n < 0 ? 0 : (size_t)n);
	return bad ? -1 : 0;
}

/* The folders of a folder, each a view's, named as its photograph, perhaps with the ending, or a thing's. */
static int walk_folders(struct walk *w, struct err *e)
{
	struct dirent **names;
	const int n = list(w->dir, &names, e);
	const size_t most = n < 0 ? 0 : (size_t)n;
	SCOPED char **paths = mem_zalloc(most, sizeof *paths, "views", e),
		    **views = mem_zalloc(most, sizeof *views, "views", e);
	SCOPED const char **files = mem_zalloc(most, sizeof *files, "views", e);
	int bad = n < 0 || !paths || !views || !files;
	size_t count = 0;

	for (int i = 0; i < n && !bad; i++) {
		bad = !(paths[count] = file_join(w->dir, names[i]->d_name, "", e));
		if (!bad && file_is_dir(paths[count]))
			files[count++] = names[i]->d_name;
		else
			free(paths[count]);
	}
	bad = bad || views_name(files, count, views, w->dir, e);
	for (size_t i = 0; i < count; i++) {
		bad = bad || walk_folder(w, paths[i], files[i], views[i], e);
		mem_free_all(paths[i], views[i]);
	}
	mem_free_strings((char **)names, n < 0 ? 0 : (size_t)n);
	return bad ? -1 : 0;
}

static int read_classes(struct walk *w, struct err *e)
{
	SCOPED char *path = file_join(w->dir, "classes.txt", "", e), *text = NULL;
	size_t length;
	return !path || (file_exists(path) && (textfile_read(path, &text, &length, e) ||
						      !(w->classes = name_copy(text, e))));
}

/* How surely the folders and the pictures are named as views are: of a scene the surest, else the least sure
 * of them. */
struct order {
	const struct cameras *scene;
	size_t pictures;
	int by_view, by_thing;
};

static int begins(const char *name, const char *const *words)
{
	while (*words && strncasecmp(name, *words, strlen(*words)) != 0)
		words++;
	return *words != NULL;
}

/* Whether the scene has a view of this name. Of no known scene, from 0 on: a number, three digits in a row,
 * as photographs have that are numbered, after a photograph's word; but not what says that it is a thing's.
 */
static int is_view(const struct cameras *scene, const char *name)
{
	static const char digits[] = "0123456789",
			  *const things[] = {"obj", "inst", "mask", "thing", "label", "class", "id", "seg",
				  "track", NULL},
			  *const views[] = {"view", "frame", "im", "dsc", "photo", "cam", NULL};
	const int is_number = !name[strspn(name, digits)], is_worded = begins(name, views);

	if (scene)
		return cameras_find(scene, name) != NULL;
	if (begins(name, things))
		return 0;
	while (*name && strspn(name, digits) < 3)
		name++;
	return *name ? 2 + is_worded : is_number;
}

static int look(void *to, const char *path, const char *view, const char *name, struct err *e)
{
	struct order *o = to;
	const int by_view = is_view(o->scene, view), by_thing = is_view(o->scene, name);

	(void)path, (void)e;
	if (!o->pictures++ || (by_view < o->by_view) == !o->scene)
		o->by_view = by_view;
	if (o->pictures == 1 || (by_thing < o->by_thing) == !o->scene)
		o->by_thing = by_thing;
	return 0;
}

int mask_tree_each(const char *dir, const struct cameras *scene, mask_tree_put *put, void *to,
	const struct report *report, struct err *e)
{
	struct order order = {.scene = scene};
	struct walk w = {.dir = dir, .put = look, .to = &order, .is_by_thing = -1};
	int bad = read_classes(&w, e) || walk_folders(&w, e);

	w.is_by_thing = order.by_thing > order.by_view;
	if (!bad && !scene && order.by_view && order.by_view == order.by_thing)
		bad = err_set(e, ERR_FORMAT,
			"%s: numbered folders of numbered pictures: --undistort SCENE tells, by the scene's views, which of them are things",
			dir);
	w.put = put;
	w.to = to;
	bad = bad || walk_folders(&w, e);
	if (w.is_by_thing)
		report_warn(report, "%s: its folders are things and their pictures views, as their names say",
			dir);
	if (!bad && !w.pictures)
		bad = err_set(e, ERR_FORMAT,
			"%s: has no masks VIEW/NAME.png%s%s; give pictures of views, and labels, one by one",
			dir, w.classes ? " of the names in classes.txt" : "",
			w.others ? ", but pictures of another kind: save masks as PNG" : "");
	else if (w.beside)
		report_warn(report, "%s: %zu pictures that are no PNG are left out", dir, w.beside);
	free(w.classes);
	return bad ? -1 : 0;
}
