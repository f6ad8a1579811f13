#include "cmd/jobs/check.h"

#include "base/file.h"
#include "base/mem.h"
#include "formats/camerafile.h"
#include "cmd/jobs/check_records.h"
#include "formats/colmap.h"
#include "formats/json.h"
#include "formats/jsonl.h"
#include "formats/lifted.h"
#include "formats/model.h"
#include "formats/npy.h"
#include "formats/parser_weights.h"
#include "formats/ply.h"
#include "formats/png.h"
#include "formats/scene.h"
#include "formats/text.h"
#include "formats/weights.h"

#include <dirent.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static void add_splats(struct check *c, const struct splats *s)
{
	check_add(c, "gaussians", (long long)s->n);
	check_add(c, "harmonics", s->sh_coefficients);
}

/* The views and, where they have one size, that. */
static void add_views(struct check *c, const struct cameras *views)
{
	size_t test = 0, same = 0;

	for (size_t i = 0; i < views->n; i++) {
		test += views->views[i].split == SPLIT_TEST;
		same += views->views[i].width == views->views[0].width &&
			views->views[i].height == views->views[0].height;
	}
	if (views->n && same == views->n) {
		c->width = views->views[0].width;
		c->height = views->views[0].height;
	}
	check_add(c, "training views", (long long)(views->n - test));
	check_add(c, "test views", (long long)test);
}

static int check_scene(struct check *c, const char *path, struct err *e)
{
	struct scene s;

	if (scene_read(&s, path, e))
		return -1;
	c->kind = "scene";
	c->scene = s.fingerprint;
	add_splats(c, &s.splats);
	add_views(c, &s.cameras);
	scene_free(&s);
	return 0;
}

static int check_splats(struct check *c, const char *path, struct err *e)
{
	struct scene s = {0};

	if (scene_read_splats(&s, path, e))
		return -1;
	c->scene = s.fingerprint;
	add_splats(c, &s.splats);
	scene_free(&s);
	return 0;
}

static int check_scene_cameras(struct check *c, const char *path, struct err *e)
{
	struct cameras views;

	if (scene_read_cameras_file(&views, path, e))
		return -1;
	c->kind = "scene cameras";
	add_views(c, &views);
	cameras_free(&views);
	return 0;
}

static int check_weights(struct check *c, const char *path, struct err *e)
{
	struct weights w;

	if (weights_open_file(&w, path, e))
		return -1;
	c->precision = w.is_packed ? "packed" : precision_name(w.precision);
	c->width = w.width;
	c->height = w.height;
	c->scene = w.scene;
	c->camera = w.camera;
	check_add(c, "weights", (long long)w.indptr[(int64_t)w.width * w.height]);
	check_add(c, "gaussians of the scene", (long long)w.gaussians);
	weights_close(&w);
	return 0;
}

static int check_text(struct check *c, const char *path, struct err *e)
{
	struct text t;

	if (text_read(&t, path, e))
		return -1;
	check_add(c, "sentences", (long long)t.n);
	check_add(c, "words", (long long)t.offsets[t.n]);
	check_add(c, "columns", t.width);
	c->encoder = t.encoder;
	text_free(&t);
	return 0;
}

static int check_model(struct check *c, const char *path, struct err *e)
{
	struct model m;

	if (model_read(&m, path, e))
		return -1;
	c->precision = precision_name(m.precision);
	check_add(c, "features", (long long)m.n);
	check_add(c, "columns", m.layout.feature_width);
	check_add(c, "gaussians of the scene", (long long)m.scene_gaussians);
	check_add(c, "parameters", (long long)m.layout.count);
	c->scene = m.origin.scene;
	c->encoder = m.origin.encoder;
	model_free(&m);
	return 0;
}

static int check_lifted(struct check *c, const char *path, struct err *e)
{
	struct lifted l;
	struct origin origin;

	if (lifted_read(&l, &origin, path, e))
		return -1;
	c->scene = origin.scene;
	c->encoder = origin.encoder;
	check_add(c, "objects", (long long)l.objects);
	check_add(c, "shares", (long long)l.indptr[l.objects]);
	check_add(c, "sentences", (long long)l.sentences);
	check_add(c, "words", (long long)l.offsets[l.sentences]);
	check_add(c, "columns", l.width);
	check_add(c, "gaussians of the scene", (long long)l.gaussians);
	lifted_free(&l);
	return 0;
}

static int check_ply(struct check *c, const char *path, struct err *e)
{
	struct splats s;
	struct ply_report report;
	double offset[3];

	if (ply_read(&s, offset, &report, path, e))
		return -1;
	c->kind = "3DGS ply";
	add_splats(c, &s);
	if (report.read > s.n)
		check_add(c, "unusable gaussians", (long long)(report.read - s.n));
	free(report.dropped);
	splats_free(&s);
	return 0;
}

static int check_npy(struct check *c, const char *path, struct err *e)
{
	struct npy a;

	if (npy_read(&a, path, e))
		return -1;
	c->kind = "npy";
	check_add(c, "dimensions", a.dims);
	check_add(c, "values", (long long)a.count);
	npy_free(&a);
	return 0;
}

static int check_parser(struct check *c, const char *path, struct err *e)
{
	struct parser_weights w;

	if (parser_weights_read(&w, path, e))
		return -1;
	check_add(c, "parameters", (long long)w.count);
	parser_weights_free(&w);
	return 0;
}

/* Reading starts again at the beginning; only stdin keeps its place between readers. */
static int start_again(const char *path, struct err *e)
{
	if (strcmp(path, "-"))
		return 0;
	clearerr(stdin);
	return fseek(stdin, 0, SEEK_SET) ? err_errno(e, "stdin") : 0;
}

/* Ours by their own readers, all others as a list of tensors. */
static int check_safetensors(struct check *c, const char *path, struct err *e)
{
	static const struct {
		const char *format;
		int (*check)(struct check *c, const char *path, struct err *e);
	} ours[] = {
		{"refer.splats", check_splats},
		{"refer.text", check_text},
		{"refer.weights", check_weights},
		{"refer.model", check_model},
		{"refer.lifted", check_lifted},
		{"refer.parser", check_parser},
	};

	if (safetensors_open(&c->listing, path, e))
		return -1;
	const char *format = safetensors_meta(&c->listing, "format");
	for (size_t i = 0; format && i < sizeof ours / sizeof *ours; i++)
		if (!strcmp(format, ours[i].format)) {
			safetensors_close(&c->listing);
			c->kind = ours[i].format;
			return start_again(path, e) || ours[i].check(c, path, e) ? -1 : 0;
		}
	c->kind = "safetensors";
	check_add(c, "tensors", (long long)c->listing.n);
	return 0;
}

static int check_image(struct check *c, const char *path, struct err *e)
{
	uint8_t *rgb;

	if (image_read_rgb(path, &rgb, &c->height, &c->width, e))
		return -1;
	free(rgb);
	c->kind = "image";
	return 0;
}

static int check_cameras(struct check *c, const char *path, const char *kind, struct err *e)
{
	struct cameras views;

	if (camerafile_read(&views, path, e))
		return -1;
	c->kind = kind;
	add_views(c, &views);
	cameras_free(&views);
	return 0;
}

/* Where the first line is a whole record, it says what all are; else the file may be one object of many
 * lines. */
static int check_objects(struct check *c, const char *path, struct err *e)
{
	struct jsonl j;
	struct err ignored;
	cJSON *first = NULL, *whole = NULL;

	if (jsonl_open(&j, path, e))
		return -1;
	int got = jsonl_next(&j, &first, e);
	int is_sentence = cJSON_HasObjectItem(first, "text"),
	    is_frames = cJSON_HasObjectItem(first, "frames");
	int is_mask = cJSON_HasObjectItem(first, "segmentation") || cJSON_HasObjectItem(first, "path");
	int is_box = cJSON_HasObjectItem(first, "oriented");
	int is_parse = cJSON_IsObject(cJSON_GetObjectItemCaseSensitive(first, "target"));
	if (got == 1 && !is_sentence && !is_parse && !is_mask && !is_frames && !is_box)
		got = jsonl_err(
			&j, e, "neither a sentence (key 'text') nor a mask (key 'segmentation' or 'path')");
	else if (got < 0 && e->code == ERR_FORMAT && !start_again(path, &ignored))
		whole = json_read(path, &ignored);
	is_frames |= cJSON_HasObjectItem(whole, "frames");
	cJSON_Delete(whole);
	cJSON_Delete(first);
	jsonl_close(&j);
	if ((got < 0 && !is_frames) || start_again(path, e))
		return -1;
	if (is_frames)
		return check_cameras(c, path, "nerfstudio cameras", e);
	if (is_parse)
		return check_parses(c, path, e);
	if (is_box && !is_sentence && !is_mask)
		return check_boxes(c, path, e);
	return is_sentence ? check_sentences(c, path, e) : check_masks(c, path, e);
}

/* A list is of cameras: a scene's, which alone have a key world_to_camera, or those that 3DGS writes. */
static int check_list(struct check *c, const char *path, struct err *e)
{
	cJSON *list = json_read(path, e);
	int is_empty = list && !list->child;
	int is_scene = list && cJSON_HasObjectItem(list->child, "world_to_camera");

	if (!list)
		return -1;
	cJSON_Delete(list);
	if (start_again(path, e))
		return -1;
	return is_scene || is_empty ? check_scene_cameras(c, path, e)
				    : check_cameras(c, path, "3DGS cameras", e);
}

/* How a file begins. */
struct head {
	size_t len;
	unsigned char bytes[4096];
};

static int begins(const struct head *h, const char *with)
{
	size_t len = strlen(with);

	return h->len >= len && !memcmp(h->bytes, with, len);
}

/* A UTF-8 byte order mark and blanks may stand before the first bracket. */
static int is_json(const struct head *h, int first)
{
	size_t i = begins(h, "\xef\xbb\xbf") ? 3 : 0;

	while (i < h->len && h->bytes[i] && strchr(" \t\r\n", h->bytes[i]))
		i++;
	return i < h->len && h->bytes[i] == first;
}

/* An eight-byte length below 2^40 and, where there is more, a JSON object: no text has zero bytes there. */
static int is_safetensors(const struct head *h)
{
	const unsigned char *b = h->bytes;

	return h->len >= 8 && !b[5] && !b[6] && !b[7] && (h->len == 8 || b[8] == '{');
}

static int check_stream(struct check *c, const char *path, struct err *e)
{
	struct head h;
	FILE *in = file_open(path, e);

	if (!in)
		return -1;
	h.len = fread(h.bytes, 1, sizeof h.bytes, in);
	int bad = ferror(in) ? err_errno(e, "%s", file_name(path)) : 0;
	file_close(in);
	if (bad || start_again(path, e))
		return -1;
	if (!h.len)
		return err_set(e, ERR_FORMAT, "%s: empty", file_name(path));
	if (is_safetensors(&h))
		return check_safetensors(c, path, e);
	if (begins(&h, "\x89PN") || begins(&h, "\xff\xd8\xff"))
		return check_image(c, path, e);
	if (begins(&h, "ply\n") || begins(&h, "ply\r"))
		return check_ply(c, path, e);
	if (begins(&h, "\x93NUMPY"))
		return check_npy(c, path, e);
	if (is_json(&h, '['))
		return check_list(c, path, e);
	if (is_json(&h, '{'))
		return check_objects(c, path, e);
	return err_set(e, ERR_FORMAT, "%s: not a kind of file that the suite reads", file_name(path));
}

/* One view of a folder, which is of the scene that the folder's first one with a fingerprint is of. */
static int add_view_weights(struct check *c, const char *file, char **first, long long *total, struct err *e)
{
	struct weights w;

	if (weights_open_file(&w, file, e))
		return -1;
	int bad = *first ? fingerprint_check("scene", file, &w.scene, *first, &c->scene, e) : 0;
	if (!bad && !*first && *w.scene.hex) {
		c->scene = w.scene;
		*first = mem_strdup(file, e);
		bad = *first ? 0 : -1;
	}
	*total += (long long)w.indptr[(int64_t)w.width * w.height];
	weights_close(&w);
	return bad;
}

/* Adds the views of a folder of gs-weigh, in the order of their names; *views says how many there are. */
static int add_weights(
	struct check *c, const char *path, struct dirent **names, int n, long long *views, struct err *e)
{
	long long total = 0;
	char *first = NULL;
	int bad = 0;

	*views = 0;
	for (int i = 0; i < n && !bad; i++) {
		const char *dot = strrchr(names[i]->d_name, '.');
		if (!dot || strcmp(dot, ".safetensors"))
			continue;
		char *file = file_join(path, names[i]->d_name, "", e);
		bad = file ? add_view_weights(c, file, &first, &total, e) : -1;
		free(file);
		++*views;
	}
	free(first);
	if (bad)
		return -1;
	c->kind = "weights";
	check_add(c, "views", *views);
	check_add(c, "weights", total);
	return 0;
}

/* Each kind of folder is known by what lies in it. */
static int check_folder(struct check *c, const char *path, struct err *e)
{
	static const char *const parts[] = {"splats.safetensors", "cameras.json"};
	struct dirent **names = NULL;
	long long views = 0;
	int found = 0;

	for (int i = 0; i < 2; i++) {
		char *part = file_join(path, parts[i], "", e);
		if (!part)
			return -1;
		found |= file_exists(part) << i;
		free(part);
	}
	if (found == 3)
		return check_scene(c, path, e);
	if (found & 1)
		return err_set(e, ERR_FORMAT, "%s: a scene without %s", path, parts[1]);
	if (colmap_is_model(path))
		return check_cameras(c, path, "COLMAP model", e);
	int n = scandir(path, &names, NULL, alphasort);
	if (n < 0)
		return err_errno(e, "%s", path);
	int bad = add_weights(c, path, names, n, &views, e);
	for (int i = 0; i < n; i++)
		free(names[i]);
	free(names);
	if (!bad && !views)
		return err_set(e, ERR_FORMAT, "%s: not a scene, COLMAP model or folder of weights", path);
	return bad;
}

int check_file(struct check *c, const char *path, struct err *e)
{
	*c = (struct check){0};
	if (!(file_is_dir(path) ? check_folder(c, path, e) : check_stream(c, path, e)))
		return 0;
	check_free(c);
	return -1;
}

void check_free(struct check *c)
{
	safetensors_close(&c->listing);
	*c = (struct check){0};
}

int check_spool(struct err *e)
{
	char block[65536];
	size_t len;

	if (lseek(STDIN_FILENO, 0, SEEK_CUR) >= 0)
		return 0;
	FILE *spool = tmpfile();
	if (!spool)
		return err_errno(e, "stdin: temporary file");
	while ((len = fread(block, 1, sizeof block, stdin)))
		fwrite(block, 1, len, spool);
	int bad = ferror(stdin) || fflush(spool) || ferror(spool) || dup2(fileno(spool), STDIN_FILENO) < 0 ||
		  fseek(stdin, 0, SEEK_SET);
	if (bad)
		err_errno(e, "stdin: temporary file");
	fclose(spool);
	return bad ? -1 : 0;
}
