#include "cmd/masks/pictures.h"

#include "base/file.h"
#include "base/mem.h"
#include "base/name.h"
#include "formats/arrays/npy.h"
#include "formats/images/png.h"
#include "mask/overlay.h"

#include <math.h>

/* DIR/VIEW/REF + suffix, with the folder made. free() it; NULL with *e set. */
static char *make_path(const char *dir, const struct picture *one, const char *suffix, struct err *e)
{
	SCOPED char *folder = file_join(dir, one->view, "", e);
	SCOPED char *name = name_to_file(one->ref, e);

	return folder && name && !file_make_dir(folder, e) ? file_join(folder, name, suffix, e) : NULL;
}

static int put_mask(const char *path, const struct picture *one, struct err *e)
{
	const size_t pixels = (size_t)one->width * (size_t)one->height;
	SCOPED uint8_t *grey = mem_alloc(pixels, 1, path, e);

	if (!grey)
		return -1;
	for (size_t p = 0; p < pixels; p++)
		grey[p] = one->mask[p] ? 255 : 0;
	return png_write(path, grey, one->height, one->width, 1, e);
}

static int put_numbers(const char *path, const struct picture *one, struct err *e)
{
	return npy_write(path, one->image, (const size_t[]){(size_t)one->height, (size_t)one->width}, 2, e);
}

static int put_sigmoid(const char *path, const struct picture *one, struct err *e)
{
	const size_t pixels = (size_t)one->width * (size_t)one->height;
	SCOPED uint16_t *grey = mem_alloc(pixels, sizeof *grey, path, e);

	if (!grey)
		return -1;
	for (size_t p = 0; p < pixels; p++)
		grey[p] = (uint16_t)lrintf(65535 / (1 + expf(-one->image[p])));
	return png_write16(path, grey, one->height, one->width, e);
}

int picture_overlay(const char *path, const struct picture *one, struct err *e)
{
	const size_t bytes = 3 * (size_t)one->width * (size_t)one->height;
	const int line = caption_height(one->width), height = one->height + 2 * line;
	SCOPED uint8_t *copy = mem_alloc((size_t)height, 3 * (size_t)one->width, path, e);

	if (!copy)
		return -1;
	for (size_t i = 0; i < bytes; i++)
		copy[i] = (uint8_t)lrintf(255 * one->rgb[i]);
	overlay_draw(copy, one->mask, one->height, one->width);
	for (int k = 0; k < 2; k++)
		caption_draw(copy, one->width, one->height + k * line, one->words[k]);
	return png_write(path, copy, height, one->width, 3, e);
}

int pictures_put(const struct pictures *p, const struct picture *one, struct err *e)
{
	const struct {
		const char *dir, *suffix;
		int (*put)(const char *path, const struct picture *one, struct err *e);
	} kinds[] = {{p->masks, ".png", put_mask},
		{p->responses, p->is_npy ? ".npy" : ".png", p->is_npy ? put_numbers : put_sigmoid},
		{p->overlays, ".png", picture_overlay}};

	for (size_t i = 0; i < sizeof kinds / sizeof *kinds; i++) {
		if (!kinds[i].dir)
			continue;
		SCOPED char *path = make_path(kinds[i].dir, one, kinds[i].suffix, e);
		int bad = path ? kinds[i].put(path, one, e) : -1;
		if (bad)
			return -1;
	}
	return 0;
}
