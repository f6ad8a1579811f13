/* The files of the unseen split of a synthetic benchmark: sentences and their parses. formats/scene/synth.md.
 */
#ifndef CMD_SYNTH_SYNTH_UNSEEN_H
#define CMD_SYNTH_SYNTH_UNSEEN_H

#include "base/err.h"
#include "geom/camera.h"
#include "synth/unseen.h"

/* Writes DIR/unseen.jsonl and DIR/parses.unseen.jsonl. */
int synth_unseen_files(const char *dir, const struct synth_unseen_list *list,
	const struct synth_object *objects, const struct cameras *cameras, struct err *e);

#endif
