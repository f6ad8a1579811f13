/* Says what a file of the suite is, by its content, and whether it is well-formed. Reads with the format's
 * own reader, so what passes here is what the tools accept. */
#pragma once

#include "base/err.h"
#include "formats/arrays/fingerprint.h"
#include "formats/arrays/safetensors.h"
#include "formats/cameras/camerafile.h"
#include "formats/scene/scene.h"

enum { CHECK_MAX_FACTS = 6 };

struct check_fact {
	const char *name; /* of what is counted, in the plural: "weights" */
	long long value;
};

struct check {
	const char *kind;      /* "refer.weights", "scene", "masks" ... */
	const char *precision; /* of its numbers; NULL where there is no choice */
	int width, height;     /* of its image or views; 0 where there is none, or more than one */
	struct fingerprint scene, camera, encoder; /* those that the file has */
	int n;
	struct check_fact facts[CHECK_MAX_FACTS];
	struct safetensors
		listing; /* an open safetensors file of somebody else's, to be listed; zeroed otherwise */
};

/* Checks a file or folder; "-" is stdin, which must be seekable (see check_spool). Returns 0 and *c (release
 * with check_free after either), or -1 with *e: ERR_FORMAT where the file is malformed or of no known kind,
 * ERR_SYSTEM where it cannot be read. */
int check_file(struct check *c, const char *path, struct err *e);
void check_free(struct check *c);

/* Where stdin is a pipe, puts a temporary file with its content in its place, to be read twice. */
int check_spool(struct err *e);

/* What cmd/check/check.h says of JSON Lines (formats/records/jsonl.md): each reads a whole file with its
 * format's reader, and adds the kind and what it counted. Return 0, or -1 with *e. */

/* Adds one fact; there is room for CHECK_MAX_FACTS. */
void check_add(struct check *c, const char *name, long long value);

int check_sentences(struct check *c, const char *path, struct err *e);
int check_masks(struct check *c, const char *path, struct err *e);
int check_boxes(struct check *c, const char *path, struct err *e);
int check_detections(struct check *c, const char *path, struct err *e);

/* What cmd/check/check.h says of files of arrays and of cameras: each reads a whole file with its format's
 * reader, and adds what it counted. Return 0, or -1 with *e. */

/* Those of ours, whose kind is known already. */
int check_splats(struct check *c, const char *path, struct err *e);
int check_motion(struct check *c, const char *path, struct err *e);
int check_text(struct check *c, const char *path, struct err *e);
int check_weights(struct check *c, const char *path, struct err *e);
int check_model(struct check *c, const char *path, struct err *e);
int check_lifted(struct check *c, const char *path, struct err *e);
int check_features(struct check *c, const char *path, struct err *e);
int check_selection(struct check *c, const char *path, struct err *e);
int check_regions(struct check *c, const char *path, struct err *e);
int check_parser(struct check *c, const char *path, struct err *e);

/* The others. */
int check_anysplats(struct check *c, const char *path, const char *kind, struct err *e);
int check_npy(struct check *c, const char *path, struct err *e);
int check_npz(struct check *c, const char *path, struct err *e);
int check_image(struct check *c, const char *path, struct err *e);
typedef int cameras_reader(struct cameras *c, const char *path, struct err *e);
int check_cameras(struct check *c, const char *path, const char *kind, cameras_reader *read, struct err *e);

void check_add_motion(struct check *c, const struct motion *m);
void check_add_splats(struct check *c, const struct splats *s);
/* The views and, where they have one size, that. */
void check_add_views(struct check *c, const struct cameras *views);

/* What cmd/check/check.h says of folders: a scene, a COLMAP model, the weights of gs-weigh. */

/* Checks all that is in it. Returns 0, or -1 with *e. */
int check_folder(struct check *c, const char *path, struct err *e);
