#include "cmd/synth/benchmark.h"

#include "base/mem.h"
#include "formats/records/boxes.h"
#include "formats/cameras/colmap.h"
#include "formats/records/masks.h"
#include "formats/splats/ply.h"
#include "formats/images/png.h"
#include "synth/outline.h"

#include <math.h>

static int open_in(struct file_out *out, const char *dir, const char *name, struct err *e)
{
	SCOPED char *path = file_join(dir, name, "", e);

	return !path || file_out_open(out, path, e) ? -1 : 0;
}

int synth_put_file(const struct synth_folder *f, const char *name, void (*put)(FILE *out, const void *folder),
	struct err *e)
{
	SCOPED char *path = file_join(f->dir, name, "", e);

	return path ? file_out_put(path, put, f, e) : -1;
}

void synth_put_sentence(FILE *out, const struct synth_folder *f, const char *ref, uint64_t objects,
	const char *text, const char *kind)
{
	const char *comma = "";

	fprintf(out, "{\"ref\":\"%s\"", ref);
	for (int i = 0; i < f->scene->object_count; i++)
		if (objects == (uint64_t)1 << i)
			fprintf(out, ",\"object\":\"%s\"", f->scene->objects[i].name);
	fputs(",\"objects\":[", out);
	for (int i = 0; i < f->scene->object_count; i++)
		if (objects >> i & 1) {
			fprintf(out, "%s\"%s\"", comma, f->scene->objects[i].name);
			comma = ",";
		}
	fprintf(out, "],\"text\":\"%s\",\"split\":\"test\",\"kind\":\"%s\"", text, kind);
}

/* Makes the folder of the photographs and tells each camera the name of its own. */
static int name_photographs(const struct synth_folder *f, struct err *e)
{
	SCOPED char *images = file_join(f->dir, "images", "", e);

	if (!images)
		return -1;
	if (file_make_dir(images, e))
		return err_prefix(e, images);
	for (size_t i = 0; i < f->scene->cameras.n; i++) {
		struct camera *c = &f->scene->cameras.views[i];
		if (!(c->image = file_join(images, c->name, ".png", e)))
			return -1;
	}
	return 0;
}

static int write_model(const struct synth_folder *f, struct err *e)
{
	static const double offset[3] = {0};
	SCOPED char *ply = file_join(f->dir, "point_cloud.ply", "", e);
	SCOPED char *sparse = file_join(f->dir, "sparse/0", "", e);
	int bad = -1;

	if (ply && sparse && !ply_write(&f->scene->splats, offset, ply, e))
		bad = colmap_write_text(&f->scene->cameras, sparse, e);
	return bad;
}

/* Texts, names and refs are made of letters, digits, commas, hyphens and spaces: no escapes in JSON. */
static void put_sentences(FILE *out, const void *folder)
{
	const struct synth_folder *f = folder;

	for (size_t i = 0; i < f->sentences->n; i++) {
		const struct synth_sentence *s = &f->sentences->items[i];
		fprintf(out, "{\"ref\":\"%s\",\"object\":\"%s\",\"text\":\"%s\",\"split\":\"%s\"}\n", s->ref,
			f->scene->objects[s->object].name, s->text,
			s->split == SPLIT_TEST ? "test" : "train");
	}
}

static void put_boxes(FILE *out, const void *folder)
{
	const struct synth_folder *f = folder;

	for (int i = 0; i < f->scene->object_count; i++) {
		struct synth_object *o = &f->scene->objects[i];
		struct box_record r = {.object = o->name, .score = NAN};
		synth_object_boxes(o, &r.aligned, &r.turned);
		boxes_put(out, &r, NULL);
	}
}

/* One line, as --test-views takes it. */
static void put_test_views(FILE *out, const void *folder)
{
	const struct cameras *c = &((const struct synth_folder *)folder)->scene->cameras;
	const char *comma = "";

	for (size_t i = 0; i < c->n; i++)
		if (c->views[i].split == SPLIT_TEST) {
			fprintf(out, "%s%s", comma, c->views[i].name);
			comma = ",";
		}
	fputc('\n', out);
}

int synth_folder_begin(struct synth_folder *f, struct err *e)
{
	return -(name_photographs(f, e) || write_model(f, e) ||
		 synth_put_file(f, "sentences.jsonl", put_sentences, e) ||
		 synth_put_file(f, "unseen.jsonl", synth_unseen_put, e) ||
		 synth_put_file(f, "parses.unseen.jsonl", synth_unseen_put_parses, e) ||
		 synth_put_file(f, "test-views", put_test_views, e) ||
		 synth_put_file(f, "boxes.jsonl", put_boxes, e) ||
		 open_in(&f->candidates, f->dir, "candidates.jsonl", e) ||
		 open_in(&f->test_candidates, f->dir, "candidates.test.jsonl", e) ||
		 open_in(&f->truth, f->dir, "truth.jsonl", e) ||
		 open_in(&f->whole, f->dir, "whole.jsonl", e));
}

static int write_photograph(
	const struct synth_folder *f, const struct camera *c, const struct render_view *view, struct err *e)
{
	static const float background[3] = {0.6f, 0.62f, 0.65f};
	size_t values = 3 * (size_t)c->width * (size_t)c->height;
	SCOPED float *rgb = mem_alloc(values, sizeof *rgb, "photograph", e);
	SCOPED uint8_t *bytes = mem_alloc(values, 1, "photograph", e);
	int bad = !rgb || !bytes || render_colors(view, &f->scene->splats, c, background, rgb, e) ? -1 : 0;

	if (!bad) {
		for (size_t i = 0; i < values; i++)
			bytes[i] = (uint8_t)lrintf(255 * rgb[i]);
		bad = png_write(c->image, bytes, c->height, c->width, 3, e);
	}
	return bad;
}

static int put_masks(
	const struct synth_folder *f, FILE *to, const struct camera *c, const uint8_t *masks, struct err *e)
{
	size_t pixels = (size_t)c->width * (size_t)c->height;
	struct mask_place when = {.has_time = 1, .time = c->time};
	int bad = 0;

	for (int i = 0; i < f->scene->object_count && !bad; i++) {
		struct mask m = {.view = c->name,
			.object = f->scene->objects[i].name,
			.score = NAN,
			.visible = NAN,
			.place = c->has_time ? &when : NULL};
		bad = rle_encode(&m.rle, masks + (size_t)i * pixels, c->height, c->width, e) ||
		      masks_put(to, &m, e);
		rle_free(&m.rle);
	}
	return bad ? -1 : 0;
}

/* What the detector finds: for the training sentences in a training view, for all in a test view. */
static int put_candidates(
	struct synth_folder *f, int number, const struct camera *c, const uint8_t *masks, struct err *e)
{
	SCOPED_BY(masks_free) struct masks found = {0};
	const int is_test = c->split == SPLIT_TEST;
	FILE *to = is_test ? f->test_candidates.stream : f->candidates.stream;
	int bad = synth_detect(&found, f->detector, number, c->name,
		is_test ? SYNTH_SENTENCES : SYNTH_TRAIN_SENTENCES, masks, c->height, c->width, e);

	for (size_t i = 0; i < found.n && !bad; i++)
		bad = masks_put(to, &found.items[i], e);
	return bad;
}

static void count_visible(
	struct synth_folder *f, const struct camera *c, const uint8_t *visible, const uint8_t *whole)
{
	size_t pixels = (size_t)c->width * (size_t)c->height;

	for (int i = 0; i < f->scene->object_count; i++)
		synth_statistics_see(f->statistics, c->split,
			synth_outline_area(visible + (size_t)i * pixels, pixels),
			synth_outline_area(whole + (size_t)i * pixels, pixels));
}

int synth_folder_view(struct synth_folder *f, int number, struct err *e)
{
	const struct camera *c = &f->scene->cameras.views[number];
	size_t pixels = (size_t)c->width * (size_t)c->height, n = (size_t)f->scene->object_count;
	SCOPED uint8_t *visible = mem_alloc(n, pixels, "truth", e), *whole = mem_alloc(n, pixels, "truth", e);

	if (f->moves->times)
		synth_moves_set(f->moves, (int)lrint(c->time * (f->moves->times - 1)));
	SCOPED_BY(render_release)
	struct render_view *view = visible && whole ? render_prepare(&f->scene->splats, c, e) : NULL;
	int bad = !view || write_photograph(f, c, view, e) ||
		  synth_truth_visible(f->scene, view, pixels, visible, e) ||
		  synth_truth_whole(f->scene, c, whole, e) || put_masks(f, f->truth.stream, c, visible, e) ||
		  put_masks(f, f->whole.stream, c, whole, e) || put_candidates(f, number, c, visible, e);

	if (!bad)
		count_visible(f, c, visible, whole);
	return bad ? -1 : 0;
}

static void put_quantiles(FILE *to, const char *name, const double *quantiles)
{
	fprintf(to, ",\"%s\":[", name);
	for (int i = 0; i < SYNTH_QUANTILES; i++)
		fprintf(to, "%s%.4g", i ? "," : "", quantiles[i]);
	fputc(']', to);
}

static void put_visibility(FILE *to, const char *name, const struct synth_visibility *v)
{
	fprintf(to, "\"%s\":{\"pairs\":%ld,\"outside\":%ld", name, v->pairs, v->outside);
	for (int i = 0; i < SYNTH_BANDS; i++)
		fprintf(to, ",\"%s\":%.4f", synth_bands[i],
			v->pairs ? (double)v->bands[i] / (double)v->pairs : 0);
	fputc('}', to);
}

static void put_statistics(FILE *out, const void *folder)
{
	const struct synth_folder *f = folder;
	const struct synth_statistics *s = f->statistics;
	const char *comma = "";

	fprintf(out,
		"{\"scene\":\"%s\",\"objects\":%d,\"alike\":%d,\"alike_groups\":%d,\"stacked\":%d,"
		"\"sentences\":{\"train\":%d,\"test\":%d},\"words\":{\"train\":%.2f,\"test\":%.2f},"
		"\"relations\":{",
		f->scene->preset->name, s->objects, s->alike, s->alike_groups, s->stacked,
		s->sentences[SPLIT_TRAIN], s->sentences[SPLIT_TEST], s->words[SPLIT_TRAIN],
		s->words[SPLIT_TEST]);
	const struct synth_wordings *w = &f->sentences->wordings;
	for (int i = 0; i < w->n; i++) {
		if (w->rows[i].list != SYNTH_RELATIONS)
			continue;
		fprintf(out, "%s\"%s\":%.4f", comma, w->rows[i].text,
			synth_statistics_share(f->sentences, &w->rows[i]));
		comma = ",";
	}
	fprintf(out, "},\"views\":{\"train\":%d,\"test\":%d},\"gaussians\":%zu", s->views[SPLIT_TRAIN],
		s->views[SPLIT_TEST], s->gaussians);
	put_quantiles(out, "opacity", s->opacity);
	put_quantiles(out, "aspect", s->aspect);
	put_quantiles(out, "size", s->size);
	fputs(",\"visibility\":{", out);
	put_visibility(out, "train", &s->visibility[SPLIT_TRAIN]);
	fputc(',', out);
	put_visibility(out, "test", &s->visibility[SPLIT_TEST]);
	fputs("}}\n", out);
}

int synth_folder_end(struct synth_folder *f, struct err *e)
{
	return -(file_out_commit(&f->candidates, e) || file_out_commit(&f->test_candidates, e) ||
		 file_out_commit(&f->truth, e) || file_out_commit(&f->whole, e) ||
		 synth_put_file(f, "statistics.json", put_statistics, e));
}

void synth_folder_abort(struct synth_folder *f)
{
	file_out_abort(&f->candidates);
	file_out_abort(&f->test_candidates);
	file_out_abort(&f->truth);
	file_out_abort(&f->whole);
}
