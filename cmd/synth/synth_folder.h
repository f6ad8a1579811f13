/* The folder of a synthetic benchmark, as gs-synth makes it. formats/scene/synth.md. */
#ifndef CMD_SYNTH_SYNTH_FOLDER_H
#define CMD_SYNTH_SYNTH_FOLDER_H

#include "base/err.h"
#include "base/file.h"
#include "synth/candidates.h"
#include "synth/statistics.h"
#include "synth/synth_scene.h"
#include "synth/synth_sentences.h"
#include "synth/unseen.h"

/* What is written, nothing of it owned but the open outputs. */
struct synth_folder {
	const char *dir;
	struct synth_scene *scene; /* its cameras get the names of their photographs */
	const struct synth_sentence *sentences;
	const struct synth_unseen_list *unseen;
	const struct synth_detector *detector;
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

#endif
