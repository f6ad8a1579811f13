/* The files of a folder that pipelines/lift.mk made, by their usual places. */
#ifndef CMD_RUN_RUN_FOLDER_H
#define CMD_RUN_RUN_FOLDER_H

#include "base/err.h"

struct run_folder {
	char *scene, *model, *encoder;
};

/* The scene, RUN/scene; the lifted model, RUN/lifted/model.safetensors; and the encoder, encoder_default's;
 * but for those of `given` that are not NULL. Copies. ERR_SYSTEM where
 * the folder or one of them is not there: the message says what makes it. Returns 0, or -1 with *e set;
 * run_folder_free after either. */
int run_folder_find(struct run_folder *f, const char *run, const struct run_folder *given, struct err *e);
void run_folder_free(struct run_folder *f);

#endif
