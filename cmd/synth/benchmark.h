/* A synthetic benchmark: made until all of it can be seen and told apart in words, then written: gs-synth.
 * formats/scene/synth.md. */
#ifndef CMD_SYNTH_BENCHMARK_H
#define CMD_SYNTH_BENCHMARK_H

#include "base/err.h"
#include "base/report.h"
#include "synth/candidates.h"
#include "synth/statistics.h"
#include "synth/synth_scene.h"
#include "synth/synth_sentences.h"
#include "synth/unseen.h"

#include <stdint.h>

struct benchmark {
	struct synth_options options; /* the caller's, but for the seed */
	struct synth_scene scene;
	struct synth_detector detector;
	struct synth_sentence *sentences;
	struct synth_unseen_list unseen;
	struct synth_statistics statistics; /* known when it is written */
};

/* Makes preset `number`; *b is zeroed before, but for its options. ERR_CHECK where no attempt was any good.
 * Both return 0, or -1 with *e set; after any benchmark_free is in order. */
int benchmark_make(struct benchmark *b, int number, uint64_t seed, struct err *e);
int benchmark_write(struct benchmark *b, const char *folder, const struct report *to, struct err *e);
void benchmark_free(struct benchmark *b);

#endif
