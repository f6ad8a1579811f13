#include "cmd/check/check.h"

#include "base/file.h"
#include "base/mem.h"
#include "base/path.h"
#include "formats/splats/anysplats.h"
#include "formats/records/json.h"
#include "formats/records/jsonl.h"

#include <stdio.h>
#include <unistd.h>

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
		{"refer.motion", check_motion},
		{"refer.text", check_text},
		{"refer.weights", check_weights},
		{"refer.model", check_model},
		{"refer.lifted", check_lifted},
		{"refer.features", check_features},
		{"refer.selection", check_selection},
		{"refer.regions", check_regions},
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

/* Where the first line is a whole record, it says what all are; else the file may be one object. */
static int check_objects(struct check *c, const char *path, struct err *e)
{
	SCOPED_BY(jsonl_close) struct jsonl j = {0};
	struct err ignored;
	SCOPED_BY(json_release) cJSON *first = NULL, *whole = NULL;

	if (jsonl_open(&j, path, e))
		return -1;
	int got = jsonl_next(&j, &first, e);
	int is_sentence = cJSON_HasObjectItem(first, "text"),
	    is_frames = cJSON_HasObjectItem(first, "frames");
	int is_mask = cJSON_HasObjectItem(first, "segmentation") || cJSON_HasObjectItem(first, "path");
	int is_box = cJSON_HasObjectItem(first, "oriented"), is_detection = cJSON_HasObjectItem(first, "box");
	if (got == 1 && !is_sentence && !is_mask && !is_frames && !is_box && !is_detection)
		got = jsonl_err(
			&j, e, "neither a sentence (key 'text') nor a mask (key 'segmentation' or 'path')");
	else if (got < 0 && e->code == ERR_FORMAT && !start_again(path, &ignored))
		whole = json_read(path, &ignored);
	is_frames |= cJSON_HasObjectItem(whole, "frames");
	if ((got < 0 && !is_frames) || start_again(path, e))
		return -1;
	if (is_frames)
		return check_cameras(c, path, "nerfstudio cameras", camerafile_read, e);
	if (is_box && !is_sentence && !is_mask)
		return check_boxes(c, path, e);
	if (is_detection && !is_sentence && !is_mask)
		return check_detections(c, path, e);
	return is_sentence ? check_sentences(c, path, e) : check_masks(c, path, e);
}

/* A list is of cameras: a scene's, which alone have a key world_to_camera, or those that 3DGS writes. */
static int check_list(struct check *c, const char *path, struct err *e)
{
	SCOPED_BY(json_release) cJSON *list = json_read(path, e);
	int is_empty = list && !list->child;
	int is_scene = list && cJSON_HasObjectItem(list->child, "world_to_camera");

	if (!list || start_again(path, e))
		return -1;
	return is_scene || is_empty ? check_cameras(c, path, "scene cameras", scene_read_cameras_file, e)
				    : check_cameras(c, path, "3DGS cameras", camerafile_read, e);
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

/* A byte order mark and blanks may stand before the first bracket, of UTF-16 too. */
static int is_json(const struct head *h, int first)
{
	size_t i = begins(h, "\xef\xbb\xbf") ? 3 : begins(h, "\xff\xfe") || begins(h, "\xfe\xff") ? 2 : 0;

	while (i < h->len && strchr(" \t\r\n", h->bytes[i]))
		i++;
	return i < h->len && h->bytes[i] == first;
}

/* An eight-byte length below 2^40 and, where there is more, a JSON object: no text has zero bytes there. */
static int is_safetensors(const struct head *h)
{
	const unsigned char *b = h->bytes;

	return h->len >= 8 && !b[5] && !b[6] && !b[7] && (h->len == 8 || b[8] == '{');
}

/* A zip whose first file is NAME.npy: its name's length is at 26, the name at 30. */
static int is_npz(const struct head *h)
{
	const size_t name = h->len >= 30 ? (size_t)h->bytes[26] + 256 * (size_t)h->bytes[27] : 0;

	return begins(h, "PK\3\4") && name >= 4 && 30 + name <= h->len &&
	       !memcmp(h->bytes + 30 + name - 4, ".npy", 4);
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
	if (is_npz(&h))
		return check_npz(c, path, e);
	if (begins(&h, "PK\3\4") || anysplats_is_meta(path))
		return check_anysplats(c, path, "sog", e);
	if (path_ends(path, ".splat"))
		return check_anysplats(c, path, "splat", e);
	if (is_safetensors(&h))
		return check_safetensors(c, path, e);
	if (begins(&h, "\x89PN") || begins(&h, "\xff\xd8\xff"))
		return check_image(c, path, e);
	if (begins(&h, "ply\n") || begins(&h, "ply\r"))
		return check_anysplats(c, path, "3DGS ply", e);
	if (begins(&h, "NGSP") || begins(&h, "\x1f\x8b"))
		return check_anysplats(c, path, "spz", e);
	if (begins(&h, "glTF"))
		return check_anysplats(c, path, "glb", e);
	if (begins(&h, "\x93NUMPY"))
		return check_npy(c, path, e);
	if (is_json(&h, '['))
		return check_list(c, path, e);
	if (is_json(&h, '{'))
		return check_objects(c, path, e);
	return err_set(e, ERR_FORMAT, "%s: not a kind of file that the suite reads", file_name(path));
}

int check_file(struct check *c, const char *path, struct err *e)
{
	*c = (struct check){0};
	if (file_is_pipe(path))
		return err_set(e, ERR_SYSTEM,
			"%s: a pipe, which cannot be read twice: '-' reads one from standard input", path);
	return file_is_dir(path) ? check_folder(c, path, e) : check_stream(c, path, e);
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
