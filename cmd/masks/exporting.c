#include "cmd/masks/exporting.h"

#include "base/file.h"
#include "base/jsontext.h"
#include "base/mem.h"
#include "base/name.h"
#include "cmd/masks/pictures.h"
#include "cmd/import/warping.h"
#include "formats/records/masks.h"
#include "formats/images/png.h"
#include "formats/scene/scene.h"
#include "geom/views.h"

#include <math.h>

static const char *png_name(const struct mask *m)
{
	return m->ref ? m->ref : m->object;
}

/* Numbers different names in the order in which they first come: number (n), and the first item of each. */
static int number(size_t *count, size_t *numbers, const struct mask **first, const struct masks *masks,
	const char *(*name_of)(const struct mask *m), struct err *e)
{
	SCOPED const char **named = mem_alloc(masks->n, sizeof *named, "masks", e);
	SCOPED_BY(names_free) struct names names = {0};

	for (size_t i = 0; named && i < masks->n; i++)
		named[i] = name_of(&masks->items[i]);
	if (!named || names_make(&names, named, sizeof *named, 0, masks->n, e))
		return -1;
	for (size_t i = 0; i < masks->n; i++) {
		const size_t place = names_find(&names, named[i]);
		numbers[i] = place == i ? *count : numbers[place];
		if (place == i)
			first[(*count)++] = &masks->items[i];
	}
	return 0;
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

static int distort_masks(struct exporting *x, const char *scene, struct err *e)
{
	SCOPED_BY(warping_free) struct warping w = {0};
	int bad = warping_open(&w, WARP_TO_PHOTOGRAPH, scene, e);

	for (size_t i = 0; i < x->masks.n && !bad; i++) {
		bad = warping_mask(&w, x->masks.items[i].view, &x->masks.items[i].rle, e);
		if (bad && e->code == ERR_FORMAT)
			err_prefix(e, x->path);
	}
	return bad;
}

int exporting_read(struct exporting *x, const char *masks, const char *scene, int distort, struct err *e)
{
	x->path = file_name(masks);
	SCOPED long *lines = NULL;
	if (masks_read_lines(&x->masks, &lines, masks, e) ||
		(scene && scene_read_cameras(&x->cameras, scene, e)) ||
		(distort ? distort_masks(x, scene, e)
			 : masks_views(&x->masks, lines, masks, &x->cameras, NULL, NULL, e)))
		return -1;
	const size_t n = x->masks.n;
	x->view_of = mem_alloc(n, sizeof *x->view_of, x->path, e);
	x->object_of = mem_alloc(n, sizeof *x->object_of, x->path, e);
	x->first_of_view = mem_alloc(n, sizeof *x->first_of_view, x->path, e);
	x->first_of_object = mem_alloc(n, sizeof *x->first_of_object, x->path, e);
	if (!x->view_of || !x->object_of || !x->first_of_view || !x->first_of_object)
		return -1;
	return -(number(&x->views, x->view_of, x->first_of_view, &x->masks, view_of, e) ||
		 number(&x->objects, x->object_of, x->first_of_object, &x->masks, mask_object, e) ||
		 check_sizes(x, e));
}

void exporting_free(struct exporting *x)
{
	mem_free_all(x->view_of, x->object_of, x->first_of_view, x->first_of_object);
	masks_free(&x->masks);
	cameras_free(&x->cameras);
}

/* The photograph of a view, as the scene has it; else the view's name as a PNG. */
static int put_file_name(const struct exporting *x, struct jsontext *to, const char *view, struct err *e)
{
	char name[4096];
	const struct camera *camera = cameras_find(&x->cameras, view);
	const char *image = camera ? camera->image : NULL, *part = name;

	snprintf(name, sizeof name, "%s.png", view);
	const int found = image ? view_part(image, view, &part, e) : 0;
	jsontext_string(to, "file_name", image && !found ? view_base(image) : part);
	return found < 0 ? -1 : 0;
}

/* left, top, width, height; 0 of an empty mask. */
static void put_bounds(struct jsontext *to, const struct rle *r)
{
	double b[4] = {0, 0, -1, -1};
	char text[96];

	mask_place_bounds(r, b);
	snprintf(text, sizeof text, "[%.0f,%.0f,%.0f,%.0f]", b[0], b[1], b[2] - b[0] + 1, b[3] - b[1] + 1);
	jsontext_raw(to, "bbox", text);
}

static int put_annotation(const struct exporting *x, size_t i, struct jsontext *to, struct err *e)
{
	const struct mask *m = &x->masks.items[i];
	SCOPED char *counts = rle_to_string(&m->rle, e);
	char score[32];

	if (!counts)
		return -1;
	jsontext_open(to, NULL, '{');
	jsontext_number(to, "id", (double)(i + 1));
	jsontext_number(to, "image_id", (double)(x->view_of[i] + 1));
	jsontext_number(to, "category_id", (double)(x->object_of[i] + 1));
	jsontext_number(to, "iscrowd", 0);
	jsontext_number(to, "area", (double)rle_area(&m->rle));
	put_bounds(to, &m->rle);
	snprintf(score, sizeof score, "%.6g", m->score);
	if (!isnan(m->score))
		jsontext_raw(to, "score", score);
	if (m->ref)
		jsontext_string(to, "ref", m->ref);
	jsontext_open(to, "segmentation", '{');
	jsontext_open(to, "size", '[');
	jsontext_number(to, NULL, m->rle.height);
	jsontext_number(to, NULL, m->rle.width);
	jsontext_close(to, ']');
	jsontext_string(to, "counts", counts);
	jsontext_close(to, '}');
	jsontext_close(to, '}');
	return 0;
}

int exporting_put_coco(const struct exporting *x, FILE *out, struct err *e)
{
	struct jsontext j = {.out = out}, *to = &j;

	jsontext_open(to, NULL, '{');
	jsontext_open(to, "images", '[');
	for (size_t v = 0; v < x->views; v++) {
		const struct mask *m = x->first_of_view[v];
		jsontext_open(to, NULL, '{');
		jsontext_number(to, "id", (double)(v + 1));
		jsontext_number(to, "width", m->rle.width);
		jsontext_number(to, "height", m->rle.height);
		if (put_file_name(x, to, m->view, e))
			return -1;
		jsontext_close(to, '}');
	}
	jsontext_close(to, ']');
	jsontext_open(to, "categories", '[');
	for (size_t o = 0; o < x->objects; o++) {
		jsontext_open(to, NULL, '{');
		jsontext_number(to, "id", (double)(o + 1));
		jsontext_string(to, "name", mask_object(x->first_of_object[o]));
		jsontext_close(to, '}');
	}
	jsontext_close(to, ']');
	jsontext_open(to, "annotations", '[');
	for (size_t i = 0; i < x->masks.n; i++)
		if (put_annotation(x, i, to, e))
			return -1;
	fputs("]}\n", out);
	return ferror(out) ? err_errno(e, "write") : 0;
}

/* Whether two masks would be one file: names may have no line's end. */
static int check_files(const struct exporting *x, struct err *e)
{
	const size_t n = x->masks.n;
	char **files = mem_zalloc(n, sizeof *files, x->path, e);
	size_t twice = NAMES_NONE, earlier;
	int bad = !files;

	for (size_t i = 0; i < n && !bad; i++)
		bad = !(files[i] = file_join(x->masks.items[i].view, "\n", png_name(&x->masks.items[i]), e));
	bad = bad || names_find_twice(files, sizeof *files, 0, n, &twice, &earlier, e);
	if (!bad && twice != NAMES_NONE)
		bad = err_set(e, ERR_FORMAT, "%s: view '%s' has two masks of '%s', which would be one PNG",
			x->path, x->masks.items[twice].view, png_name(&x->masks.items[twice]));
	mem_free_strings(files, n);
	return bad;
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
