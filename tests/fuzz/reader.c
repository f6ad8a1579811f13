/* libFuzzer targets, one for each reader of formats/: the program is built once, and the part of its name
 * after "reader-" says which reader it feeds. The input is a file in memory, which readers open by its path;
 * those of folders find it there under the names that they look for. Where readers demand much data, its end
 * is zeros that are not in the input, so that inputs stay small. Built by `make fuzz`;
 * REFERSPLAT_FUZZ_SEED=FILE has the checkpoint's target write a seed first. */
#include "base/file.h"
#include "cmd/check/check.h"
#include "cmd/import/import.h"
#include "cmd/serve/serving.h"
#include "formats/arrays/npy.h"
#include "formats/arrays/npz.h"
#include "formats/arrays/safetensors.h"
#include "formats/cameras/camerafile.h"
#include "formats/cameras/colmap.h"
#include "formats/cameras/dataparser.h"
#include "formats/encoders/bert_model.h"
#include "formats/encoders/clip_model.h"
#include "formats/encoders/merges.h"
#include "formats/encoders/parser_weights.h"
#include "formats/encoders/vocab.h"
#include "formats/images/png.h"
#include "formats/records/annotations.h"
#include "formats/records/boxes.h"
#include "formats/records/detections.h"
#include "formats/records/json.h"
#include "formats/records/masks.h"
#include "formats/records/sentences.h"
#include "formats/scene/checkpoint.h"
#include "formats/scene/features.h"
#include "formats/scene/lifted.h"
#include "formats/scene/model.h"
#include "formats/scene/scene.h"
#include "formats/scene/proposed.h"
#include "formats/scene/selection.h"
#include "formats/scene/text.h"
#include "formats/scene/weights.h"
#include "formats/splats/anysplats.h"
#include "geom/lens.h"

#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

int LLVMFuzzerInitialize(int *argc, char ***argv);
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static struct err e;

/* NAME reads and frees; what a reader says of the input does not matter, only that it says it. */
#define SIMPLE(name, type, read, release)                                                                    \
	static void try_##name(const char *path)                                                             \
	{                                                                                                    \
		type it = {0};                                                                               \
		(void)read(&it, path, &e);                                                                   \
		release(&it);                                                                                \
	}

SIMPLE(boxes, struct box_set, boxes_read, boxes_free)
SIMPLE(check, struct check, check_file, check_free)
SIMPLE(detections, struct detections, detections_read, detections_free)
SIMPLE(features, struct features, features_open, features_close)
SIMPLE(masks, struct masks, masks_read, masks_free)
SIMPLE(model, struct model, model_read, model_free)
SIMPLE(motion, struct motion, motion_open, motion_close)
SIMPLE(npy, struct npy, npy_open, npy_close)
SIMPLE(parser, struct parser_weights, parser_weights_read, parser_weights_free)
SIMPLE(safetensors, struct safetensors, safetensors_open, safetensors_close)
SIMPLE(selection, struct selection, selection_read, selection_free)
SIMPLE(regions, struct regions_file, regions_file_read, regions_file_free)
SIMPLE(cameras, struct cameras, scene_read_cameras_file, cameras_free)
SIMPLE(splats, struct scene, scene_read_splats, scene_free)
SIMPLE(sentences, struct sentences, sentences_read_any, sentences_free)
SIMPLE(text, struct text, text_read, text_free)
SIMPLE(weights, struct weights, weights_open_file, weights_close)
SIMPLE(colmap, struct cameras, colmap_read, cameras_free)
SIMPLE(folder, struct scene, scene_read, scene_free)
SIMPLE(bert, struct text_tower, bert_model_read, text_tower_free)
SIMPLE(clip, struct text_tower, clip_model_read, text_tower_free)

static const char text_to_cut[] = "The red cup's 10 plates, caf\xc3\xa9!";

static void try_vocab(const char *path)
{
	struct vocab v = {0};
	struct wordpieces out = {0};
	char *pieces = NULL;

	if (!vocab_read(&v, path, &e) && !wordpiece_encode(&v, text_to_cut, &out, &e))
		pieces = vocab_print(&v, out.ids, out.n, &e);
	free(pieces);
	free(out.ids);
	vocab_free(&v);
}

/* The text is cut by whatever merges were read. */
static void try_merges(const char *path)
{
	struct bpe b = {0};
	struct wordpieces out = {0};
	char *pieces = NULL;

	if (!merges_read(&b, path, 634, &e) && !bpe_encode(&b, text_to_cut, &out, &e))
		pieces = merges_print(&b, out.ids, out.n, &e);
	free(pieces);
	free(out.ids);
	bpe_free(&b);
}

static void try_annotations(const char *path)
{
	struct annotations a = {0};

	(void)annotations_read(&a, path, &e);
	annotations_free(&a);
}

static void try_lifted(const char *path)
{
	struct lifted l = {0};
	struct origin origin;

	(void)lifted_read(&l, &origin, path, &e);
	lifted_free(&l);
}

static void try_points(const char *path)
{
	static const double offset[3];
	float *points;
	size_t n;

	if (!points_read(&points, &n, path, offset, &e))
		free(points);
}

static void try_scene(const char *path)
{
	struct splats s = {0};
	struct rows_report report = {0};
	double offset[3];

	if (anysplats_read(&s, offset, &report, path, &e))
		return;
	splats_free(&s);
	free(report.dropped);
}

/* Those whose format goes by the name. */
static void try_named(const char *folder, const char *name)
{
	char path[128];

	snprintf(path, sizeof path, "%s/%s", folder, name);
	try_scene(path);
}

static void try_sog(const char *path)
{
	try_named(path, "meta.json");
}

static void try_splat(const char *path)
{
	try_named(path, "scene.splat");
}

static void try_image(const char *path)
{
	uint8_t *rgb = NULL, *mask = NULL;
	int32_t *labels = NULL;
	int height, width;

	if (!image_read_rgb(path, &rgb, &height, &width, &e))
		free(rgb);
	if (!png_read_mask(path, &mask, &height, &width, &e))
		free(mask);
	if (!png_read_labels(path, &labels, &height, &width, &e))
		free(labels);
}

/* The pinholes of lenses, and what they show, of pictures that do not take long. */
static void try_lenses(struct cameras *c)
{
	enum { SIDE = 24 };
	static int32_t map[4 * SIDE * SIDE];

	for (size_t i = 0; i < c->n && i < 4; i++) {
		struct lens *l = &c->views[i].lens;
		l->width = l->width < SIDE ? l->width : SIDE;
		l->height = l->height < SIDE ? l->height : SIDE;
		if (!l->model)
			continue;
		lens_pinhole(l, &c->views[i]);
		lens_map(l, &c->views[i], 0, SIDE, SIDE, map);
		lens_map(l, &c->views[i], 1, SIDE, SIDE, map);
	}
}

static void try_camerafile(const char *path)
{
	struct cameras c;

	if (camerafile_read(&c, path, &e))
		return;
	try_lenses(&c);
	cameras_free(&c);
}

static void try_dataparser(const char *path)
{
	struct camera view = {.width = 4, .height = 3, .fx = 5, .fy = 5};
	struct cameras c = {1, &view};

	for (int i = 0; i < 4; i++)
		view.world_to_camera[i][i] = 1;
	(void)dataparser_move(&c, path, "cameras", &e);
}

enum { VALUES = 24 };
static float values[4][VALUES];
static const struct checkpoint_of of = {.identity = "a training", .scene_path = "scene", .text_path = "text"};

static struct train_state small_state(void)
{
	return (struct train_state){.parameters = 16,
		.count = VALUES,
		.values = values[0],
		.gradient = values[1],
		.m = values[2],
		.v = values[3]};
}

static void try_checkpoint(const char *path)
{
	struct train_state t = small_state();

	(void)checkpoint_resume(&t, path, &of, 1000, &e);
}

static void try_npz(const char *path)
{
	struct npz z;
	struct npy a = {0};

	const int bad = npz_open(&z, path, &e);
	for (size_t i = 0; i < z.zip.n && !bad; i++) {
		const size_t len = strlen(z.zip.entries[i].name);
		if (len < sizeof ".npy")
			continue;
		z.zip.entries[i].name[len - 4] = 0;
		char *name = strdup(z.zip.entries[i].name);
		z.zip.entries[i].name[len - 4] = '.';
		if (name)
			(void)npz_array(&z, name, "", &a, NULL, &e);
		npy_close(&a);
		free(name);
	}
	npz_close(&z);
}

/* A request to refer-serve, as --stdio has it, of the folder in REFERSPLAT_FUZZ_RUN. It may not write. */
static void try_requests(const char *path)
{
	static struct serving s;
	static struct serving_options options = {.least = 0.5, .splats = 1000};
	struct serving_reply reply = {0};
	cJSON *body = json_read(path, &e), *what = json_get(body, "do");

	if (!options.run) {
		static char encoder[4096];
		if (!(options.run = getenv("REFERSPLAT_FUZZ_RUN")))
			abort();
		snprintf(encoder, sizeof encoder, "%s/encoder", options.run);
		options.encoder = encoder;
		if (serving_open(&s, &options, &report_silent, &e))
			abort();
	}
	if (cJSON_IsString(what))
		serving_answer(&s, what->valuestring, body, 0, &reply, &e);
	free(reply.bytes);
	cJSON_Delete(body);
}

enum { FILES_MOST = 8 };

static const struct target {
	const char *name;
	void (*run)(const char *path);
	/* Readers of folders: the files that the input is cut into, at the lengths that it begins with. */
	const char *files[FILES_MOST + 1];
	int grows; /* so many zeros as the input begins with follow it, or its last file */
} targets[] = {
	{"annotations", try_annotations, {0}, 0},
	{"bert", try_bert, {"config.json", "model.safetensors"}, 1},
	{"boxes", try_boxes, {0}, 0},
	{"camerafile", try_camerafile, {0}, 0},
	{"cameras", try_cameras, {0}, 0},
	{"check", try_check, {0}, 0},
	{"checkpoint", try_checkpoint, {0}, 0},
	{"clip", try_clip, {"config.json", "model.safetensors"}, 1},
	{"clip-open", try_clip, {"open_clip_config.json", "open_clip_model.safetensors"}, 1},
	{"colmap-binary", try_colmap, {"cameras.bin", "images.bin"}, 0},
	{"colmap-text", try_colmap, {"cameras.txt", "images.txt"}, 0},
	{"dataparser", try_dataparser, {0}, 0},
	{"detections", try_detections, {0}, 0},
	{"features", try_features, {0}, 0},
	{"glb", try_scene, {0}, 0},
	{"image", try_image, {0}, 0},
	{"lifted", try_lifted, {0}, 0},
	{"masks", try_masks, {0}, 0},
	{"merges-gzip", try_merges, {"bpe_simple_vocab_16e6.txt.gz"}, 0},
	{"merges-json", try_merges, {"tokenizer.json"}, 0},
	{"merges-text", try_merges, {"vocab.json", "merges.txt"}, 0},
	{"model", try_model, {0}, 1},
	{"motion", try_motion, {0}, 0},
	{"npy", try_npy, {0}, 0},
	{"npz", try_npz, {0}, 0},
	{"parser", try_parser, {0}, 1},
	{"ply", try_scene, {0}, 0},
	{"points", try_points, {"points3D.bin", "points3D.txt", "points3D.ply"}, 0},
	{"safetensors", try_safetensors, {0}, 0},
	{"scene", try_folder, {"cameras.json", "splats.safetensors"}, 0},
	{"selection", try_selection, {0}, 0},
	{"regions", try_regions, {0}, 0},
	{"requests", try_requests, {0}, 0},
	{"sentences", try_sentences, {0}, 0},
	{"sog", try_sog,
		{"meta.json", "means_l.webp", "means_u.webp", "quats.webp", "scales.webp", "sh0.webp",
			"shN_centroids.webp", "shN_labels.webp"},
		0},
	{"sog-zip", try_scene, {0}, 0},
	{"splat", try_splat, {"scene.splat"}, 0},
	{"splats", try_splats, {0}, 0},
	{"spz", try_scene, {0}, 0},
	{"text", try_text, {0}, 0},
	{"vocab-json", try_vocab, {"tokenizer.json"}, 0},
	{"vocab-text", try_vocab, {"vocab.txt", "tokenizer_config.json"}, 0},
	{"weights", try_weights, {0}, 0},
};

enum {
	TARGETS = sizeof targets / sizeof *targets,
	CUT = 4,	     /* bytes, little-endian, of a file's length, or of how many zeros there are */
	ZEROS_MOST = 1 << 20 /* more are as many */
};
static const struct target *target;
static int files; /* that the target's reader opens */
static int fds[FILES_MOST];
static char paths[FILES_MOST][64], folder[64];

static void remove_folder(void)
{
	char name[128];

	for (int i = 0; i < files; i++) {
		snprintf(name, sizeof name, "%s/%s", folder, target->files[i]);
		unlink(name);
	}
	rmdir(folder);
}

static void make_files(void)
{
	char name[128];

	while (target->files[files])
		files++;
	for (int i = 0; i < (files ? files : 1); i++) {
		snprintf(name, sizeof name, "/dev/shm/refersplat-fuzz-XXXXXX");
		fds[i] = mkstemp(name);
		unlink(name);
		snprintf(paths[i], sizeof paths[i], "/proc/%ld/fd/%d", (long)getpid(), fds[i]);
	}
	if (!files)
		return;
	snprintf(folder, sizeof folder, "/dev/shm/refersplat-fuzz-XXXXXX");
	if (!mkdtemp(folder))
		abort();
	atexit(remove_folder);
	for (int i = 0; i < files; i++) {
		snprintf(name, sizeof name, "%s/%s", folder, target->files[i]);
		if (symlink(paths[i], name))
			abort();
	}
}

int LLVMFuzzerInitialize(int *argc, char ***argv)
{
	const char *name = strstr((*argv)[0], "reader-"), *seed = getenv("REFERSPLAT_FUZZ_SEED");

	(void)argc;
	for (int i = 0; name && i < TARGETS; i++)
		if (!strcmp(name + strlen("reader-"), targets[i].name))
			target = &targets[i];
	if (!target) {
		fprintf(stderr, "the program's name is not that of a target: reader-NAME, where NAME is\n");
		for (int i = 0; i < TARGETS; i++)
			printf("%s\n", targets[i].name);
		exit(2);
	}
	if (seed && target->run == try_checkpoint) {
		const struct train_state t = small_state();
		exit(checkpoint_write(&t, seed, &of, &e) ? 1 : 0);
	}
	make_files();
	return 0;
}

static void put(int fd, const uint8_t *data, size_t size, size_t zeros)
{
	if (pwrite(fd, data, size, 0) != (ssize_t)size || ftruncate(fd, (off_t)size) ||
		ftruncate(fd, (off_t)(size + zeros)))
		abort();
}

/* The number that an input begins with, at most `most`; the rest of the input. */
static size_t take_number(const uint8_t **data, size_t *size, size_t most)
{
	size_t number = 0;

	for (int i = 0; i < CUT; i++)
		number |= (size_t)(*data)[i] << 8 * i;
	*data += CUT;
	*size -= CUT;
	return number < most ? number : most;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
	const int last = files ? files - 1 : 0;
	size_t zeros = 0, lengths[FILES_MOST] = {0};

	if (size < CUT * (size_t)(last + target->grows))
		return 0;
	if (target->grows)
		zeros = take_number(&data, &size, ZEROS_MOST);
	for (int i = 0; i < last; i++)
		lengths[i] = take_number(&data, &size, SIZE_MAX);
	for (int i = 0; i < last; i++) {
		lengths[i] = lengths[i] < size ? lengths[i] : size;
		put(fds[i], data, lengths[i], 0);
		data += lengths[i];
		size -= lengths[i];
	}
	put(fds[last], data, size, zeros);
	target->run(files ? folder : paths[0]);
	return 0;
}
