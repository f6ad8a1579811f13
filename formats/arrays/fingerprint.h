/* Fingerprints: what a file was made from, so that files of different scenes, cameras or encoders are not
 * mixed. formats/arrays/safetensors.md says what each is a hash of. */
#pragma once

#include "base/err.h"
#include "formats/arrays/arrays_out.h"
#include "geom/camera.h"
#include "nn/bpe.h"
#include "nn/text_tower.h"
#include "nn/wordpiece.h"
#include "splat/splats.h"

struct fingerprint {
	char hex[17]; /* 16 hexadecimal digits; "" where it is not known: of files that were made before there
			 were any */
};

/* What a model or a training is of: keys `scene` and `encoder`. */
struct origin {
	struct fingerprint scene, encoder;
};

/* Of a scene: its means, in their order, and its near plane where that is not 3DGS's. */
struct fingerprint fingerprint_scene(const struct splats *s);
/* Of a view: image size, intrinsics, pose and, where it has one, time. */
struct fingerprint fingerprint_camera(const struct camera *c);
/* Of an encoder: its sizes, weights, vocabulary and merges (NULL: it has none), and whether words are taken
 * from the vocabulary as they are. */
struct fingerprint fingerprint_encoder(
	const struct text_tower *t, const struct vocab *v, const struct bpe *merges, int is_static);

/* The metadata value `key`. ERR_FORMAT where there is one that is not 16 lower-case hexadecimal digits. */
int fingerprint_read(struct fingerprint *f, const struct safetensors *st, const char *key, struct err *e);

int origin_read(struct origin *o, const struct safetensors *st, struct err *e);
void origin_put(struct arrays_out *out, const struct origin *o);

/* The value to write as metadata: NULL, which leaves the key out, where it is not known. */
const char *fingerprint_text(const struct fingerprint *f);

/* 0 where `mine` of the file `path` is that of the file `other`, or one of them is not known. Else
 * ERR_FORMAT: "PATH: is of another WHAT than OTHER (HEX, not HEX)". */
int fingerprint_check(const char *what, const char *path, const struct fingerprint *mine, const char *other,
	const struct fingerprint *theirs, struct err *e);
