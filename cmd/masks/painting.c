#include "cmd/masks/painting.h"

#include "base/file.h"
#include "base/mem.h"
#include "base/name.h"
#include "base/path.h"
#include "formats/records/jsonl.h"
#include "formats/images/png.h"

#include <math.h>
#include <strings.h>

int painting_put(struct painting_names *names, struct mask *mask, struct warping *w, const char *path,
	FILE *out, struct err *e)
{
	const int is_nothing = name_is_nothing(mask->object);
	int bad = 0;

	names->nothing += (size_t)is_nothing;
	names->written += (size_t)!is_nothing;
	if (!is_nothing && warping_mask(w, mask->view, &mask->rle, e)) {
		if (e->code == ERR_FORMAT)
			err_prefix(e, file_name(path));
		bad = -1;
	} else if (!is_nothing) {
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

/* A picture that a file of labels was of. */
struct labelled {
	char *view, *picture, *file;
};

/* What all inputs share. */
struct putting {
	struct painting_names *names;
	struct warping *w;
	FILE *out;
	const struct report *to;
	struct labelled *labelled;
	size_t labelled_count, labelled_room;
};

/* A mask record for each label of each picture that a JSON file is of. */
static int put_labels(struct putting *p, const struct annotations *a, const char *path, struct err *e)
{
	for (size_t i = 0; i < a->left_count; i++)
		report_warn(p->to, "%s: %zu %s are left out", file_name(path), a->left_out[i].n,
			a->left_out[i].kind);
	for (size_t i = 0; i < a->n; i++) {
		const struct annotation *one = &a->items[i];
		struct mask mask = {.view = one->view,
			.ref = one->ref,
			.object = one->name,
			.score = one->score,
			.visible = NAN,
			.place = has_boxes(one, p->w) ? one->boxes : NULL};
		if (one->shapes > 1 && !name_is_nothing(one->name))
			report_warn(p->to, "%s: %zu shapes are '%s' in view %s, and are taken as one thing",
				file_name(path), one->shapes, one->name, one->view);
		const struct rle *shown = &one->mask;
		if (!rle_area(shown))
			continue;
		if (rle_from_runs(&mask.rle, shown->runs, shown->n, shown->height, shown->width, e) ||
			painting_put(p->names, &mask, p->w, path, p->out, e))
			return -1;
	}
	return 0;
}

/* Pictures that are called the same in different folders would be of one view. */
static int check_picture(struct putting *p, struct annotations *a, const char *path, struct err *e)
{
	if (!a->picture)
		return 0;
	for (size_t i = 0; i < p->labelled_count; i++) {
		const struct labelled *one = &p->labelled[i];
		const int same = strcmp(one->view, a->view) != 0 || path_is_same(one->picture, a->picture, e);
		if (same <= 0)
			return same < 0 ? -1 : painting_two_pictures(one->file, path, a->view, e);
		if (!strcmp(one->view, a->view))
			report_warn(p->to,
				"%s: of the picture of %s, '%s': is that right, or was the file renamed?",
				path, one->file, a->picture);
	}
	if (mem_grow((void **)&p->labelled, &p->labelled_room, p->labelled_count + 1, sizeof *p->labelled,
		    "pictures", e))
		return -1;
	p->labelled[p->labelled_count++] = (struct labelled){a->view, a->picture, mem_strdup(path, e)};
	a->view = a->picture = NULL;
	return p->labelled[p->labelled_count - 1].file ? 0 : -1;
}

static int put_labelled(struct putting *p, const char *path, struct err *e)
{
	SCOPED_BY(annotations_free) struct annotations a = {0};

	return annotations_read(&a, path, e) || check_picture(p, &a, path, e) || painting_layers(&a, e) ||
	       put_labels(p, &a, path, e);
}

/* *count grows by the records. */
static int put_records(const char *path, struct warping *w, FILE *out, size_t *count, struct err *e)
{
	struct mask mask;
	SCOPED_BY(jsonl_close) struct jsonl j = {0};
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
	return got;
}

int painting_needs_names(const char *path)
{
	return !path_ends(path, ".json") && !path_ends(path, ".jsonl") && !file_is_dir(path);
}

/* A picture of colours in CVAT's folder SegmentationClass, beside which labelmap.txt says what they mean. */
static int put_classes(struct putting *p, const char *path, struct err *e)
{
	SCOPED char *folder = p->names->n ? NULL : file_dir(path, e),
		    *map = folder ? file_join(folder, "../labelmap.txt", "", e) : NULL;

	if (!p->names->n && (!map || !file_exists(map)))
		return map ? err_set(e, ERR_FORMAT,
				     "%s: its colours need --names NAMES, or CVAT's labelmap.txt beside its folder",
				     path)
			   : -1;
	return (map && painting_names_read(p->names, map, e)) ||
	       painting_put_colours(p->names, path, p->w, p->out, p->to, e);
}

static int put_tree_mask(void *to, const char *path, const char *view, const char *name, struct err *e)
{
	struct putting *p = to;
	struct mask mask = {.view = view, .object = name, .score = NAN, .visible = NAN};
	char fault[NAME_FAULT];
	const char *reason = name ? name_fault(name, NAME_DATA, fault) : NULL;
	SCOPED uint8_t *pixels = NULL;
	int height, width;

	if (!name)
		return put_classes(p, path, e);
	if (reason)
		return err_set(e, ERR_FORMAT, "%s: the name %s", path, reason);
	if (png_read_mask(path, &pixels, &height, &width, e) ||
		rle_encode(&mask.rle, pixels, height, width, e))
		return -1;
	if (rle_area(&mask.rle))
		return painting_put(p->names, &mask, p->w, path, p->out, e);
	rle_free(&mask.rle);
	return 0;
}

static int put_any(struct putting *p, const char *path, struct err *e)
{
	if (path_ends(path, ".json"))
		return put_labelled(p, path, e);
	if (path_ends(path, ".jsonl"))
		return put_records(path, p->w, p->out, &p->names->written, e);
	if (file_is_dir(path))
		return mask_tree_each(
			path, p->w->way == WARP_NONE ? NULL : &p->w->cameras, put_tree_mask, p, p->to, e);
	return painting_put_colours(p->names, path, p->w, p->out, p->to, e);
}

static int put_all(struct putting *p, const char *const *pictures, size_t count, struct err *e)
{
	const struct painting_names *names = p->names;
	size_t seen = 0;

	if (painting_check_shared(pictures, count, e))
		return -1;
	for (size_t i = 0; i < count; i++)
		if (put_any(p, pictures[i], e))
			return -1;
	for (size_t i = 0; i < names->n; i++)
		seen += names->items[i].is_seen != 0;
	for (size_t i = 0; i < names->n && seen; i++)
		if (!names->items[i].is_seen && !name_is_nothing(names->items[i].name))
			report_warn(p->to, "'%s' is in no picture", names->items[i].name);
	if (names->nothing)
		report_warn(p->to,
			"%zu masks are left out, whose names say that they are of no thing, as 'background' does",
			names->nothing);
	if (names->written)
		return 0;
	return err_set(e, ERR_FORMAT,
		names->n ? "%s: has none of the colours that have names" : "%s: has no label with an area",
		pictures[0]);
}

int painting_write(struct painting_names *names, const char *const *pictures, size_t count, struct warping *w,
	const char *path, const struct report *to, struct err *e)
{
	struct putting p = {.names = names, .w = w, .to = to};
	struct file_out out;

	if (file_out_open(&out, path, e))
		return -1;
	p.out = out.stream;
	const int bad = put_all(&p, pictures, count, e);
	for (size_t i = 0; i < p.labelled_count; i++)
		mem_free_all(p.labelled[i].view, p.labelled[i].picture, p.labelled[i].file);
	free(p.labelled);
	return file_out_end(&out, bad, e);
}
