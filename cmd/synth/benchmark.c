#include "cmd/synth/benchmark.h"

enum { ATTEMPTS = 20 };

static int make_once(struct benchmark *b, struct err *e)
{
	struct synth_viewpoint v;
	struct synth_scene *s = &b->scene;

	if (synth_scene_make(s, &b->options, e))
		return -1;
	synth_viewpoint_reference(&v, s->objects, s->object_count, &s->table, &s->cameras, 0);
	if (synth_sentences_make(&b->sentences, &v, b->options.seed, e) ||
		synth_unseen_make(
			&b->unseen, s->objects, s->object_count, &s->table, &s->cameras, b->options.seed, e))
		return -1;
	synth_detector_make(&b->detector, s->objects, s->object_count, b->sentences.items,
		s->preset->severity, b->options.seed);
	return 0;
}

/* Things may stand so that they hide one, or that words cannot tell them apart; then they are put otherwise.
 * Nothing is written before. */
int benchmark_make(struct benchmark *b, int number, uint64_t seed, struct err *e)
{
	for (int attempt = 0; attempt < ATTEMPTS; attempt++) {
		b->options.seed = synth_preset_seed(number, seed, attempt);
		*e = (struct err){0};
		benchmark_free(b);
		if (!make_once(b, e))
			return 0;
		if (e->code != ERR_CHECK)
			return -1;
	}
	return err_set(e, ERR_CHECK,
		"seed %lld: things cannot all be seen and told apart in words; try another --seed",
		(long long)seed);
}

int benchmark_write(struct benchmark *b, const char *folder, const struct report *to, struct err *e)
{
	struct synth_folder f = {.dir = folder,
		.scene = &b->scene,
		.sentences = &b->sentences,
		.unseen = &b->unseen,
		.detector = &b->detector,
		.statistics = &b->statistics};
	int bad = synth_statistics_make(&b->statistics, &b->scene, &b->sentences, e) ||
		  synth_folder_begin(&f, e);

	report_start(to, "views", b->options.views);
	for (int i = 0; i < b->options.views && !bad; i++) {
		bad = synth_folder_view(&f, i, e);
		report_step(to, i + 1, NULL);
	}
	report_end(to);
	bad = bad || synth_folder_end(&f, e);
	synth_folder_abort(&f);
	return bad;
}

void benchmark_free(struct benchmark *b)
{
	synth_sentences_free(&b->sentences);
	synth_sentences_free(&b->unseen);
	synth_scene_free(&b->scene);
}
