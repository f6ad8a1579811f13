/* What a model costs in each precision, in bytes and in the error of its responses. A JSON line for each:
 * errors are relative to the root mean square of the exact responses, over all sentences and Gaussians.
 *
 *	bench_storage [SCENE TEXT MODEL [DIR]]
 *
 * MODEL should be of --precision f32, else the errors are only those that come on top. DIR, which must exist,
 * keeps the files, as f32.safetensors and so on. Without arguments, a model of random numbers. */
#include "answer/respond.h"
#include "base/file.h"
#include "base/mem.h"
#include "base/rng.h"
#include "formats/scene/model.h"
#include "formats/scene/scene.h"
#include "formats/scene/text.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum { GAUSSIANS = 40000, SENTENCES = 8, WORDS = 6, WIDTH = 384, FEATURE = 16 };

/* A model and what it is asked. */
struct problem {
	struct scene scene;
	struct text text;
	struct model model;
	float *means, *words; /* (N,3) and (words, D_text): of the scene and the text, or made */
	int64_t *offsets;
	size_t *which, count;
};

static void give_up(const struct err *e)
{
	fprintf(stderr, "bench_storage: %s\n", e->message);
	exit(4);
}

static void *need(size_t count, size_t size)
{
	struct err e;
	void *p = mem_zalloc(count, size, "benchmark", &e);

	if (!p)
		give_up(&e);
	return p;
}

static void read_problem(struct problem *p, char **path)
{
	struct err e;

	if (scene_read(&p->scene, path[0], &e) || text_read(&p->text, path[1], &e) ||
		model_read(&p->model, path[2], &e))
		give_up(&e);
	if (p->model.scene_gaussians != p->scene.splats.n || p->model.layout.text_width != p->text.width) {
		err_set(&e, ERR_FORMAT, "%s: is of another scene or other sentences", path[2]);
		give_up(&e);
	}
	p->means = p->scene.splats.means;
	p->words = p->text.words;
	p->offsets = p->text.offsets;
	p->count = p->text.n;
}

/* Features spread as those of a trained model, the networks as training begins. */
static void make_problem(struct problem *p)
{
	struct model *m = &p->model;
	struct rng r;

	rng_seed(&r, 1, 1);
	*m = (struct model){
		.scene_gaussians = GAUSSIANS, .n = GAUSSIANS, .low = {-1, -1, -1}, .high = {1, 1, 1}};
	refer_layout_init(&m->layout, REFER_PCMI, WIDTH, FEATURE);
	m->ids = need(GAUSSIANS, sizeof *m->ids);
	m->features = need(GAUSSIANS * FEATURE, sizeof(float));
	m->parameters = need(m->layout.count, sizeof(float));
	p->means = need(GAUSSIANS * 3, sizeof(float));
	p->words = need(SENTENCES * WORDS * WIDTH, sizeof(float));
	p->offsets = need(SENTENCES + 1, sizeof *p->offsets);
	p->count = SENTENCES;
	refer_init(&m->layout, m->parameters, &r);
	for (int i = 0; i < GAUSSIANS; i++)
		m->ids[i] = i;
	for (int i = 0; i < GAUSSIANS * FEATURE; i++)
		m->features[i] = (float)rng_normal(&r);
	for (int i = 0; i < GAUSSIANS * 3; i++)
		p->means[i] = (float)rng_range(&r, -1, 1);
	for (int i = 0; i < SENTENCES * WORDS * WIDTH; i++)
		p->words[i] = (float)rng_normal(&r);
	for (int i = 0; i <= SENTENCES; i++)
		p->offsets[i] = i * WORDS;
}

static void respond(const struct problem *p, const struct model *m, float *out)
{
	struct rows rows = {0};
	const struct respond_model answers = {&m->layout, m->similarity, &rows, m->blend, m->features,
		m->parameters, p->means, m->low, m->high};
	struct err e;

	if (model_rows(m, p->means, &rows, &e) ||
		respond_all(&answers, p->offsets, p->words, p->which, p->count, out, &e))
		give_up(&e);
	rows_free(&rows);
}

/* Writes the model in a precision, reads it back, and compares its responses with the exact ones. */
static void measure(const struct problem *p, enum precision precision, const char *dir, const float *exact,
	float *responses)
{
	const size_t count = p->count * p->model.scene_gaussians;
	double squares = 0, error = 0, worst = 0;
	struct model m = p->model;
	struct stat st;
	struct err e;
	char *path = file_join(dir, precision_name(precision), ".safetensors", &e);

	m.precision = precision;
	if (!path || model_write(&m, path, "bench_storage", 1, &e) || model_read(&m, path, &e))
		give_up(&e);
	if (stat(path, &st)) {
		err_errno(&e, "%s", path);
		give_up(&e);
	}
	respond(p, &m, responses);
	for (size_t i = 0; i < count; i++) {
		const double difference = (double)responses[i] - (double)exact[i];
		squares += (double)exact[i] * (double)exact[i];
		error += difference * difference;
		worst = fmax(worst, fabs(difference));
	}
	printf("{\"bench\":\"storage\",\"precision\":\"%s\",\"gaussians\":%zu,\"parameters\":%zu,\"bytes\":%lld,"
	       "\"response_rms_error\":%.3e,\"response_max_error\":%.3e}\n",
		precision_name(precision), m.n, m.layout.count, (long long)st.st_size, sqrt(error / squares),
		worst / sqrt(squares / (double)count));
	model_free(&m);
	free(path);
}

int main(int argc, char **argv)
{
	char temporary[] = "/tmp/bench_storage.XXXXXX";
	struct problem p = {0};
	struct err e;

	if (argc != 1 && argc != 4 && argc != 5) {
		fprintf(stderr, "usage: bench_storage [SCENE TEXT MODEL [DIR]]\n");
		return 2;
	}
	if (argc == 1)
		make_problem(&p);
	else
		read_problem(&p, argv + 1);
	if (argc < 5 && !mkdtemp(temporary)) {
		err_errno(&e, "%s", temporary);
		give_up(&e);
	}
	const char *dir = argc == 5 ? argv[4] : temporary;
	const size_t responses = p.count * p.model.scene_gaussians;
	float *exact = need(responses, 2 * sizeof *exact);
	p.which = need(p.count, sizeof *p.which);
	for (size_t i = 0; i < p.count; i++)
		p.which[i] = i;
	respond(&p, &p.model, exact);
	for (int precision = 0; precision < PRECISIONS; precision++) {
		measure(&p, (enum precision)precision, dir, exact, exact + responses);
		char *path = file_join(dir, precision_name((enum precision)precision), ".safetensors", &e);
		if (argc < 5 && path)
			unlink(path);
		free(path);
	}
	if (argc < 5)
		rmdir(temporary);
	return 0;
}
