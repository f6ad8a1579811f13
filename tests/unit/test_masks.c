/* Mask records in memory: round trips, and input cut or changed at every byte. */
#include "formats/records/masks.h"
#include "mask_help.h"
#include "unit.h"

/* One record of a text: masks_next's value. */
static int parse(const char *text, size_t len, struct mask *r, struct err *e)
{
	struct jsonl j = {.in = fmemopen((void *)(size_t)text, len, "rb"), .path = "mem"};
	int got = j.in ? masks_next(&j, r, e) : -1;

	jsonl_close(&j);
	return got;
}

static char *print(const struct mask *r)
{
	char *text = NULL;
	size_t len;
	struct err e;
	FILE *out = open_memstream(&text, &len);

	if (masks_put(out, r, &e))
		fprintf(stderr, "%s\n", e.message);
	fclose(out);
	return text;
}

static void test_round_trips(void)
{
	struct rng rng;
	struct err e = {0};

	rng_seed(&rng, 5, 1);
	for (int round = 0; round < 100; round++) {
		int h = 1 + (int)rng_below(&rng, 30), w = 1 + (int)rng_below(&rng, 30);
		uint8_t *pixels = mask_random(&rng, h, w, round % 5);
		const char *view = "view \"1\"", *ref = "r\\1/%", *object = "r\xc3\xa4t";
		struct mask r = {view, round % 3 ? ref : NULL, round % 3 == 1 ? NULL : object,
			mask_rle(pixels, h, w), round % 4 ? rng_uniform(&rng) : NAN,
			round % 7 ? NAN : rng_uniform(&rng), NULL};
		struct mask back;
		char *text = print(&r);
		if (CHECK(parse(text, strlen(text), &back, &e) == 1, "round %d: %s", round, e.message)) {
			char *again = print(&back);
			CHECK(!strcmp(text, again), "%s became %s", text, again);
			CHECK(!strcmp(back.view, view) && !back.ref == !r.ref && !back.object == !r.object,
				"names");
			CHECK(isnan(r.score) ? isnan(back.score) : back.score == r.score, "%.17g",
				back.score);
			CHECK(isnan(r.visible) ? isnan(back.visible) : back.visible == r.visible, "%.17g",
				back.visible);
			free(again);
			mask_free(&back);
		}
		free(text);
		rle_free(&r.rle);
		free(pixels);
	}
}

static const char record[] =
	"{\"view\":\"v\",\"ref\":\"r\",\"score\":0.83,\"segmentation\":{\"size\":[3,2],\"counts\":\"132\"}}";

/* Every beginning of a record but the whole of it is an error on line 1; so is no beginning at all at the
 * end. */
static void test_cuts(void)
{
	struct mask r;
	struct err e;

	for (size_t len = 1; len < strlen(record); len++) {
		e = (struct err){0};
		CHECK(parse(record, len, &r, &e) == -1 && e.code == ERR_FORMAT &&
				!strncmp(e.message, "mem:1: not JSON", 15),
			"cut at %zu: %s", len, e.message);
	}
	CHECK(parse(record, strlen(record), &r, &e) == 1, "%s", e.message);
	mask_free(&r);
	CHECK(parse("\n", 1, &r, &e) == 0, "an empty line");
}

/* Changed bytes give a record or an error with a place, never anything else. The sanitisers watch. */
static void test_changes(void)
{
	struct rng rng;
	int good = 0, bad = 0;

	rng_seed(&rng, 6, 1);
	for (int round = 0; round < 20000; round++) {
		char text[sizeof record];
		struct mask r;
		struct err e = {0};
		memcpy(text, record, sizeof record);
		for (uint32_t i = 0; i <= rng_below(&rng, 3); i++)
			text[rng_below(&rng, (uint32_t)strlen(record))] = (char)(1 + rng_below(&rng, 255));
		int got = parse(text, strlen(record), &r, &e);
		if (got == 1) {
			good++;
			mask_free(&r);
		} else if (got < 0) {
			bad++;
			if (e.code != ERR_FORMAT || strncmp(e.message, "mem:", 4))
				CHECK(0, "%s: %s", text, e.message);
		}
	}
	CHECK(good > 100 && bad > 100, "%d good, %d bad", good, bad);
}

int main(void)
{
	test_round_trips();
	test_cuts();
	test_changes();
	return unit_end();
}
