/* Pictures that have a colour for each thing: a mask for each colour that has a name. */
#include "base/compare.h"
#include "cmd/masks/painting.h"

#include "base/mem.h"
#include "base/name.h"
#include "base/names.h"
#include "base/path.h"
#include "formats/images/png.h"
#include "formats/records/jsonl.h"
#include "geom/views.h"

#include <math.h>

void painting_names_free(struct painting_names *names)
{
	for (size_t i = 0; i < names->n; i++)
		free(names->items[i].name);
	free(names->items);
	*names = (struct painting_names){0};
}

/* "#rrggbb" or "0" to "65535" at the beginning of a line: where it ends, or NULL. */
static char *take_colour(char *text, uint32_t *colour)
{
	const int is_hex = *text == '#';
	char *end, *digits = text + is_hex;
	const size_t n = strspn(digits, is_hex ? "0123456789abcdefABCDEF" : "0123456789");
	const unsigned long value = strtoul(digits, &end, is_hex ? 16 : 10);

	if (end != digits + n || (is_hex ? n != 6 : !n || value > 65535 || n > (value > 255 ? 5 : 3)) ||
		!strchr(" \t", *end))
		return NULL;
	*colour = is_hex ? (uint32_t)value : png_paint_number((uint32_t)value);
	return end;
}

/* The name of a colour, or NULL. */
static const struct painting_name *painting_names_find(const struct painting_names *names, uint32_t colour)
{
	for (size_t i = 0; i < names->n; i++)
		if (names->items[i].colour == colour)
			return &names->items[i];
	return NULL;
}

static int has_name(const struct painting_names *names, const char *name)
{
	for (size_t i = 0; i < names->n; i++)
		if (!strcmp(names->items[i].name, name))
			return 1;
	return 0;
}

static int add_name(struct painting_names *names, const struct jsonl *j, struct err *e)
{
	char *text = j->line + strspn(j->line, " \t"), fault[NAME_FAULT];
	uint32_t colour;
	char *name = take_colour(text, &colour);

	if (!name)
		return jsonl_err(j, e, "does not begin with #rrggbb or 0 to 65535, and a blank");
	name += strspn(name, " \t");
	for (size_t n = strlen(name); n && strchr(" \t", name[n - 1]); n--)
		name[n - 1] = 0;
	const char *reason = name_fault(name, NAME_DATA, fault);
	if (reason)
		return jsonl_err(j, e, "the name %s", reason);
	if (painting_names_find(names, colour))
		return jsonl_err(j, e, "its colour or number has a name already");
	if (has_name(names, name))
		return jsonl_err(j, e, "the name '%s' has a colour already", name);
	if (mem_grow(
		    (void **)&names->items, &names->capacity, names->n + 1, sizeof *names->items, j->path, e))
		return -1;
	names->items[names->n] = (struct painting_name){colour, mem_strdup(name, e), 0};
	return names->items[names->n].name ? (int)(names->n++, 0) : -1;
}

int painting_names_read(struct painting_names *names, const char *path, struct err *e)
{
	SCOPED_BY(jsonl_close) struct jsonl j = {0};
	int got;

	*names = (struct painting_names){0};
	if (jsonl_open(&j, path, e))
		return -1;
	while ((got = jsonl_text(&j, e)) > 0)
		if (add_name(names, &j, e)) {
			got = -1;
			break;
		}
	if (!got && !names->n)
		got = err_set(e, ERR_FORMAT, "%s: holds no names", j.path);
	return got;
}

/* A warning where more of a picture than this is of a colour without a name, not black or white. */
static const double unnamed_share = 0.001;

/* The view of a picture: its file name without the ending, and without that of the photograph, which COLMAP's
 * names of masks have before it. */
static char *view_of(const char *path, struct err *e)
{
	int length;
	const char *last = path_last(path, &length);
	SCOPED char *stem = mem_strdup(last, e);

	if (!stem)
		return NULL;
	stem[length] = 0;
	char *dot = strrchr(stem, '.');
	if (dot && dot > stem)
		*dot = 0;
	stem[view_stem(stem)] = 0;
	return name_to_view(stem, e);
}

struct picture_read {
	const char *path;
	char *view;
	int height, width;
	uint32_t *paint;
	uint8_t *mask;
};

/* The mask of a colour, if any pixel has it: its record. */
static int put_name(
	struct picture_read *p, struct painting_name *name, struct warping *w, FILE *out, struct err *e)
{
	struct mask mask = {.view = p->view, .object = name->name, .score = NAN, .visible = NAN};
	const size_t pixels = (size_t)p->height * (size_t)p->width;
	size_t covered = 0;

	for (size_t at = 0; at < pixels; at++)
		covered += p->mask[at] = p->paint[at] == name->colour;
	if (!covered)
		return 0;
	name->is_seen = 1;
	if (rle_encode(&mask.rle, p->mask, p->height, p->width, e))
		return -1;
	return painting_put(&mask, w, p->path, out, e);
}

/* Colours that cover much and have no name: a slip of the painter or of the file of names. */
static int warn_unnamed(const struct picture_read *p, const struct painting_names *names,
	const struct report *to, struct err *e)
{
	const size_t pixels = (size_t)p->height * (size_t)p->width;
	SCOPED uint32_t *sorted = mem_alloc(pixels, sizeof *sorted, p->path, e);

	if (!sorted)
		return -1;
	for (size_t at = 0; at < pixels; at++)
		sorted[at] = p->paint[at];
	qsort(sorted, pixels, sizeof *sorted, compare_u32);
	for (size_t first = 0, end; first < pixels; first = end) {
		for (end = first; end < pixels && sorted[end] == sorted[first];)
			end++;
		const double share = (double)(end - first) / (double)pixels;
		const uint32_t colour = sorted[first];
		if (share <= unnamed_share || !colour || colour == 0xffffff || colour == PNG_PAINT_NONE ||
			painting_names_find(names, colour))
			continue;
		if (colour & PNG_PAINT_NUMBER)
			report_warn(to, "%s: %u, %.1f%% of it, has no name", p->path,
				(unsigned)(colour ^ PNG_PAINT_NUMBER), 100 * share);
		else
			report_warn(to, "%s: #%06x, %.1f%% of it, has no name", p->path, (unsigned)colour,
				100 * share);
	}
	return 0;
}

int painting_put_colours(struct painting_names *names, const char *path, struct warping *w, FILE *out,
	const struct report *to, struct err *e)
{
	struct picture_read p = {.path = path};
	int bad = png_read_paint(path, &p.paint, &p.height, &p.width, e) || !(p.view = view_of(path, e)) ||
		  !(p.mask = mem_alloc((size_t)p.height, (size_t)p.width, path, e)) ||
		  warn_unnamed(&p, names, to, e);

	for (size_t i = 0; i < names->n && !bad; i++)
		bad = put_name(&p, &names->items[i], w, out, e);
	mem_free_all(p.view, p.paint, p.mask);
	return bad ? -1 : 0;
}

int painting_two_pictures(const char *earlier, const char *later, const char *view, struct err *e)
{
	return err_set(e, ERR_FORMAT,
		"%s: of view '%s', and so is %s, of another folder's picture: name pictures as their views are in the scene, or import them one by one",
		later, view, earlier);
}

int painting_check_shared(const char *const *pictures, size_t count, struct err *e)
{
	SCOPED char **views = mem_zalloc(count, sizeof *views, "views", e);
	SCOPED_BY(names_free) struct names names = {0};
	size_t earlier;
	int bad = !views;

	for (size_t i = 0; i < count && !bad; i++)
		if (painting_needs_names(pictures[i]))
			bad = !(views[i] = view_of(pictures[i], e));
	bad = bad || names_make(&names, views, sizeof *views, 0, count, e);
	const size_t twice = bad ? NAMES_NONE : names_twice(&names, &earlier);
	if (twice != NAMES_NONE)
		bad = painting_two_pictures(pictures[earlier], pictures[twice], views[twice], e);
	for (size_t i = 0; views && i < count; i++)
		free(views[i]);
	return bad ? -1 : 0;
}
