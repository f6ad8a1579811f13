/* Where a sentence is said, by the caller or by itself, tells left from right (choose_scene.h). */
#include "choose_scene.h"

/* From behind, left is right. */
static void viewpoints(void)
{
	const struct viewpoint behind = {.kind = VIEWPOINT_POINT, .point = {0, 12, 1}};
	const unsigned some = WORDS | NAMES | RELATIONS;

	CHECK(ask("the leftmost mug", some) == 0, "the left mug");
	CHECK(ask_from("the leftmost mug", some, behind) == 1, "the left mug from behind");
	CHECK(ask_from("the thing nearest to us", some, behind) == 2, "the nearest thing from behind");
}

/* "When facing ...", read as "from ...", which grammar alone does not know. */
static int ask_standing(const char *text, struct viewpoint from)
{
	static float vectors[MOST * WIDTH];
	struct parse p;
	struct err e;

	if (!CHECK(!parse_sentence(&p, &parser, text, &(struct parser_vectors){0}, &e) &&
			    p.view == PARSE_VIEW_FACING,
		    "'%s' is parsed", text))
		return -1;
	p.view = PARSE_VIEW_FROM;
	const struct choose_sentence s = {text, text, vectors, NULL, encode(text, vectors), from, &p};
	int best = 0;
	CHECK(!choose(&scene, &s, 1, WORDS | NAMES | RELATIONS, &choice, probability, chosen, NULL, &e), "%s",
		e.message);
	for (int o = 0; o < OBJECTS; o++)
		best = probability[o] > probability[best] ? o : best;
	parse_free(&p);
	return best;
}

/* Where the sentence itself says that it is said; the next one is said from where all are. */
static void said_from(void)
{
	const struct viewpoint above = {.kind = VIEWPOINT_POINT, .point = {0, 0, 5}},
			       usual = {.kind = VIEWPOINT_USUAL};
	const unsigned some = WORDS | NAMES | RELATIONS;

	CHECK(ask_from("when facing the crate , the mug on the left", some, above) == 0, "facing the crate");
	CHECK(ask_from("when facing the tin , the mug on the left", some, above) == 1, "facing the tin");
	CHECK(ask_standing("when facing the crate , the mug on the left", usual) == 1, "from the crate");
	CHECK(ask_standing("when facing the tin , the mug on the left", usual) == 0, "from the tin");
	CHECK(ask("the mug on the left", some) == 0, "as ever");
	CHECK(ask("when facing the mug , the mug on the left", some) == 0, "which mug is not said");
	CHECK(ask("when facing the window , the mug on the left", CHOOSE_ALL) == 0 && choice.there > 0.5,
		"a window that is not here: %g there", choice.there);
}

int main(void)
{
	make_scene();
	viewpoints();
	said_from();
	return unit_end();
}
