#include "cmd/masks/exporting.h"

#include "base/file.h"
#include "base/mem.h"
#include "base/name.h"
#include "cmd/masks/pictures.h"
#include "cmd/import/warping.h"
#include "formats/records/jsonl.h"
#include "formats/records/masks.h"
#include "formats/images/png.h"
#include "formats/scene/scene.h"
#include "geom/views.h"

#include <math.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

static const char *png_name(const struct mask *m)
{
	return m->ref ? m->ref : m->object;
}

struct named {
	const char *name;
};

/* Numbers different names in the order in which they first come: number (n), and the first item of each. */
static int number(size_t *count, size_t *numbers, const struct mask **first, const struct masks *masks,
	const char *(*name_of)(const struct mask *m), struct err *e)
{
	SCOPED struct named *named = mem_alloc(masks->n, sizeof *named, "masks", e);
	struct names names;

	for (size_t i = 0; named && i < masks->n; i++)
		named[i].name = name_of(&masks->items[i]);
	int bad =
		!named || names_make(&names, named, sizeof *named, offsetof(struct named, name), masks->n, e);
	if (!bad) {
		for (size_t i = 0; i < masks->n; i++) {
			const size_t place = names_find(&names, named[i].name);
			numbers[i] = place == i ? *count : numbers[place];
			if (place == i)
				first[(*count)++] = &masks->items[i];
		}
		names_free(&names);
	}
	return bad ? -1 : 0;
}

static const char *view_of(const struct mask *m)
{
	return m->view;
}

static int check_sizes(const struct exporting *x, struct err *e)
{
	for (size_t i = 0; i < x->masks.n; i++) {
		const struct rle *own = &x->masks.items[i].rle,
				 *first = &x->first_of_view[x->view_of[i]]->rle;
		if (own->width != first->width || own->height != first->height)
			return err_set(e, ERR_FORMAT, "%s: view '%s' has masks of %dx%d and of %dx%d",
				x->path, x->masks.items[i].view, first->width, first->height, own->width,
				own->height);
	}
	return 0;
}

static int read_cameras(struct exporting *x, const char *scene, struct err *e)
{
	SCOPED char *path = file_join(scene, "cameras.json", "", e);
	return !path || scene_read_cameras_file(&x->cameras, path, e) ? -1 : 0;
}

static int distort_masks(struct exporting *x, const char *scene, struct err *e)
{
	struct warping w;
	int bad = warping_open(&w, WARP_TO_PHOTOGRAPH, scene, e);

	for (size_t i = 0; i < x->masks.n && !bad; i++) {
		bad = warping_mask(&w, x->masks.items[i].view, &x->masks.items[i].rle, e);
		if (bad && e->code == ERR_FORMAT)
			err_prefix(e, x->path);
	}
	warping_free(&w);
	return bad;
}

int exporting_read(struct exporting *x, const char *masks, const char *scene, int distort, struct err *e)
{
	x->path = file_name(masks);
	SCOPED long *lines = NULL;
	const int bad = masks_read_lines(&x->masks, &lines, masks, e) ||
			(scene && read_cameras(x, scene, e)) ||
			(distort ? distort_masks(x, scene, e)
				 : masks_views(&x->masks, lines, masks, &x->cameras, NULL, NULL, e));

	if (bad)
		return -1;
	const size_t n = x->masks.n;
	x->view_of = mem_alloc(n, sizeof *x->view_of, x->path, e);
	x->object_of = mem_alloc(n, sizeof *x->object_of, x->path, e);
	x->first_of_view = mem_alloc(n, sizeof *x->first_of_view, x->path, e);
	x->first_of_object = mem_alloc(n, sizeof *x->first_of_object, x->path, e);
	if (!x->view_of || !x->object_of || !x->first_of_view || !x->first_of_object)
		return -1;
	return number(&x->views, x->view_of, x->first_of_view, &x->masks, view_of, e) ||
			       number(&x->objects, x->object_of, x->first_of_object, &x->masks, mask_object,
				       e) ||
			       check_sizes(x, e)
		       ? -1
		       : 0;
}

void exporting_free(struct exporting *x)
{
	free(x->view_of);
	free(x->object_of);
	free(x->first_of_view);
	free(x->first_of_object);
	masks_free(&x->masks);
	cameras_free(&x->cameras);
}

/* The part of a photograph's path that gives the view its name, so that mask-import finds it: the file, or as
 * many folders as tell it from another's. The file where none does. NULL with *e. */
static const char *file_of(const char *image, const char *view, struct err *e)
{
	const char *from = view_base(image);

	for (;;) {
		SCOPED char *stem = mem_strdup(from, e), *whole = stem ? name_to_view(from, e) : NULL;
		if (stem)
			stem[view_stem(stem)] = 0;
		SCOPED char *name = whole ? name_to_view(stem, e) : NULL;
		const int is_out = !name, is_it = name && (!strcmp(name, view) || !strcmp(whole, view));
		if (is_out || is_it)
			return is_out ? NULL : from;
		if (from == image)
			return view_base(image);
		do
			from--;
		while (from > image && from[-1] != '/');
	}
}

/* The photograph of a view, as the scene has it; else the view's name as a PNG. */
static int put_file_name(const struct exporting *x, FILE *out, const char *view, struct err *e)
{
	char name[4096];
	const char *image = NULL;

	for (size_t v = 0; v < x->cameras.n && !image; v++)
		if (!strcmp(x->cameras.views[v].name, view))
			image = x->cameras.views[v].image;
	if (image && !(image = file_of(image, view, e)))
		return -1;
	if (!image)
		snprintf(name, sizeof name, "%s.png", view);
	return jsonl_put_string(out, ",\"file_name\":", image ? image : name, e);
}

static int put_images(const struct exporting *x, FILE *out, struct err *e)
{
	fputs("{\"images\":[", out);
	for (size_t v = 0; v < x->views; v++) {
		const struct mask *m = x->first_of_view[v];
		fprintf(out, "%s{\"id\":%zu,\"width\":%d,\"height\":%d", v ? "," : "", v + 1, m->rle.width,
			m->rle.height);
		if (put_file_name(x, out, m->view, e))
			return -1;
		fputc('}', out);
	}
	fputs("],\"categories\":[", out);
	for (size_t o = 0; o < x->objects; o++) {
		fprintf(out, "%s{\"id\":%zu", o ? "," : "", o + 1);
		if (jsonl_put_string(out, ",\"name\":", mask_object(x->first_of_object[o]), e))
			return -1;
		fputc('}', out);
	}
	fputs("],\"annotations\":[", out);
	return 0;
}

/* left, top, width, height; 0 of an empty mask. */
static void put_bounds(FILE *out, const struct rle *r)
{
	size_t low[2] = {SIZE_MAX, SIZE_MAX}, high[2] = {0}, at = 0;
	const size_t height = (size_t)r->height;

	for (size_t k = 0; k < r->n; at += r->runs[k++]) {
		if (k % 2 == 0 || !r->runs[k])
			continue;
		const size_t last = at + r->runs[k] - 1, is_long = at / height != last / height;
		const size_t from[2] = {at / height, is_long ? 0 : at % height},
			     to[2] = {last / height, is_long ? height - 1 : last % height};
		for (int d = 0; d < 2; d++) {
			low[d] = from[d] < low[d] ? from[d] : low[d];
			high[d] = to[d] + 1 > high[d] ? to[d] + 1 : high[d];
		}
	}
	if (!high[0])
		low[0] = low[1] = 0;
	fprintf(out, ",\"bbox\":[%zu,%zu,%zu,%zu]", low[0], low[1], high[0] - low[0], high[1] - low[1]);
}

static int put_annotation(const struct exporting *x, size_t i, FILE *out, struct err *e)
{
	const struct mask *m = &x->masks.items[i];
	SCOPED char *counts = rle_to_string(&m->rle, e);
	int bad = !counts;

	if (!bad) {
		fprintf(out, "%s{\"id\":%zu,\"image_id\":%zu,\"category_id\":%zu,\"iscrowd\":0,\"area\":%zu",
			i ? "," : "", i + 1, x->view_of[i] + 1, x->object_of[i] + 1, rle_area(&m->rle));
		put_bounds(out, &m->rle);
		if (!isnan(m->score))
			fprintf(out, ",\"score\":%.6g", m->score);
		bad = m->ref && jsonl_put_string(out, ",\"ref\":", m->ref, e);
	}
	if (!bad) {
		fprintf(out, ",\"segmentation\":{\"size\":[%d,%d]", m->rle.height, m->rle.width);
		bad = jsonl_put_string(out, ",\"counts\":", counts, e);
		fputs("}}", out);
	}
	return bad ? -1 : 0;
}

int exporting_put_coco(const struct exporting *x, FILE *out, struct err *e)
{
	if (put_images(x, out, e))
		return -1;
	for (size_t i = 0; i < x->masks.n; i++)
		if (put_annotation(x, i, out, e))
			return -1;
	fputs("]}\n", out);
	return ferror(out) ? err_errno(e, "write") : 0;
}

/* Whether two masks would be one file: names may have no line's end. */
static int check_files(const struct exporting *x, struct err *e)
{
	struct text_name {
		char *name;
	} *files = mem_zalloc(x->masks.n, sizeof *files, x->path, e);
	struct names names;
	int bad = !files;
	size_t earlier;

	for (size_t i = 0; i < x->masks.n && !bad; i++) {
		const struct mask *m = &x->masks.items[i];
		bad = !(files[i].name = file_join(m->view, "\n", png_name(m), e));
	}
	bad = bad ||
	      names_make(&names, files, sizeof *files, offsetof(struct text_name, name), x->masks.n, e);
	if (!bad) {
		const size_t twice = names_twice(&names, &earlier);
		if (twice != NAMES_NONE)
			bad = err_set(e, ERR_FORMAT,
				"%s: view '%s' has two masks of '%s', which would be one PNG", x->path,
				x->masks.items[twice].view, png_name(&x->masks.items[twice]));
		names_free(&names);
	}
	for (size_t i = 0; files && i < x->masks.n; i++)
		free(files[i].name);
	free(files);
	return bad ? -1 : 0;
}

int exporting_write_pngs(const struct exporting *x, const char *dir, struct err *e)
{
	const struct pictures to = {.masks = dir};
	int bad = check_files(x, e);

	for (size_t i = 0; i < x->masks.n && !bad; i++) {
		const struct mask *m = &x->masks.items[i];
		if (picture_check_size(x->path, png_name(m), (size_t)m->rle.width, (size_t)m->rle.height, e))
			return -1;
		SCOPED uint8_t *pixels = mem_alloc((size_t)m->rle.height, (size_t)m->rle.width, x->path, e);
		const struct picture one = {.view = m->view,
			.ref = png_name(m),
			.height = m->rle.height,
			.width = m->rle.width,
			.mask = pixels};
		if (pixels)
			rle_decode(&m->rle, pixels);
		bad = !pixels || pictures_put(&to, &one, e);
	}
	return bad;
}
