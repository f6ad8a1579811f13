#include "unit.h"

#include "base/rng.h"
#include "mask/trace.h"

enum { SIDE = 24 };

/* Whether a pixel is inside all lines together: the upright sides to the left of it, with their signs. */
static int inside(const struct trace *t, int x, int y)
{
	int turns = 0;
	size_t first = 0;

	for (size_t i = 0; i < t->n; i++) {
		first = t->corners[i].is_first ? i : first;
		const int ends = i + 1 == t->n || t->corners[i + 1].is_first;
		const struct trace_corner *a = &t->corners[i], *b = &t->corners[ends ? first : i + 1];
		if (a->x == b->x && a->x <= x)
			turns += (a->y <= y && b->y > y ? -1 : 0) + (b->y <= y && a->y > y ? 1 : 0);
	}
	return turns;
}

static int sides_alternate(const struct trace *t)
{
	size_t first = 0;
	int fine = 1;

	for (size_t i = 0; i < t->n; i++) {
		first = t->corners[i].is_first ? i : first;
		const int ends = i + 1 == t->n || t->corners[i + 1].is_first;
		const struct trace_corner *a = &t->corners[i], *b = &t->corners[ends ? first : i + 1];
		fine &= (i - first) % 2 ? a->x == b->x && a->y != b->y : a->y == b->y && a->x != b->x;
	}
	return fine;
}

static void check_mask(const uint8_t *mask, int height, int width, const char *what)
{
	struct trace t;
	struct err e;
	int wrong = 0;

	CHECK(!trace_mask(&t, mask, height, width, &e), "%s", what);
	for (int y = 0; y < height; y++)
		for (int x = 0; x < width; x++)
			wrong += inside(&t, x, y) != mask[y * width + x];
	CHECK(!wrong, "%s: %d pixels are not what is inside the lines", what, wrong);
	CHECK(sides_alternate(&t), "%s: level and upright sides alternate", what);
	trace_free(&t);
}

static void corners_that_touch(void)
{
	const uint8_t mask[4] = {1, 0, 0, 1};
	struct trace t;
	struct err e;
	size_t lines = 0;

	CHECK(!trace_mask(&t, mask, 2, 2, &e), "two pixels");
	for (size_t i = 0; i < t.n; i++)
		lines += (size_t)t.corners[i].is_first;
	CHECK(lines == 2 && t.n == 8, "%zu lines, %zu corners", lines, t.n);
	trace_free(&t);
}

int main(void)
{
	uint8_t mask[SIDE * SIDE];
	struct rng r;

	rng_seed(&r, 7, 1);
	for (int k = 0; k < 60; k++) {
		const int height = 1 + (int)rng_below(&r, SIDE), width = 1 + (int)rng_below(&r, SIDE);
		for (int p = 0; p < height * width; p++)
			mask[p] = rng_below(&r, 4) < (uint64_t)(k % 5);
		check_mask(mask, height, width, "noise");
	}
	corners_that_touch();
	return unit_end();
}
