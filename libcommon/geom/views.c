#include "geom/views.h"

#include "base/mem.h"
#include "base/name.h"

#include <math.h>
#include <strings.h>

/* How much of the image's path a name keeps; the last keeps '/' and '_' apart, so that different paths have
 * different names. */
enum level { FILE_STEM, PATH_STEM, WHOLE_PATH, ESCAPED_PATH };

struct entry {
	struct camera view;
	enum level level;
	int is_shared; /* another view has this name */
	size_t place;
};

const char *view_fault(const struct camera *c)
{
	if (c->width < 1 || c->width > VIEW_SIZE_MAX || c->height < 1 || c->height > VIEW_SIZE_MAX)
		return "its size is not within 1 to 65536";
	if (!(c->fx > 0 && c->fy > 0) || !isfinite(c->fx) || !isfinite(c->fy))
		return "its focal length is not positive";
	if (!isfinite(c->cx) || !isfinite(c->cy))
		return "its principal point is not finite";
	/* pictures of more than an icon's size, on which less than a pixel is no lens's */
	if (c->width >= 64 && (c->fx < 0.02 * c->width || (fabs(c->cx) <= 1 && fabs(c->cy) <= 1)))
		return "its focal length or principal point is that of a picture of size 1, or none: both are in pixels";
	if (!camera_is_rigid(c))
		return "its pose is not a rotation and a translation: is it mirrored, scaled or rounded to few digits?";
	return NULL;
}

int view_set_size(struct camera *c, double width, double height)
{
	if (!(width >= 1 && width <= VIEW_SIZE_MAX && height >= 1 && height <= VIEW_SIZE_MAX) ||
		width != floor(width) || height != floor(height))
		return -1;
	c->width = (int)width;
	c->height = (int)height;
	return 0;
}

/* Where the last folder begins of a path that ends before `to` in a slash: what ".." after it takes back.
 * NULL where there is none, or where it is ".." too. */
static char *up_from(char *image, char *to)
{
	char *last = to - 1;

	if (to - image < 2)
		return NULL;
	for (; last > image && last[-1] != '/';)
		last--;
	return !strncmp(last, "../", 3) ? NULL : last;
}

char *view_image(const char *path, struct err *e)
{
	char *image = name_copy(path, e), *to = image;

	for (char *p = image; p && *p; p++)
		*p = (char)(*p == '\\' ? '/' : *p);
	const char *from = image;
	if (from && ((*from | 32) >= 'a' && (*from | 32) <= 'z') && from[1] == ':' && from[2] == '/')
		from += 2;
	while (from && *from) {
		const size_t n = strcspn(from, "/");
		const int is_up = n == 2 && from[0] == '.' && from[1] == '.' && from[n];
		char *last = is_up ? up_from(image, to) : NULL;
		const int is_nothing = (n == 1 && *from == '.' && from[n]) || last;
		to = last ? last : to;
		if (!is_nothing) {
			memmove(to, from, n);
			to += n;
		}
		from += n;
		if (*from && !is_nothing && (to == image || to[-1] != '/'))
			*to++ = '/';
		from += *from == '/';
	}
	if (image)
		*to = 0;
	return image;
}

const char *view_base(const char *image)
{
	const char *slash = strrchr(image, '/');

	return slash ? slash + 1 : image;
}

size_t view_stem(const char *image)
{
	static const char *const known[] = {
		".jpg", ".jpeg", ".png", ".bmp", ".tif", ".tiff", ".webp", ".exr"};
	const char *dot = strrchr(view_base(image), '.');

	for (size_t i = 0; dot && i < sizeof known / sizeof *known; i++)
		if (!strcasecmp(dot, known[i]))
			return (size_t)(dot - image);
	return strlen(image);
}

static int set_name(struct camera *c, enum level level, struct err *e)
{
	const char *from = level == FILE_STEM ? view_base(c->image) : c->image;
	size_t len = level >= WHOLE_PATH ? strlen(c->image) : view_stem(c->image);
	const char *end = c->image + len;

	from += from < end && *from == '/';
	len = (size_t)(end - from);
	SCOPED char *part = mem_alloc(len + 1, 1, "view name", e);
	if (!part)
		return -1;
	memcpy(part, from, len);
	part[len] = 0;
	free(c->name);
	c->name = level == ESCAPED_PATH ? name_to_file(part, e) : name_to_view(part, e);
	return c->name ? 0 : -1;
}

static int by_name(const void *a, const void *b)
{
	const struct entry *x = a, *y = b;
	int order = strcmp(x->view.name, y->view.name);

	return order ? order : strcmp(x->view.image, y->view.image);
}

/* Sorts, and lengthens each shared name by one level: 1 where any was, 0 where all are unique, -1 with *e. */
static int lengthen_shared(struct entry *entries, size_t n, const char *path, struct err *e)
{
	int was_shared = 0;

	qsort(entries, n, sizeof *entries, by_name);
	for (size_t i = 0; i + 1 < n; i++)
		if (!strcmp(entries[i].view.name, entries[i + 1].view.name)) {
			if (entries[i].level == ESCAPED_PATH && entries[i + 1].level == ESCAPED_PATH)
				return err_file(e, path, "two views are of '%s': take one out",
					entries[i].view.image);
			entries[i].is_shared = entries[i + 1].is_shared = was_shared = 1;
		}
	for (size_t i = 0; i < n; i++) {
		struct entry *one = &entries[i];
		if (one->is_shared && one->level < ESCAPED_PATH && set_name(&one->view, ++one->level, e))
			return -1;
		one->is_shared = 0;
	}
	return was_shared;
}

static int name_entries(struct entry *entries, size_t n, const char *path, struct err *e)
{
	int state = 1;

	for (size_t i = 0; i < n; i++) {
		if (set_name(&entries[i].view, FILE_STEM, e))
			return -1;
		if (!*entries[i].view.name)
			return err_file(e, path, "image '%s' gives no view name", entries[i].view.image);
	}
	while (state > 0)
		state = lengthen_shared(entries, n, path, e);
	return state;
}

int views_finish(struct cameras *c, const char *path, struct err *e)
{
	SCOPED struct entry *entries = mem_zalloc(c->n, sizeof *entries, "views", e);

	if (!entries)
		return -1;
	int bad = 0;
	for (size_t i = 0; i < c->n; i++) {
		entries[i].view = c->views[i];
		const char *fault = view_fault(&c->views[i]);
		if (fault && !bad)
			bad = err_file(e, path, "view '%s': %s", c->views[i].image, fault);
	}
	bad = bad || name_entries(entries, c->n, path, e);
	for (size_t i = 0; i < c->n; i++) {
		struct camera *v = &c->views[i];
		*v = entries[i].view;
		const int lacks_folders =
			!bad && entries[i].level == FILE_STEM && view_base(v->image) != v->image;
		bad = bad || (lacks_folders && !(v->source = mem_strdup(v->image, e)));
	}
	return bad ? -1 : 0;
}

int view_part(const char *image, const char *view, const char **part, struct err *e)
{
	const char *from = view_base(image);

	for (;;) {
		SCOPED char *stem = mem_strdup(from, e), *whole = stem ? name_to_view(from, e) : NULL;
		if (stem)
			stem[view_stem(stem)] = 0;
		SCOPED char *name = whole ? name_to_view(stem, e) : NULL;
		*part = from;
		if (!name || !strcmp(name, view) || !strcmp(whole, view))
			return name ? 1 : -1;
		if (from == image)
			return 0;
		do
			from--;
		while (from > image && from[-1] != '/');
	}
}

int views_name(const char *const *images, size_t n, char **names, const char *path, struct err *e)
{
	SCOPED struct entry *entries = mem_zalloc(n, sizeof *entries, "views", e);

	if (!entries)
		return -1;
	for (size_t i = 0; i < n; i++)
		entries[i] = (struct entry){.view.image = (char *)(size_t)images[i], .place = i};
	const int bad = name_entries(entries, n, path, e);
	for (size_t i = 0; i < n; i++)
		if (bad)
			free(entries[i].view.name);
		else
			names[entries[i].place] = entries[i].view.name;
	return bad ? -1 : 0;
}
