#include "cmd/synth/benchmark.h"

#include "base/mem.h"

#include <math.h>

enum { ATTEMPTS = 20 };

/* What is free of a table on which things move. */
static const double room = 0.5;

static int make_moves(struct benchmark *b, struct err *e)
{
	struct cameras *c = &b->scene.cameras;
	const int times = b->options.times;

	if (!times)
		return 0;
	for (size_t i = 0; i < c->n; i++) {
		c->views[i].has_time = 1;
		c->views[i].time =
			synth_moves_time(times, (int)lrint((double)i * (times - 1) / (double)(c->n - 1)));
	}
	return -(synth_moves_draw(&b->moves, &b->scene, times, b->options.seed, e) ||
		 synth_moving_make(&b->moving[0], &b->moves, 0, b->options.seed, e) ||
		 synth_moving_make(&b->moving[1], &b->moves, 1, b->options.seed, e));
}

static int make_once(struct benchmark *b, struct err *e)
{
	struct synth_viewpoint v;
	struct synth_scene *s = &b->scene;

	if (synth_scene_make(s, &b->options, e))
		return -1;
	synth_viewpoint_reference(&v, s->objects, s->object_count, &s->table, &s->cameras, 0);
	if (synth_sentences_make(&b->sentences, &v, b->options.seed, b->options.is_wording_seen, e) ||
		synth_unseen_make(
			&b->unseen, s->objects, s->object_count, &s->table, &s->cameras, b->options.seed, e))
		return -1;
	synth_detector_make(&b->detector, s->objects, s->object_count, b->sentences.items,
		s->preset->severity, b->options.seed);
	return make_moves(b, e);
}

/* Things may stand so that they hide one, or that words cannot tell them apart; then they are put otherwise.
 * Nothing is written before. */
int benchmark_make(struct benchmark *b, int number, uint64_t seed, struct err *e)
{
	if (b->options.times) {
		b->roomy = *b->options.preset;
		b->roomy.filled *= room;
		b->options.preset = &b->roomy;
	}
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
		.moves = &b->moves,
		.moving = b->moving,
		.statistics = &b->statistics};
	int bad = synth_statistics_make(&b->statistics, &b->scene, &b->sentences, e) ||
		  synth_folder_begin(&f, e) || (b->moves.times && synth_moving_write(&f, e));

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
	synth_moves_free(&b->moves);
	free(b->moving[0].items);
	free(b->moving[1].items);
	memset(b->moving, 0, sizeof b->moving);
	synth_scene_free(&b->scene);
}
