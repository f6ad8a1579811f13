/* When a training counts as diverged, and which states a checkpoint may keep. */
#include "unit.h"

#include "train/divergence.h"

enum { COUNT = 16, BAD = 20 };

static float values[COUNT];

/* Steps `from` to `to` with this cross-entropy each, as refer-train takes them; 0, or -1 and the message. */
static int steps(struct divergence *d, struct train_state *t, long to, double bce, int is_end, struct err *e)
{
	const struct step_losses last = {.bce = bce, .total = bce};

	while (t->iteration < to) {
		t->iteration++;
		t->sum.bce += bce;
		if (divergence_check(d, t, &last, is_end && t->iteration == to, e))
			return -1;
		if (t->iteration % DIVERGENCE_WINDOW == 0)
			t->sum = (struct step_losses){0};
	}
	return 0;
}

static struct train_state start(void)
{
	return (struct train_state){.count = COUNT, .values = values};
}

static void ends(long good, long bad, int is_end, const char *expected)
{
	struct divergence d = {0};
	struct train_state t = start();
	struct err e = {0};
	int failed = steps(&d, &t, good, 1, 0, &e) || steps(&d, &t, good + bad, BAD, is_end, &e);

	CHECK(failed == (expected != NULL), "%ld good, %ld bad: '%s'", good, bad, e.message);
	CHECK(!expected || (e.code == ERR_CHECK && strstr(e.message, expected)), "%ld good, %ld bad: '%s'",
		good, bad, e.message);
}

/* The array at fault is named: in place of it stands the largest value where all are finite. */
static void names_the_array(void)
{
	static float all[200000];
	struct refer_layout layout;
	const struct step_losses bad = {.total = NAN};
	struct err e;

	refer_layout_init(&layout, REFER_PCMI, 24, 16);
	struct divergence d = {.layout = &layout};
	struct train_state t = {
		.parameters = layout.count, .count = layout.count + 64, .values = all, .iteration = 7};
	all[layout.tensors[FEATURE_1_WEIGHT].offset + 3] = -3e20f;
	CHECK(divergence_check(&d, &t, &bad, 0, &e) &&
			strstr(e.message,
				"after step 6: the loss is not finite, the largest value is -3e+20, in "
				"feature.1.weight; lower"),
		"'%s'", e.message);
	all[layout.tensors[TEXT_0_BIAS].offset] = INFINITY;
	CHECK(divergence_check(&d, &t, &bad, 0, &e) &&
			strstr(e.message, "after step 6: text.0.bias is not finite"),
		"'%s'", e.message);
	all[layout.count + 5] = NAN;
	CHECK(divergence_check(&d, &t, &bad, 0, &e) &&
			strstr(e.message, "after step 6: features are not finite"),
		"'%s'", e.message);
}

int main(void)
{
	struct divergence d = {0};
	struct train_state t = start();
	struct err e = {0};

	ends(500, 999, 0, NULL);
	ends(500, 1000, 0, "diverged after step 500:");
	ends(0, 1000, 0, "diverged after step 0:");
	ends(530, 1070, 0, "diverged after step 500:");
	ends(500, 100, 1, NULL);
	ends(500, 200, 1, "diverged after step 500:");
	ends(500, 250, 1, "diverged after step 500:");
	ends(0, 150, 1, NULL); /* as short as this, the start is all there is */
	/* bad for long, then good again */
	CHECK(!steps(&d, &t, 900, BAD, 0, &e) && !steps(&d, &t, 1000, 1, 0, &e) &&
			!steps(&d, &t, 1900, BAD, 0, &e),
		"'%s'", e.message);

	/* a checkpoint is of good states only */
	d = (struct divergence){0};
	t = start();
	CHECK(!steps(&d, &t, 20, BAD, 0, &e) && divergence_is_good(&d, &t), "the first steps");
	CHECK(!steps(&d, &t, 150, 1, 0, &e) && divergence_is_good(&d, &t), "good");
	CHECK(!steps(&d, &t, 300, BAD, 0, &e) && !divergence_is_good(&d, &t), "a bad window");
	CHECK(!steps(&d, &t, 350, 1, 0, &e) && !divergence_is_good(&d, &t), "a window that is not over");
	CHECK(!steps(&d, &t, 500, 1, 0, &e) && divergence_is_good(&d, &t), "good again");
	CHECK(!steps(&d, &t, 510, BAD, 0, &e) && !divergence_is_good(&d, &t), "a window that begins badly");
	CHECK(!steps(&d, &t, 600, 1, 0, &e) && divergence_is_good(&d, &t), "one that ends well");
	values[3] = NAN;
	CHECK(!divergence_is_good(&d, &t), "not finite");
	CHECK(steps(&d, &t, 700, 1, 0, &e) && strstr(e.message, "a parameter is not finite"), "'%s'",
		e.message);
	values[3] = 0;
	t = start();
	CHECK(steps(&d, &t, 7, INFINITY, 0, &e) && strstr(e.message, "after step 0: the loss is not finite,"),
		"'%s'", e.message);
	names_the_array();
	return unit_end();
}
