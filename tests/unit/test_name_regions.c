/* Regions that sentences name (ask/name_regions.h), in the scene of choose_scene.h, whose four objects are
 * the regions: by colour, by where they are to one that is named, by a detector's word; in any order. */
#include "ask/name_regions.h"
#include "choose_scene.h"

enum { NAMED = 3, EXTRA = 1, MOST_REGIONS = OBJECTS + EXTRA };

static char *called[NAMED + MOST_REGIONS] = {"one", "two", "three", "", "", "", "", ""};
static const char *said[NAMED] = {"the red box", "the mug to the left of the red box", "the bottle"};
static char *classes[] = {"bottle"};

struct trial {
	size_t count;		    /* regions */
	size_t shows[MOST_REGIONS]; /* the object of the scene that each has the Gaussians of */
	size_t of[NAMED];	    /* which of `said` each thing is told by */
	float score[MOST_REGIONS], votes[MOST_REGIONS];
};

/* region (NAMED) gets the objects of the scene that things are, or OBJECTS. */
static void name(const struct trial *t, size_t *region, double *chance)
{
	static float vectors[NAMED * 16 * WIDTH], have[(NAMED + MOST_REGIONS) * EACH];
	static int32_t of_object[NAMED], at[(NAMED + MOST_REGIONS) * EACH];
	char *texts[NAMED];
	int64_t from[NAMED + 1] = {0}, begin[NAMED + MOST_REGIONS + 1] = {0};
	float sure[NAMED + MOST_REGIONS], agree[MOST_REGIONS * MOST_REGIONS];
	struct err e;

	for (size_t r = 0; r < NAMED; r++) {
		of_object[r] = (int32_t)r;
		texts[r] = (char *)said[t->of[r]];
		from[r + 1] = from[r] + (int64_t)encode(texts[r], vectors + (size_t)from[r] * WIDTH);
	}
	for (size_t o = 0; o < NAMED + t->count; o++) {
		sure[o] = 1;
		begin[o + 1] = begin[o] + (o < NAMED ? 0 : EACH);
		for (int i = 0; i < EACH && o >= NAMED; i++) {
			at[begin[o] + i] = (int32_t)t->shows[o - NAMED] * EACH + i;
			have[begin[o] + i] = 1;
		}
	}
	for (size_t i = 0; i < t->count * t->count; i++)
		agree[i] = t->shows[i / t->count] == t->shows[i % t->count];
	const struct lifted l = {N, NAMED + t->count, called, sure, begin, at, have, NAMED, WIDTH, of_object,
		texts, texts, from, vectors, NULL, NULL, NULL};
	const struct region_facts facts = {t->count, t->score, agree, 1, classes, t->votes};
	if (!CHECK(!name_regions(&l, NAMED, &facts, &splats, &cameras, &parser, region, chance, &e), "%s",
		    e.message))
		exit(1);
	for (size_t o = 0; o < NAMED; o++) {
		CHECK(chance[o] >= 0 && chance[o] <= 1, "%g", chance[o]);
		region[o] = region[o] == REGION_NONE ? OBJECTS : t->shows[region[o]];
	}
}

static const struct trial plain = {
	OBJECTS, {0, 1, 2, 3}, {0, 1, 2}, {0.5f, 0.5f, 0.5f, 0.5f, 0.5f}, {0, 0.9f, 0, 0, 0}};
static const size_t right[NAMED] = {2, 0, 1};

static void test_right(void)
{
	size_t region[NAMED];
	double chance[NAMED];

	name(&plain, region, chance);
	for (size_t o = 0; o < NAMED; o++)
		CHECK(region[o] == right[o] && chance[o] > 0.4, "'%s' is %zu by %g", said[o], region[o],
			chance[o]);
}

/* Any order of regions and of things, and a region more that shows nothing else. */
static void test_order(void)
{
	for (size_t turn = 0; turn < OBJECTS * NAMED; turn++)
		for (size_t more = 0; more <= EXTRA; more++) {
			struct trial t = plain;
			size_t region[NAMED];
			double chance[NAMED];
			t.count = OBJECTS + more;
			t.shows[OBJECTS] = 3;
			for (size_t k = 0; k < OBJECTS; k++) {
				t.shows[k] = (k + turn) % OBJECTS;
				t.votes[k] = t.shows[k] == 1 ? 0.9f : 0;
			}
			t.score[OBJECTS] = 0.1f;
			for (size_t o = 0; o < NAMED; o++)
				t.of[o] = (o + turn) % NAMED;
			name(&t, region, chance);
			for (size_t o = 0; o < NAMED; o++)
				CHECK(region[o] == right[t.of[o]], "turn %zu, %zu more: '%s' is %zu", turn,
					more, said[t.of[o]], region[o]);
		}
}

/* A region is of one thing only, and so the last has none. */
static void test_few(void)
{
	struct trial t = plain;
	size_t region[NAMED];
	double chance[NAMED];

	t.count = 2;
	t.shows[0] = 2;
	t.votes[0] = 0;
	name(&t, region, chance);
	CHECK((region[0] == OBJECTS) + (region[1] == OBJECTS) + (region[2] == OBJECTS) == 1, "%zu %zu %zu",
		region[0], region[1], region[2]);
	CHECK(region[0] == 2, "the red box is %zu", region[0]);
	for (size_t o = 0; o < NAMED; o++)
		CHECK((chance[o] > 0) == (region[o] != OBJECTS), "%g", chance[o]);
}

/* Of regions of one thing, the likelier thing. */
static void test_score(void)
{
	struct trial t = plain;
	size_t region[NAMED];
	double chance[NAMED];

	t.score[0] = 0.02f; /* the other mug is left of nothing, but is more of a thing */
	t.score[1] = 0.9f;
	t.votes[1] = 0;
	name(&t, region, chance);
	CHECK(region[0] == 2, "the red box is %zu", region[0]);
}

int main(void)
{
	make_scene();
	test_right();
	test_order();
	test_few();
	test_score();
	return unit_end();
}
