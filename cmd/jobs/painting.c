#include "cmd/jobs/painting_private.h"

#include "base/file.h"
#include "base/name.h"
#include "cmd/jobs/mask_tree.h"
#include "formats/annotations.h"
#include "formats/jsonl.h"
#include "formats/masks.h"
#include "formats/png.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

int painting_put(struct mask *mask, struct warping *w, const char *path, FILE *out, struct err *e)
{
	int bad = 0;

	if (warping_mask(w, mask->view, &mask->rle, e)) {
		if (e->code == ERR_FORMAT)
			err_prefix(e, file_name(path));
		bad = -1;
	} else {
		bad = masks_put(out, mask, e);
	}
	rle_free(&mask->rle);
	return bad;
}

/* Whether each shape has a box, in the picture that the mask is of. */
static int has_boxes(const struct annotation *a, const struct warping *w)
{
	return a->boxes && a->boxes->box_count == a->shapes && w->way == WARP_NONE;
}

/* A mask record for each label of each picture that a JSON file is of. */
static int put_labels(const struct annotations *a, const char *path, struct warping *w, FILE *out,
	size_t *count, const struct report *to, struct err *e)
{
	for (size_t i = 0; i < a->left_count; i++)
		report_warn(to, "%s: %zu %s are left out", file_name(path), a->left_out[i].n,
			a->left_out[i].kind);
	for (size_t i = 0; i < a->n; i++) {
		const struct annotation *one = &a->items[i];
		struct mask mask = {.view = one->view,
			.ref = one->ref,
			.object = one->name,
			.score = one->score,
			.visible = NAN,
			.place = has_boxes(one, w) ? one->boxes : NULL};
		if (one->shapes > 1)
			report_warn(to, "%s: %zu shapes are '%s' in view %s, and are taken as one thing",
				file_name(path), one->shapes, one->name, one->view);
		const struct rle *shown = &one->mask;
		if (!rle_area(shown))
			continue;
		++*count;
		if (rle_from_runs(&mask.rle, shown->runs, shown->n, shown->height, shown->width, e) ||
			painting_put(&mask, w, path, out, e))
			return -1;
	}
	return 0;
}

/* *count grows by the labels. */
static int put_labelled(
	const char *path, struct warping *w, FILE *out, size_t *count, const struct report *to, struct err *e)
{
	struct annotations a;
	const int bad = annotations_read(&a, path, e) || put_labels(&a, path, w, out, count, to, e);

	annotations_free(&a);
	return bad ? -1 : 0;
}

/* *count grows by the records. */
static int put_records(const char *path, struct warping *w, FILE *out, size_t *count, struct err *e)
{
	struct mask mask;
	struct jsonl j;
	int got;

	if (jsonl_open(&j, path, e))
		return -1;
	while ((got = masks_next(&j, &mask, e)) > 0) {
		const int bad = warping_mask(w, mask.view, &mask.rle, e);
		if (bad && e->code == ERR_FORMAT) {
			const struct err inner = *e;
			jsonl_err(&j, e, "%s", inner.message);
		}
		if (w->way != WARP_NONE) {
			mask_place_free(mask.place);
			mask.place = NULL;
		}
		got = bad || masks_put(out, &mask, e) ? -1 : 1;
		mask_free(&mask);
		if (got < 0)
			break;
		++*count;
	}
	jsonl_close(&j);
	return got;
}

static int has_ending(const char *path, const char *ending)
{
	const size_t n = strlen(path), m = strlen(ending);

	return n > m && !strcasecmp(path + n - m, ending);
}

static int is_labelled(const char *path)
{
	return has_ending(path, ".json");
}

static int is_records(const char *path)
{
	return has_ending(path, ".jsonl");
}

int painting_needs_names(const char *path)
{
	return !is_labelled(path) && !is_records(path) && !file_is_dir(path);
}

struct tree {
	struct warping *w;
	FILE *out;
	size_t *count;
};

static int put_tree_mask(void *to, const char *path, const char *view, const char *name, struct err *e)
{
	struct tree *t = to;
	struct mask mask = {.view = view, .object = name, .score = NAN, .visible = NAN};
	char fault[NAME_FAULT];
	const char *reason = name_fault(name, NAME_DATA, fault);
	uint8_t *pixels;
	int height, width;

	if (reason)
		return err_set(e, ERR_FORMAT, "%s: the name %s", path, reason);
	if (png_read_mask(path, &pixels, &height, &width, e))
		return -1;
	int bad = rle_encode(&mask.rle, pixels, height, width, e);
	free(pixels);
	if (bad)
		return -1;
	if (!rle_area(&mask.rle)) {
		rle_free(&mask.rle);
		return 0;
	}
	++*t->count;
	return painting_put(&mask, t->w, path, t->out, e);
}

static int put_any(struct painting_names *names, const char *path, struct warping *w, FILE *out,
	size_t *count, const struct report *to, struct err *e)
{
	struct tree tree = {w, out, count};

	if (is_labelled(path))
		return put_labelled(path, w, out, count, to, e);
	if (is_records(path))
		return put_records(path, w, out, count, e);
	if (file_is_dir(path))
		return mask_tree_each(path, put_tree_mask, &tree, e);
	return painting_put_colours(names, path, w, out, to, e);
}

static int put_all(struct painting_names *names, const char *const *pictures, size_t count, struct warping *w,
	FILE *out, const struct report *to, struct err *e)
{
	size_t seen = 0, labels = 0;

	if (painting_warn_shared(pictures, count, to, e))
		return -1;
	for (size_t i = 0; i < count; i++)
		if (put_any(names, pictures[i], w, out, &labels, to, e))
			return -1;
	for (size_t i = 0; i < names->n; i++)
		seen += names->items[i].is_seen != 0;
	for (size_t i = 0; i < names->n && seen; i++)
		if (!names->items[i].is_seen)
			report_warn(to, "'%s' is in no picture", names->items[i].name);
	if (seen || labels)
		return 0;
	return err_set(e, ERR_FORMAT,
		names->n ? "%s: has none of the colours that have names" : "%s: has no label with an area",
		pictures[0]);
}

int painting_write(struct painting_names *names, const char *const *pictures, size_t count, struct warping *w,
	const char *path, const struct report *to, struct err *e)
{
	struct file_out out;

	if (file_out_open(&out, path, e))
		return -1;
	return file_out_end(&out, put_all(names, pictures, count, w, out.stream, to, e), e);
}
