#include "cmd/jobs/mask_tree.h"

#include "base/file.h"
#include "base/mem.h"
#include "base/name.h"
#include "base/path.h"
#include "base/textfile.h"

#include <dirent.h>
#include <stdlib.h>
#include <string.h>

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
	char *stem = path_ends(file, ".png") ? mem_strdup(file, e) : NULL;

	if (!path_ends(file, ".png"))
		return 0;
	if (stem)
		stem[strlen(stem) - 4] = 0;
	char *name = stem ? name_from_file(stem, e) : NULL,
	     *path = name ? file_join(folder, file, "", e) : NULL;
	int bad = !path;
	if (path && is_class(w->classes, name)) {
		w->pictures++;
		bad = w->put(w->to, path, view, name, e);
	}
	free(stem);
	free(name);
	free(path);
	return bad;
}

/* Calls `each` for what is in a folder, in order of names. */
static int each_entry(struct walk *w, const char *folder, const char *view,
	int (*each)(struct walk *w, const char *folder, const char *view, const char *file, struct err *e),
	struct err *e)
{
	struct dirent **names = NULL;
	const int n = scandir(folder, &names, is_shown, alphasort);
	int bad = n < 0 ? err_errno(e, "%s", folder) : 0;

	for (int i = 0; i < n; i++) {
		bad = bad || each(w, folder, view, names[i]->d_name, e);
		free(names[i]);
	}
	free(names);
	return bad ? -1 : 0;
}

static int walk_view(struct walk *w, const char *folder, const char *none, const char *file, struct err *e)
{
	char *path = file_join(folder, file, "", e), *view = path ? name_to_view(file, e) : NULL;
	const int bad = !view || (file_is_dir(path) && each_entry(w, path, view, walk_picture, e));

	(void)none;
	free(path);
	free(view);
	return bad;
}

static int read_classes(struct walk *w, struct err *e)
{
	char *path = file_join(w->dir, "classes.txt", "", e), *text = NULL;
	size_t length;
	const int bad = !path || (file_exists(path) && (textfile_read(path, &text, &length, e) ||
							       !(w->classes = name_copy(text, e))));

	free(path);
	free(text);
	return bad;
}

int mask_tree_each(const char *dir, mask_tree_put *put, void *to, struct err *e)
{
	struct walk w = {.dir = dir, .put = put, .to = to};
	int bad = read_classes(&w, e) || each_entry(&w, dir, NULL, walk_view, e);

	if (!bad && !w.pictures)
		bad = err_set(e, ERR_FORMAT, "%s: has no masks VIEW/NAME.png%s", dir,
			w.classes ? " of the names in classes.txt" : "");
	free(w.classes);
	return bad ? -1 : 0;
}
