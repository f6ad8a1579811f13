/* gs-synth: a synthetic table-top benchmark, laid out as a person's own data would be. */
#include "base/mem.h"
#include "cli/cli.h"
#include "cmd/jobs/synth_folder.h"
#include "synth/cameras.h"

#include <stdlib.h>
#include <string.h>

enum { ATTEMPTS = 20 };

/* What is made. */
struct job {
	struct cli cli;
	struct synth_options options;
	struct synth_scene scene;
	struct synth_detector detector;
	struct synth_sentence *sentences;
	struct synth_unseen_list unseen;
	struct synth_statistics statistics;
};

static int make_once(struct job *j, struct err *e)
{
	struct synth_layout layout;
	double right[2], away[2];
	struct synth_scene *s = &j->scene;

	if (synth_scene_make(s, &j->options, e))
		return -1;
	synth_cameras_reference(&s->cameras, right, away);
	synth_layout_make(&layout, s->objects, s->object_count, &s->table, right, away);
	if (synth_sentences_make(j->sentences, &layout, j->options.seed, e) ||
		synth_unseen_make(&j->unseen, s->objects, s->object_count, &s->table, &s->cameras,
			j->options.seed, e)) {
		synth_scene_free(s);
		return -1;
	}
	synth_detector_make(&j->detector, s->objects, s->object_count, j->sentences, s->preset->severity,
		j->options.seed);
	return 0;
}

/* Things may stand so that they hide one, or that words cannot tell them apart; then they are put otherwise.
 * Nothing is written before. */
static int make(struct job *j, int number, struct err *e)
{
	j->sentences = mem_zalloc(
		(size_t)j->options.objects * SYNTH_SENTENCES, sizeof *j->sentences, "sentences", e);
	if (!j->sentences)
		return -1;
	for (int attempt = 0; attempt < ATTEMPTS; attempt++) {
		j->options.seed = synth_preset_seed(number, (uint64_t)j->cli.seed, attempt);
		*e = (struct err){0};
		if (!make_once(j, e))
			return 0;
		if (e->code != ERR_CHECK)
			return -1;
	}
	return err_set(e, ERR_CHECK,
		"seed %lld: things cannot all be seen and told apart in words; try another --seed",
		j->cli.seed);
}

static int write_folder(struct job *j, struct err *e)
{
	struct synth_folder f = {.dir = j->cli.output,
		.scene = &j->scene,
		.sentences = j->sentences,
		.unseen = &j->unseen,
		.detector = &j->detector,
		.statistics = &j->statistics};
	struct cli_progress progress;
	int bad = synth_statistics_make(&j->statistics, &j->scene, j->sentences, e) ||
		  synth_folder_begin(&f, e);

	cli_progress_start(&progress, &j->cli, "views", j->options.views);
	for (int i = 0; i < j->options.views && !bad; i++) {
		bad = synth_folder_view(&f, i, e);
		cli_progress_step(&progress, i + 1, NULL);
	}
	cli_progress_end(&progress);
	bad = bad || synth_folder_end(&f, e);
	synth_folder_abort(&f);
	return bad;
}

static void note_quantiles(const struct job *j, const char *name, const double *q)
{
	cli_note(&j->cli, 1, "%-10s %8.3g %8.3g %8.3g %8.3g %8.3g", name, q[0], q[1], q[2], q[3], q[4]);
}

static void note_visibility(const struct job *j, const char *name, enum camera_split split)
{
	const struct synth_visibility *v = &j->statistics.visibility[split];
	double of = v->pairs ? 100.0 / (double)v->pairs : 0;
	const long *b = v->bands;

	cli_note(&j->cli, 1, "%-10s %8.1f %8.1f %8.1f %8.1f %8.1f %8ld", name, of * (double)b[0],
		of * (double)b[1], of * (double)b[2], of * (double)b[3], of * (double)b[4], v->outside);
}

/* What statistics.json says, without the relations. */
static void note_statistics(const struct job *j)
{
	const struct synth_statistics *s = &j->statistics;

	cli_note(&j->cli, 1, "%d objects: %d in %d groups of look-alikes, %d on others; %zu Gaussians",
		s->objects, s->alike, s->alike_groups, s->stacked, s->gaussians);
	cli_note(&j->cli, 1, "training: %d views, %d sentences of %.1f words", s->views[SPLIT_TRAIN],
		s->sentences[SPLIT_TRAIN], s->words[SPLIT_TRAIN]);
	cli_note(&j->cli, 1, "test: %d views, %d sentences of %.1f words", s->views[SPLIT_TEST],
		s->sentences[SPLIT_TEST], s->words[SPLIT_TEST]);
	cli_note(&j->cli, 1, "%-10s %8s %8s %8s %8s %8s", "quantile", "5%", "25%", "50%", "75%", "95%");
	note_quantiles(j, "opacity", s->opacity);
	note_quantiles(j, "aspect", s->aspect);
	note_quantiles(j, "size", s->size);
	cli_note(&j->cli, 1, "%-10s %8s %8s %8s %8s %8s %8s", "% visible", synth_statistics_band(0),
		synth_statistics_band(1), synth_statistics_band(2), synth_statistics_band(3),
		synth_statistics_band(4), "outside");
	note_visibility(j, "training", SPLIT_TRAIN);
	note_visibility(j, "test", SPLIT_TEST);
}

int main(int argc, char **argv)
{
	long long objects = 0, views = 0, gaussians = 0;
	int number = 0, size[2] = {0};
	struct job j = {0};
	struct err e = {0};
	const struct cli_option options[] = {
		{"scene", 0, CLI_CHOICE, &number, "table|diner|toys|tea|kitchen",
			"what is made (default table)", 0, 0},
		{"objects", 0, CLI_INT, &objects, "K", "objects (default: the scene's; of the table 8)",
			SYNTH_MIN_OBJECTS, SYNTH_MAX_OBJECTS},
		{"views", 0, CLI_INT, &views, "V",
			"views for training and testing (default: the scene's; of the table 25)",
			SYNTH_MIN_VIEWS, SYNTH_MAX_VIEWS},
		{"size", 0, CLI_SIZE, size, "WxH",
			"size of the photographs in pixels (default 492x364; of the table 320x240)", 16,
			4096},
		{"gaussians", 0, CLI_INT, &gaussians, "N", "Gaussians (default 60000; of the table 20000)",
			1000, 10000000},
		{0},
	};
	const struct cli_tool tool = {
		.name = "gs-synth",
		.operands = "-o DIR",
		.summary =
			"Make a synthetic table-top scene with photographs, sentences, candidate masks and their truth.",
		.options = options,
		.common = CLI_OUTPUT | CLI_SEED | CLI_THREADS | CLI_VERBOSE | CLI_QUIET,
		.output_arg = "DIR",
		.needs_output = 1,
	};

	cli_parse(&j.cli, &tool, argc, argv);
	if (!strcmp(j.cli.output, "-"))
		cli_usage(&j.cli, "-o must name a folder");
	const struct synth_preset *p = synth_preset(number);
	j.options = (struct synth_options){p, 0, objects ? (int)objects : p->objects,
		views ? (int)views : p->views, size[0] ? size[0] : p->width, size[0] ? size[1] : p->height,
		gaussians ? (size_t)gaussians : p->gaussians};
	int bad = make(&j, number, &e) || write_folder(&j, &e);
	if (!bad)
		note_statistics(&j);
	free(j.sentences);
	synth_unseen_free(&j.unseen);
	synth_scene_free(&j.scene);
	return bad ? cli_fail(&j.cli, &e) : cli_done(&j.cli);
}
