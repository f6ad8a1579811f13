#include "cmd/masks/painting.h"

#include "base/file.h"
#include "base/mem.h"
#include "base/name.h"
#include "base/path.h"
#include "base/textfile.h"
#include "geom/views.h"

#include <dirent.h>

struct walk {
	const char *dir;
	char *classes; /* the text of classes.txt, a line each; NULL: every name is one */
	mask_tree_put *put;
	void *to;
	size_t pictures;
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

static int walk_picture(struct walk *w, const char *folder, const char *view, const char *file, struct err *e)
{
	SCOPED char *stem = path_ends(file, ".png") ? mem_strdup(file, e) : NULL;

	if (!stem)
		return path_ends(file, ".png") ? -1 : 0;
	stem[strlen(stem) - 4] = 0;
	if (stem[view_stem(stem)])
		return err_set(e, ERR_FORMAT,
			"%s/%s: the mask of a photograph, as COLMAP names them, not of a thing: give such pictures by themselves, with --names",
			folder, file);
	SCOPED char *name = name_from_file(stem, e);
	SCOPED char *path = name ? file_join(folder, file, "", e) : NULL;
	if (!path)
		return -1;
	if (!is_class(w->classes, name))
		return 0;
	w->pictures++;
	return w->put(w->to, path, view, name, e);
}

/* What a folder has, in order of names: their count, or -1 with *e. free() all. */
static int list(const char *folder, struct dirent ***names, struct err *e)
{
	*names = NULL;
	const int n = scandir(folder, names, is_shown, alphasort);

	return n < 0 ? err_errno(e, "%s", folder) : n;
}

static int walk_view(struct walk *w, const char *folder, const char *view, struct err *e)
{
	struct dirent **names;
	const int n = list(folder, &names, e);
	int bad = n < 0;

	for (int i = 0; i < n && !bad; i++)
		bad = walk_picture(w, folder, view, names[i]->d_name, e);
	mem_free_strings((char **)names, n < 0 ? 0 : (size_t)n);
	return bad ? -1 : 0;
}

/* The folders of a folder, each a view's: named as its photograph, perhaps with the ending. */
static int walk_views(struct walk *w, struct err *e)
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
		bad = bad || walk_view(w, paths[i], views[i], e);
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

int mask_tree_each(const char *dir, mask_tree_put *put, void *to, struct err *e)
{
	struct walk w = {.dir = dir, .put = put, .to = to};
	int bad = read_classes(&w, e) || walk_views(&w, e);

	if (!bad && !w.pictures)
		bad = err_set(e, ERR_FORMAT,
			"%s: has no masks VIEW/NAME.png%s; give pictures of views, and labels, one by one",
			dir, w.classes ? " of the names in classes.txt" : "");
	free(w.classes);
	return bad ? -1 : 0;
}
