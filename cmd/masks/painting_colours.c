/* Pictures that have a colour for each thing: a mask for each colour that has a name. */
#include "base/compare.h"
#include "cmd/masks/painting.h"

#include "base/mem.h"
#include "base/name.h"
#include "base/names.h"
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

/* What may be between a colour and its name, or the parts of a colour. */
static const char separators[] = " \t,;:=";

/* "#rrggbb", "R,G,B" or "0" to "65535" at the beginning of a line: where the name begins, or NULL. */
static char *take_colour(char *text, uint32_t *colour)
{
	const int is_hex = *text == '#';
	const char *digits = is_hex ? "0123456789abcdefABCDEF" : "0123456789";
	unsigned long parts[3];
	char *ends[3];
	int n = 0;

	for (char *at = text + is_hex; n < (is_hex ? 1 : 3);
		at = ends[n] + strspn(ends[n], separators), n++) {
		const size_t length = strspn(at, digits);
		ends[n] = at + length;
		if (!length || length > 6 || !at[length] || !strchr(separators, at[length]))
			break;
		parts[n] = strtoul(at, NULL, is_hex ? 16 : 10);
	}
	if (n == 2) /* a number, and a name that begins with one */
		n = 1;
	if (!n || (is_hex	   ? ends[0] != text + 7
			  : n == 1 ? parts[0] > 65535
				   : (parts[0] | parts[1] | parts[2]) > 255))
		return NULL;
	*colour = n == 3   ? (uint32_t)(parts[0] << 16 | parts[1] << 8 | parts[2])
		  : is_hex ? (uint32_t)parts[0]
			   : png_paint_number((uint32_t)parts[0]);
	return ends[n - 1] + strspn(ends[n - 1], separators);
}

/* The name of a colour, or NULL. */
static const struct painting_name *painting_names_find(const struct painting_names *names, uint32_t colour)
{
	for (size_t i = 0; i < names->n; i++)
		if (names->items[i].colour == colour)
			return &names->items[i];
	return NULL;
}

static int add_name(struct painting_names *names, const struct jsonl *j, struct err *e)
{
	char fault[NAME_FAULT];
	uint32_t colour;

	for (char *at = j->line; *at; at++) /* quotes, straight and curled */
		if (*at == '"')
			*at = ' ';
		else if (!strncmp(at, "\xe2\x80\x9c", 3) || !strncmp(at, "\xe2\x80\x9d", 3))
			at = memset(at, ' ', 3);
	char *text = name_trim(j->line);
	if (!*text || (*text == '#' && strchr("# \t", text[1])))
		return 0; /* a comment */
	char *name = take_colour(text, &colour), *colon = name ? NULL : strchr(text, ':');
	if (colon && take_colour(colon + 1, &colour)) { /* CVAT's NAME:R,G,B:PARTS:ACTIONS */
		*colon = 0;
		name = text;
	}
	if (!name)
		return jsonl_err(j, e,
			"does not begin with #rrggbb, R,G,B or 0 to 65535, and a blank or comma before the name");
	const char *reason = name_fault(name, NAME_DATA, fault);
	if (reason)
		return jsonl_err(j, e, "the name %s", reason);
	if (painting_names_find(names, colour))
		return jsonl_err(j, e, "its colour or number has a name already");
	for (size_t i = 0; i < names->n; i++)
		if (!strcmp(names->items[i].name, name))
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
	SCOPED char *stem = mem_strdup(view_base(path), e);

	if (!stem)
		return NULL;
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
static int put_name(struct picture_read *p, struct painting_names *names, size_t i, struct warping *w,
	FILE *out, struct err *e)
{
	struct painting_name *name = &names->items[i];
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
	return painting_put(names, &mask, w, p->path, out, e);
}

/* Colours that differ by at most this in each channel are near; so few near ones are labels without names. */
enum { NEAR = 24, HALF = 128, FEW = 24 };

/* A picture that was saved with loss is of nothing but such colours, to this share, as a photograph is not.
 */
static const double lossy_share = 0.8;

/* The nearest colour that has a name, black or white, where one is near enough; else none. */
static uint32_t nearest(const struct painting_names *names, uint32_t colour, int limit)
{
	uint32_t found = PNG_PAINT_NONE;

	for (size_t i = 0; i < names->n + 2 && colour < PNG_PAINT_NUMBER; i++) {
		const uint32_t other = i < names->n ? names->items[i].colour : i == names->n ? 0 : 0xffffff;
		int most = 0;
		for (int k = 0; k < 24; k += 8) {
			const int d = abs((int)(other >> k & 255) - (int)(colour >> k & 255));
			most = d > most ? d : most;
		}
		if (most < limit && other < PNG_PAINT_NUMBER) {
			found = other;
			limit = most;
		}
	}
	return found;
}

/* Makes each pixel of a picture that was saved with loss one of the nearest colour. Else what covers much and
 * has no name is a slip of the painter or of the file of names, and names between others at edges are an
 * error. */
static int check_colours(
	struct picture_read *p, const struct painting_names *names, const struct report *to, struct err *e)
{
	const size_t pixels = (size_t)p->height * (size_t)p->width;
	SCOPED uint32_t *sorted = mem_alloc(pixels, sizeof *sorted, p->path, e);
	size_t covered = 0, moved = 0, colours = 0, greys = 0, numbers = 0;

	if (!sorted)
		return -1;
	memcpy(sorted, p->paint, pixels * sizeof *sorted);
	qsort(sorted, pixels, sizeof *sorted, compare_u32);
	for (size_t i = 0; i < names->n; i++) {
		const uint32_t colour = names->items[i].colour;
		greys += !colour || colour == 0xffffff;
		numbers += colour && colour < 0xffffff && colour == 0x010101 * (colour & 255);
	}
	for (size_t first = 0, end; first < pixels; first = end) {
		for (end = first; end < pixels && sorted[end] == sorted[first];)
			end++;
		const uint32_t near = nearest(names, sorted[first], NEAR + 1);
		const int is_moved = near && near != PNG_PAINT_NONE && near != sorted[first];
		covered += near != PNG_PAINT_NONE ? end - first : 0;
		moved += is_moved ? end - first : 0;
		colours += is_moved;
	}
	const int is_grey = greys == names->n; /* black and white alone have names */
	if (!numbers && (is_grey || colours > FEW) && (double)covered >= lossy_share * (double)pixels &&
		(double)moved > unnamed_share * (double)pixels) {
		for (size_t i = 0; i < pixels; i++)
			p->paint[i] = nearest(names, p->paint[i], is_grey ? HALF + 1 : NEAR + 1);
		report_warn(to,
			"%s: %zu colours near those that have names, as of a JPEG or a soft brush: each pixel is taken for the nearest; save paintings without loss",
			p->path, colours);
		return 0;
	}
	for (size_t first = 0, end; first < pixels; first = end) {
		for (end = first; end < pixels && sorted[end] == sorted[first];)
			end++;
		const double share = (double)(end - first) / (double)pixels;
		const uint32_t colour = sorted[first];
		if (share > unnamed_share && colour && colour != 0xffffff && colour != PNG_PAINT_NONE &&
			!painting_names_find(names, colour))
			report_warn(to,
				colour & PNG_PAINT_NUMBER ? "%s: %u, %.1f%% of it, has no name"
							  : "%s: #%06x, %.1f%% of it, has no name",
				p->path, (unsigned)(colour & (PNG_PAINT_NUMBER - 1)), 100 * share);
	}
	for (size_t i = 0; i < pixels; i++)
		p->mask[i] = painting_names_find(names, p->paint[i]) != NULL;
	return png_check_edges(p->path, p->paint, p->mask, p->height, p->width, 0, e);
}

int painting_put_colours(struct painting_names *names, const char *path, struct warping *w, FILE *out,
	const struct report *to, struct err *e)
{
	struct picture_read p = {.path = path};
	int bad = png_read_paint(path, &p.paint, &p.height, &p.width, e) || !(p.view = view_of(path, e)) ||
		  !(p.mask = mem_alloc((size_t)p.height, (size_t)p.width, path, e)) ||
		  check_colours(&p, names, to, e);

	for (size_t i = 0; i < names->n && !bad; i++)
		bad = put_name(&p, names, i, w, out, e);
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
	char **views = mem_zalloc(count, sizeof *views, "views", e);
	size_t twice = NAMES_NONE, earlier;
	int bad = !views;

	for (size_t i = 0; i < count && !bad; i++)
		if (painting_needs_names(pictures[i]))
			bad = !(views[i] = view_of(pictures[i], e));
	bad = bad || names_find_twice(views, sizeof *views, 0, count, &twice, &earlier, e);
	if (!bad && twice != NAMES_NONE)
		bad = painting_two_pictures(pictures[earlier], pictures[twice], views[twice], e);
	mem_free_strings(views, count);
	return bad ? -1 : 0;
}
