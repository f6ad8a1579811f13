/* The limit is absolute, so that nothing but train_state.sum needs to be kept in a checkpoint: none is
 * written while a window is bad, and a training that goes on from one counts as one that was never cut off.
 */
#include "train/divergence.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* Of the steps since the last whole window, or of that window itself. */
static int is_window_good(const struct train_state *t)
{
	const long part = t->iteration % DIVERGENCE_WINDOW;

	return t->sum.bce / (double)(part ? part : DIVERGENCE_WINDOW) <= DIVERGENCE_LIMIT;
}

static int is_finite(const struct train_state *t)
{
	for (size_t i = 0; i < t->count; i++)
		if (!isfinite(t->values[i]))
			return 0;
	return 1;
}

/* The value that is not finite, else the one furthest from 0; the first NaN where there is one. */
static size_t worst_value(const struct train_state *t)
{
	size_t worst = 0;

	for (size_t i = 0; i < t->count && !isnan(t->values[worst]); i++)
		if (isnan(t->values[i]) || fabsf(t->values[i]) > fabsf(t->values[worst]))
			worst = i;
	return worst;
}

/* Of the array that the i-th value of the slab belongs to. */
static const char *array_name(const struct divergence *d, const struct train_state *t, size_t i)
{
	const char *name = "a parameter";

	if (!d->layout)
		return name;
	if (i >= t->parameters)
		return "features";
	for (int k = 0; k < REFER_TENSORS; k++)
		if (d->layout->tensors[k].rows && d->layout->tensors[k].offset <= i)
			name = d->layout->tensors[k].name;
	return name;
}

static int fail(struct err *e, long step, const char *why)
{
	return err_set(e, ERR_CHECK, "training diverged after step %ld: %s; lower rates may help", step, why);
}

static int fail_in_array(
	const struct divergence *d, const struct train_state *t, const char *what, struct err *e)
{
	const size_t worst = worst_value(t);
	const char *name = array_name(d, t, worst);
	char why[160];

	if (!isfinite(t->values[worst]))
		snprintf(why, sizeof why, "%s%s not finite", name, strcmp(name, "features") ? " is" : " are");
	else
		snprintf(why, sizeof why, "%s is not finite, the largest value is %.3g, in %s", what,
			(double)t->values[worst], name);
	return fail(e, t->iteration - 1, why);
}

int divergence_check(struct divergence *d, const struct train_state *t, const struct step_losses *last,
	int is_end, struct err *e)
{
	const int is_whole = t->iteration % DIVERGENCE_WINDOW == 0;

	if (!isfinite(last->total))
		return fail_in_array(d, t, "the loss", e);
	if (!is_whole && !is_end)
		return 0;
	if (!is_finite(t))
		return fail_in_array(d, t, "a parameter", e);
	if (is_whole && is_window_good(t))
		d->windows = 0;
	else if (is_whole && !d->windows++)
		d->begin = t->iteration - DIVERGENCE_WINDOW;
	return d->windows >= (is_end ? DIVERGENCE_AT_END : DIVERGENCE_WINDOWS)
		       ? fail(e, d->begin, "the loss stays far above that of a model without answers")
		       : 0;
}

int divergence_is_good(const struct divergence *d, const struct train_state *t)
{
	/* The first steps of a good training are often far off. */
	const int is_start = t->iteration < DIVERGENCE_WINDOW;

	return !d->windows && (is_start || !t->sum.bce || is_window_good(t)) && is_finite(t);
}
