#include "formats/checkpoint.h"

#include "base/mem.h"
#include "base/number.h"
#include "formats/safetensors.h"

#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

enum { ARRAYS = 3 };

static const char *const names[ARRAYS] = {"values", "first_moment", "second_moment"};

void checkpoint_identity(char text[CHECKPOINT_IDENTITY], const struct trainer_options *o, uint32_t inputs)
{
	char temperature[NUMBER_SIZE], lambda[NUMBER_SIZE], features[NUMBER_SIZE], mlps[NUMBER_SIZE],
		tolerance[NUMBER_SIZE], share[NUMBER_SIZE];

	snprintf(text, CHECKPOINT_IDENTITY,
		"--interaction %s --similarity %s --contrast %s --feature-width %lld --temperature %s --lambda %s --feature-rate %s --mlp-rate %s "
		"--batch %lld --negatives %lld --tolerance %s --share %s --seed %lld, inputs %08x",
		refer_interaction_name(o->interaction), refer_similarity_name(o->similarity),
		refer_contrast_name(o->contrast), o->feature_width, number_text(temperature, o->temperature),
		number_text(lambda, o->lambda), number_text(features, o->rates.features),
		number_text(mlps, o->rates.mlps), o->batch, o->negatives,
		number_text(tolerance, o->tolerance), number_text(share, o->share), o->seed,
		(unsigned)inputs);
}

char *checkpoint_path(const char *model, struct err *e)
{
	const size_t bytes = strlen(model) + sizeof ".checkpoint";
	char *path = mem_alloc(bytes, 1, model, e);

	if (path)
		snprintf(path, bytes, "%s.checkpoint", model);
	return path;
}

int checkpoint_write(const struct train_state *t, const char *path, const char *identity, struct err *e)
{
	const float *arrays[ARRAYS] = {t->values, t->m, t->v};
	const double losses[3] = {t->sum.bce, t->sum.contrast, t->sum.total};
	struct st_tensor tensors[ARRAYS + 1] = {
		{.name = "losses", .dtype = ST_F64, .dims = 1, .shape = {3}, .data = losses}};
	char iteration[32];
	const struct st_meta meta[] = {{"format", "refer.checkpoint"}, {"version", "1"},
		{"tool", "refer-train"}, {"iteration", iteration}, {"identity", identity}};

	for (int i = 0; i < ARRAYS; i++)
		tensors[i + 1] = (struct st_tensor){.name = names[i],
			.dtype = ST_F32,
			.dims = 1,
			.shape = {(int64_t)t->count},
			.data = arrays[i]};
	snprintf(iteration, sizeof iteration, "%ld", t->iteration);
	return safetensors_write(path, tensors, ARRAYS + 1, meta, sizeof meta / sizeof *meta, e);
}

static int read_array(float *to, size_t count, const struct safetensors *st, const char *name, struct err *e)
{
	const struct st_tensor *tensor =
		safetensors_need(st, name, ST_F32, 1, (int64_t[]){(int64_t)count}, e);

	if (!tensor)
		return -1;
	memcpy(to, tensor->data, tensor->bytes);
	for (size_t i = 0; i < count; i++)
		if (!isfinite(to[i]))
			return err_set(
				e, ERR_FORMAT, "%s: tensor '%s': item %zu is not finite", st->path, name, i);
	return 0;
}

static int read_state(
	struct train_state *t, const struct safetensors *st, const char *identity, struct err *e)
{
	float *arrays[ARRAYS] = {t->values, t->m, t->v};
	long long iteration;
	double losses[3];

	if (safetensors_need_format(st, "refer.checkpoint", 1, e))
		return -1;
	const char *own = safetensors_meta(st, "identity");
	if (!own || strcmp(own, identity))
		return err_set(e, ERR_FORMAT,
			"%s: is of another training (its options or inputs differ); remove it or train without --resume",
			st->path);
	if (safetensors_meta_int(st, "iteration", 1, LONG_MAX, &iteration, e))
		return -1;
	for (int i = 0; i < ARRAYS; i++)
		if (read_array(arrays[i], t->count, st, names[i], e))
			return -1;
	for (size_t i = 0; i < t->count; i++)
		if (t->v[i] < 0)
			return err_set(e, ERR_FORMAT, "%s: tensor 'second_moment': item %zu is negative",
				st->path, i);
	const struct st_tensor *sums = safetensors_need(st, "losses", ST_F64, 1, (int64_t[]){3}, e);
	if (!sums)
		return -1;
	memcpy(losses, sums->data, sizeof losses);
	for (int i = 0; i < 3; i++)
		if (!isfinite(losses[i]))
			return err_set(
				e, ERR_FORMAT, "%s: tensor 'losses': item %d is not finite", st->path, i);
	t->sum = (struct step_losses){losses[0], losses[1], losses[2]};
	t->iteration = (long)iteration;
	return 0;
}

int checkpoint_read(struct train_state *t, const char *path, const char *identity, struct err *e)
{
	struct safetensors st;

	if (safetensors_open(&st, path, e))
		return -1;
	int bad = read_state(t, &st, identity, e);
	safetensors_close(&st);
	return bad;
}
