/* A synthetic benchmark: made until all of it can be seen and told apart in words, then written: gs-synth.
 * formats/scene/synth.md. */
#pragma once

#include "base/err.h"
#include "base/file.h"
#include "base/report.h"
#include "synth/detector.h"
#include "synth/moves.h"
#include "synth/statistics.h"
#include "synth/synth_scene.h"
#include "synth/unseen.h"

#include <stdint.h>

/* The folder of a synthetic benchmark, as gs-synth makes it. formats/scene/synth.md. */

/* What is written, nothing of it owned but the open outputs. */
struct synth_folder {
	const char *dir;
	struct synth_scene *scene; /* its cameras get the names of their photographs */
	const struct synth_sentences *sentences, *unseen;
	const struct synth_detector *detector;
	const struct synth_moves *moves; /* its scene is the scene; no times: it is still */
	const struct synth_moving_sentences *moving;
	struct synth_statistics *statistics; /* each view adds to its visibility */
	struct file_out candidates, test_candidates, truth, whole;
};

/* Makes the folder, writes what is not of single views, and opens the rest. Returns 0, or -1 with *e set;
 * after either synth_folder_abort is in order. */
int synth_folder_begin(struct synth_folder *f, struct err *e);

/* The photograph and masks of view `number`; to be called for each in order. */
int synth_folder_view(struct synth_folder *f, int number, struct err *e);

/* The files of masks and the statistics appear under their names. */
int synth_folder_end(struct synth_folder *f, struct err *e);

/* Removes outputs that are still open. */
void synth_folder_abort(struct synth_folder *f);

/* A file of the folder, by what writes all of it. Returns 0, or -1 with *e set. */
int synth_put_file(const struct synth_folder *f, const char *name, void (*put)(FILE *out, const void *folder),
	struct err *e);

/* What a test sentence's record begins with: what it means, its text and its kind. The record stays open. */
void synth_put_sentence(FILE *out, const struct synth_folder *f, const char *ref, uint64_t objects,
	const char *text, const char *kind);

/* The unseen split, of a struct synth_folder: unseen.jsonl, and parses.unseen.jsonl. */
void synth_unseen_put(FILE *out, const void *folder);
void synth_unseen_put_parses(FILE *out, const void *folder);

/* What a folder has besides of a scene that moves: frames, cameras with times, sentences. Moves the scene. */
int synth_moving_write(const struct synth_folder *f, struct err *e);

struct benchmark {
	struct synth_options options; /* the caller's, but for the seed */
	struct synth_preset roomy;    /* the preset, with room to move */
	struct synth_moves moves;
	struct synth_moving_sentences moving[2]; /* seen, and kept back */
	struct synth_scene scene;
	struct synth_detector detector;
	struct synth_sentences sentences, unseen;
	struct synth_statistics statistics; /* known when it is written */
};

/* Makes preset `number`; *b is zeroed before, but for its options. ERR_CHECK where no attempt was any good.
 * Both return 0, or -1 with *e set; after any benchmark_free is in order. */
int benchmark_make(struct benchmark *b, int number, uint64_t seed, struct err *e);
int benchmark_write(struct benchmark *b, const char *folder, const struct report *to, struct err *e);
void benchmark_free(struct benchmark *b);
