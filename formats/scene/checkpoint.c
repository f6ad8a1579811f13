#include "formats/scene/checkpoint.h"

#include "base/mem.h"
#include "base/number.h"
#include "formats/arrays/arrays_in.h"

#include <limits.h>
#include <math.h>
#include <stdio.h>

enum { ARRAYS = 3 };

static const char *const names[ARRAYS] = {"values", "first_moment", "second_moment"};

void checkpoint_identity(char text[CHECKPOINT_IDENTITY], const struct trainer_options *o, uint32_t inputs)
{
	char temperature[NUMBER_SIZE], lambda[NUMBER_SIZE], features[NUMBER_SIZE], mlps[NUMBER_SIZE],
		tolerance[NUMBER_SIZE], share[NUMBER_SIZE];

	snprintf(text, CHECKPOINT_IDENTITY,
		"--interaction %s --similarity %s --query %s --contrast %s --feature-width %lld --temperature %s --lambda %s --feature-rate %s --mlp-rate %s "
		"--batch %lld --negatives %lld --tolerance %s --share %s --init-iterations %lld --seed %lld, inputs %08x",
		refer_interaction_name(o->interaction), refer_similarity_name(o->similarity),
		refer_query_name(o->query), refer_contrast_name(o->contrast), o->feature_width,
		number_text(temperature, o->temperature), number_text(lambda, o->lambda),
		number_text(features, o->rates.features), number_text(mlps, o->rates.mlps), o->batch,
		o->negatives, number_text(tolerance, o->tolerance), number_text(share, o->share), o->warm,
		o->seed, (unsigned)inputs);
}

char *checkpoint_path(const char *model, struct err *e)
{
	const size_t bytes = strlen(model) + sizeof ".checkpoint";
	char *path = mem_alloc(bytes, 1, model, e);

	if (path)
		snprintf(path, bytes, "%s.checkpoint", model);
	return path;
}

int checkpoint_write(
	const struct train_state *t, const char *path, const struct checkpoint_of *of, struct err *e)
{
	const float *arrays[ARRAYS] = {t->values, t->m, t->v};
	const double losses[3] = {t->sum.bce, t->sum.contrast, t->sum.total};
	struct arrays_out out;

	arrays_out_begin(&out, path, "refer.checkpoint", "1", "refer-train", NULL, 0, e);
	arrays_out_text(&out, "iteration", arrays_out_print(&out, "%ld", t->iteration));
	arrays_out_text(&out, "identity", of->identity);
	origin_put(&out, &of->origin);
	arrays_out_put(&out, st_vector("losses", ST_F64, 3, losses));
	for (int i = 0; i < ARRAYS; i++)
		arrays_out_put(&out, st_vector(names[i], ST_F32, (int64_t)t->count, arrays[i]));
	return arrays_out_end(&out);
}

/* Finite doubles, at most 3. */
static void read_numbers(struct arrays_in *in, const char *name, double *to, int count)
{
	const double *from = arrays_in_place(in, name, ST_F64, count, NULL);

	for (int i = 0; i < count && !in->bad; i++)
		if (!isfinite(to[i] = from[i]))
			in->bad =
				err_file(in->e, in->st->path, "tensor '%s': item %d is not finite", name, i);
}

/* A whole number of the metadata, as a long. */
static long read_count(struct arrays_in *in, const char *key, long long least, long long most)
{
	long long count = 0;

	in->bad = in->bad || safetensors_meta_int(in->st, key, least, most, &count, in->e);
	return (long)count;
}

/* That it is of this training: of this scene and encoder, which have messages of their own, with these
 * options and inputs. */
static int check_training(const struct safetensors *st, const struct checkpoint_of *of, struct err *e)
{
	struct origin own;

	if (origin_read(&own, st, e) ||
		fingerprint_check("scene", st->path, &own.scene, of->scene_path, &of->origin.scene, e) ||
		fingerprint_check("encoder", st->path, &own.encoder, of->text_path, &of->origin.encoder, e))
		return -1;
	const char *identity = safetensors_meta(st, "identity");
	if (!identity || strcmp(identity, of->identity))
		return err_file(e, st->path,
			"is of another training (its options or inputs differ); remove it or train without --resume");
	return 0;
}

static int read_state(
	struct train_state *t, const struct safetensors *st, const struct checkpoint_of *of, struct err *e)
{
	float *arrays[ARRAYS] = {t->values, t->m, t->v};
	double losses[3];
	struct arrays_in in;

	arrays_in_begin(&in, st, "refer.checkpoint", 1, e);
	in.bad = in.bad || check_training(st, of, e);
	const long iteration = read_count(&in, "iteration", 1, LONG_MAX);
	for (size_t i = 0; i < ARRAYS; i++)
		arrays_in_fill(&in, names[i], arrays[i], t->count);
	for (size_t i = 0; i < t->count && !in.bad; i++)
		if (t->v[i] < 0)
			in.bad = err_file(e, st->path, "tensor 'second_moment': item %zu is negative", i);
	read_numbers(&in, "losses", losses, 3);
	if (in.bad)
		return -1;
	t->sum = (struct step_losses){losses[0], losses[1], losses[2]};
	t->iteration = iteration;
	return 0;
}

int checkpoint_read(struct train_state *t, const char *path, const struct checkpoint_of *of, struct err *e)
{
	SCOPED_BY(safetensors_close) struct safetensors st = {0};

	if (safetensors_open(&st, path, e))
		return -1;
	return read_state(t, &st, of, e);
}

int checkpoint_resume(struct train_state *t, const char *path, const struct checkpoint_of *of, long long most,
	struct err *e)
{
	if (checkpoint_read(t, path, of, e))
		return -1;
	return t->iteration > most
		       ? err_file(e, path, "has %ld steps, more than the %lld asked for", t->iteration, most)
		       : 0;
}
