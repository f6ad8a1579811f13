/* Which mask teaches which sentence: by ref, by object, at the views' size, stored once, and no two of one.
 */
#include "base/mem.h"
#include "mask/bits.h"
#include "train/supervision.h"
#include "unit.h"

/* Adds a mask of a view, which names itself, at that size. */
static int add_pixels(struct supervision *s, size_t view, int width, int height, const char *ref,
	const char *object, const uint8_t *pixels, int mask_width, int mask_height)
{
	struct mask m = {0};
	char name[24];
	struct err e;

	snprintf(name, sizeof name, "v%zu", view);
	m.view = mem_strdup(name, &e);
	m.ref = ref ? mem_strdup(ref, &e) : NULL;
	m.object = object ? mem_strdup(object, &e) : NULL;
	return rle_encode(&m.rle, pixels, mask_height, mask_width, &e) ||
	       supervision_add(s, view, width, height, &m, &e);
}

/* A mask of `side` squared pixels, all of one value. */
static void add(
	struct supervision *s, size_t view, const char *ref, const char *object, int side, uint8_t value)
{
	uint8_t pixels[16];

	memset(pixels, value, sizeof pixels);
	CHECK(!add_pixels(s, view, 2, 2, ref, object, pixels, side, side), "view %zu", view);
}

/* A second mask of what a view has already, among others. */
static void test_second_mask(void)
{
	struct {
		const char *ref, *object;
		const char *message;
	} const seconds[] = {{NULL, "cup", "a second mask of object 'cup' in the same view"},
		{"r2", "pan", "a second mask of ref 'r2' in the same view"}, {"cup", NULL, NULL},
		{NULL, "r2", NULL}};

	for (size_t i = 0; i < sizeof seconds / sizeof *seconds; i++) {
		struct supervision s = {0};
		struct err e = {0};
		size_t later = 99;
		add(&s, 0, NULL, "cup", 2, 0);
		add(&s, 0, "r2", "cup", 2, 1);
		add(&s, 1, seconds[i].ref, seconds[i].object, 2, 1);
		add(&s, 0, seconds[i].ref, seconds[i].object, 2, 1);
		add(&s, 0, "r3", "cup", 2, 1);
		int bad = supervision_index(&s, &later, &e);
		CHECK(!bad == !seconds[i].message, "%zu: %s", i, e.message);
		CHECK(!bad || (later == 3 && e.code == ERR_FORMAT && !strcmp(e.message, seconds[i].message)),
			"%zu: mask %zu: %s", i, later, e.message);
		supervision_free(&s);
	}
}

static void test_supervision(void)
{
	const char *const refs[] = {"r1", "r2", "r3", "r4"}, *const objects[] = {"cup", "cup", "pan", "jar"};
	struct train_view views[2] = {{.count = 0}, {.count = 0}};
	struct supervision s = {0};
	size_t later;
	struct err e;

	add(&s, 0, NULL, "cup", 2, 0);
	add(&s, 0, "r2", "cup", 4, 1); /* reduced to 2x2 */
	add(&s, 0, "r3", NULL, 1, 1);  /* enlarged */
	add(&s, 0, "r9", "jar", 2, 1); /* of no sentence: a mask of a ref does not serve its object */
	add(&s, 1, NULL, "jar", 2, 1);
	add(&s, 1, "r2", "pan", 2, 1); /* another view; and the ref goes before the object */
	CHECK(!supervision_index(&s, &later, &e) && !supervision_link(&s, refs, objects, 4, views, 2, &e),
		"%s", e.message);
	CHECK(views[0].count == 3 && views[1].count == 2, "%d and %d pairs", views[0].count, views[1].count);
	const int sentences[2][3] = {{0, 1, 2}, {1, 3}}, values[2][3] = {{0, 1, 1}, {1, 1}};
	for (int v = 0; v < 2; v++)
		for (int k = 0; k < views[v].count; k++) {
			CHECK(views[v].sentences[k] == sentences[v][k], "pair %d of view %d is of %d", k, v,
				views[v].sentences[k]);
			for (int p = 0; p < 4; p++)
				CHECK((views[v].masks[k][0] >> p & 1) == values[v][k],
					"pixel %d of pair %d of view %d", p, k, v);
		}
	supervision_unlink(views, 2);
	supervision_free(&s);
}

/* Equal masks of a view are one; a view's own stay apart, as do those that differ in one pixel. */
static void test_shared_masks(void)
{
	const char *const refs[] = {"a", "b", "c"}, *const objects[] = {"cup", "pan", "jar"};
	struct train_view views[2] = {{.count = 0}, {.count = 0}};
	struct supervision s = {0};
	size_t later;
	struct err e;

	for (size_t v = 0; v < 2; v++) {
		add(&s, v, "a", NULL, 2, 1);
		add(&s, v, NULL, "pan", 4, 1);
		add(&s, v, "c", NULL, 2, 0);
	}
	CHECK(!supervision_index(&s, &later, &e) && !supervision_link(&s, refs, objects, 3, views, 2, &e),
		"%s", e.message);
	CHECK(views[0].count == 3 && views[1].count == 3, "%d and %d pairs", views[0].count, views[1].count);
	CHECK(views[0].masks[0] == views[0].masks[1] && views[1].masks[0] == views[1].masks[1],
		"equal masks are stored twice");
	CHECK(views[0].masks[0] != views[1].masks[0], "two views share a mask");
	CHECK(views[0].masks[0] != views[0].masks[2] && views[0].masks[2][0] == 0, "other masks are shared");
	supervision_unlink(views, 2);
	supervision_free(&s);
}

/* As many masks as a scene may have, each with pixels of its own: found again, all of them. */
static void test_many_masks(void)
{
	enum { MANY_VIEWS = 60, REFS = 60, W = 19, H = 11 };
	static char names[REFS][8];
	const char *refs[REFS], *objects[REFS];
	static struct train_view views[MANY_VIEWS];
	struct supervision s = {0};
	size_t later;
	struct err e;
	int wrong = 0;

	for (int r = 0; r < REFS; r++) {
		snprintf(names[r], sizeof names[r], "r%d", r);
		refs[r] = names[r];
		objects[r] = r % 2 ? names[r] : "none";
	}
	for (int k = 0; k < MANY_VIEWS * REFS; k++) {
		const int v = k % MANY_VIEWS, r = k / MANY_VIEWS;
		uint8_t pixels[W * H] = {0};
		pixels[r] = pixels[REFS + v] = 1;
		/* odd ones by their object, which is named as the ref of an even one might be */
		wrong += add_pixels(
			&s, (size_t)v, W, H, r % 2 ? NULL : refs[r], r % 2 ? refs[r] : "pot", pixels, W, H);
	}
	CHECK(!wrong && s.masks.n == MANY_VIEWS * REFS, "%d wrong, %zu masks", wrong, s.masks.n);
	CHECK(!supervision_index(&s, &later, &e) &&
			!supervision_link(&s, refs, objects, REFS, views, MANY_VIEWS, &e),
		"%s", e.message);
	for (int v = 0; v < MANY_VIEWS; v++) {
		wrong += views[v].count != REFS;
		for (int r = 0; r < views[v].count; r++) {
			uint8_t pixels[W * H];
			int area = 0;
			bits_expand(views[v].masks[r], 0, W * H, pixels);
			for (int p = 0; p < W * H; p++)
				area += pixels[p];
			wrong += views[v].sentences[r] != r || !pixels[r] || !pixels[REFS + v] || area != 2;
		}
	}
	CHECK(!wrong, "%d masks are wrong", wrong);
	supervision_unlink(views, MANY_VIEWS);
	supervision_free(&s);
}

int main(void)
{
	test_supervision();
	test_second_mask();
	test_shared_masks();
	test_many_masks();
	return unit_end();
}
