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
	const struct choose_sentence s = {text, text, vectors, NULL, encode(text, vectors), from, &p, 0};
	int best = 0;
	CHECK(!choose(&scene, &s, 1, WORDS | NAMES | RELATIONS, &choice, probability, chosen, NULL, &e), "%s",
		e.message);
	for (int o = 0; o < OBJECTS; o++)
		best = probability[o] > probability[best] ? o : best;
	parse_free(&p);
	return best;
}

/* A sentence that turns to the tin turns the next one to nothing. */
static void after_it(void)
{
	static const char *const texts[] = {
		"when facing the tin , the mug on the left", "the mug on the left"};
	static float vectors[2][MOST * WIDTH];
	struct choose_sentence s[2];
	struct choice choices[2];
	float p[2 * OBJECTS];
	char is[2 * OBJECTS];
	struct err e;

	for (int i = 0; i < 2; i++)
		s[i] = (struct choose_sentence){texts[i], texts[i], vectors[i], NULL,
			encode(texts[i], vectors[i]), {.kind = VIEWPOINT_POINT, .point = {0, 0, 5}}, NULL, 0};
	CHECK(!choose(&scene, s, 2, WORDS | NAMES | RELATIONS, choices, p, is, NULL, &e), "%s", e.message);
	CHECK(is[1] && !is[0], "facing the tin");
	CHECK(is[OBJECTS] && !is[OBJECTS + 1], "the next one");
}

/* Where the sentence itself says that it is said. */
static void said_from(void)
{
	const struct viewpoint above = {.kind = VIEWPOINT_POINT, .point = {0, 0, 5}},
			       usual = {.kind = VIEWPOINT_USUAL};
	const unsigned some = WORDS | NAMES | RELATIONS;

	CHECK(ask_from("when facing the crate , the mug on the left", some, above) == 0, "facing the crate");
	CHECK(ask_from("when facing the tin , the mug on the left", some, above) == 1, "facing the tin");
	CHECK(ask_standing("when facing the crate , the mug on the left", usual) == 1, "from the crate");
	CHECK(ask_standing("when facing the tin , the mug on the left", usual) == 0, "from the tin");
	after_it();
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
