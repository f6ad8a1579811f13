#include "cmd/train/fitting.h"
#include "cmd/train/training.h"

#include "base/mem.h"

#include <stdio.h>
#include <unistd.h>

enum { MEBIBYTE = 1 << 20 };

/* Beside the model, where its checkpoints go too; for stdout in the folder for temporary files. */
static char *scratch_path(const char *output, struct err *e)
{
	const char *folder = getenv("TMPDIR"), *name = strcmp(output, "-") ? output : "refer-train";

	if (name == output)
		folder = "";
	else if (!folder || !*folder)
		folder = "/tmp";
	const size_t bytes = strlen(folder) + strlen(name) + sizeof "/.weights";
	char *path = mem_alloc(bytes, 1, "path", e);
	if (path)
		snprintf(path, bytes, "%s%s%s.weights", folder, *folder ? "/" : "", name);
	return path;
}

static int start(struct learning *l, const struct report *to, struct err *e)
{
	const struct learning_options *o = l->options;
	struct training *d = &l->data;

	l->scratch = scratch_path(o->output, e);
	if (!l->scratch)
		return -1;
	const struct row_views_room room = {(size_t)o->memory * MEBIBYTE, l->scratch};
	const struct trainer_source source = training_source(d, &room);
	l->divergence.layout = &l->trainer.layout;
	l->of = training_identity(d, &o->from, &o->trainer);
	if (trainer_init(&l->trainer, &source, &o->trainer, e))
		return e->code == ERR_FORMAT ? err_prefix(e, o->from.weights) : -1;
	report_note(to, 1, "%zu of %zu Gaussians share %zu features, %.1f a pixel", l->trainer.learning,
		d->scene.splats.n, l->trainer.rows.n, trainer_weights(&l->trainer));
	report_note(to, 1, "%zu views, %zu sentences, %zu pairs", d->views.n, d->sentences, d->pairs);
	if (l->trainer.views.filed)
		report_note(to, 1, "the weights of %zu views are in a file, %.0f MiB", l->trainer.views.filed,
			(double)l->trainer.views.file.end / MEBIBYTE);
	return 0;
}

/* Goes on from a checkpoint where that is wanted. */
static int resume(struct learning *l, const struct report *to, struct err *e)
{
	const struct learning_options *o = l->options;

	if (!fitting_resumes(o->checkpoint_path, o->is_resumed, o->checkpoint > 0, to))
		return 0;
	if (checkpoint_resume(&l->trainer.state, o->checkpoint_path, &l->of, o->iterations, e))
		return -1;
	l->is_own = 1;
	report_note(to, 1, "going on after step %ld", l->trainer.state.iteration);
	return 0;
}

/* What is due after a step: lines of the log, a checkpoint. */
static int record(struct learning *l, const struct step_losses *last, struct err *e)
{
	const struct learning_options *o = l->options;
	struct train_state *t = &l->trainer.state;
	const long done = t->iteration;

	if (divergence_check(&l->divergence, t, last, done >= o->iterations, e))
		return err_prefix(e, file_name(o->output));
	if (done % TRAINLOG_EVERY == 0)
		snprintf(l->note, sizeof l->note, "loss %.4f", t->sum.total / TRAINLOG_EVERY);
	if (trainlog_step(&l->log, t, e))
		return -1;
	if (!o->checkpoint || done % o->checkpoint || done >= o->iterations ||
		!divergence_is_good(&l->divergence, t))
		return 0;
	const int bad = checkpoint_write(t, o->checkpoint_path, &l->of, e);
	l->is_own |= !bad;
	return bad;
}

/* Leaves what --resume goes on from. Always -1. */
static int stop(struct learning *l, struct err *e)
{
	const struct learning_options *o = l->options;
	const struct train_state *t = &l->trainer.state;
	const int is_kept = o->checkpoint && t->iteration && divergence_is_good(&l->divergence, t);

	if (is_kept && checkpoint_write(t, o->checkpoint_path, &l->of, e))
		return -1;
	l->is_stopped = 1;
	return err_set(e, ERR_SYSTEM, "stopped after step %ld%s%s", t->iteration,
		is_kept ? "; --resume goes on from " : "", is_kept ? o->checkpoint_path : "");
}

static int take_steps(struct learning *l, const struct report *to, struct err *e)
{
	const struct learning_options *o = l->options;
	struct train_state *t = &l->trainer.state;
	const long begin = t->iteration;
	int bad = 0;

	report_start(to, "steps", (double)(o->iterations - begin));
	while (t->iteration < o->iterations && !bad) {
		if (o->stop && *o->stop) {
			bad = stop(l, e);
			break;
		}
		struct step_losses last;
		bad = trainer_step(&l->trainer, &last, e) || record(l, &last, e);
		report_step(to, (double)(t->iteration - begin), *l->note ? l->note : NULL);
	}
	report_end(to);
	return bad;
}

static int learn_from(struct learning *l, const struct report *to, struct err *e)
{
	const struct learning_options *o = l->options;
	struct training *d = &l->data;

	if (training_read(d, &o->from, &o->trainer, to, e))
		return -1;
	if (d->left_out)
		report_warn(to, "%s: %zu training sentences without words are left out", o->from.text,
			d->left_out);
	if (d->test_masks)
		report_note(to, 1, "%zu masks of test views are not used", d->test_masks);
	if (file_out_claim(&l->claim, o->output, e) ||
		(o->checkpoint_path && file_out_probe(o->checkpoint_path, e)) || start(l, to, e) ||
		resume(l, to, e) || trainlog_open(&l->log, o->log, l->trainer.state.iteration, e))
		return -1;
	if (take_steps(l, to, e) || training_write(d, &l->trainer, &o->trainer, o->precision, o->output,
					    l->of.identity, o->trainer.seed, e))
		return -1;
	if (l->is_own)
		unlink(o->checkpoint_path);
	return 0;
}

int learn(struct learning *l, const struct learning_options *options, const struct report *to, struct err *e)
{
	struct err late;

	l->options = options;
	int bad = learn_from(l, to, e);
	file_out_abort(&l->claim);
	if (trainlog_close(&l->log, &late) && !bad) {
		*e = late;
		bad = -1;
	}
	return bad ? -1 : 0;
}

void learning_free(struct learning *l)
{
	trainer_free(&l->trainer);
	free(l->scratch);
	training_free(&l->data);
}
