/* ask/choose.h: how things look, in words that compare, of parts, and of what the Gaussians show. */
#include "choose_scene.h"

/* What shines in the pictures is the gleaming thing, where no sentence says what is. */
static void surfaces(void)
{
	static float shiny[12 * N];
	const struct splats plain = splats;

	for (int i = 0; i < N; i++) {
		memcpy(shiny + 12 * i, sh + 3 * i, 3 * sizeof *sh);
		for (int k = 3; k < 12; k++)
			shiny[12 * i + k] = i / EACH == 2 ? 0.3F : 0.05F;
	}
	splats.sh = shiny;
	splats.sh_coefficients = 4;
	CHECK(ask("the gleaming thing", WORDS | SURFACES) == 2 && probability[2] > 0.5, "the crate: %g",
		(double)probability[2]);
	CHECK(ask("the matt tin", CHOOSE_ALL) == 3 && choice.there > 0.5, "a matt tin: %g", choice.there);
	splats = plain;
}

/* A part of a colour that a thing has nowhere speaks against it, and so does a cover. */
static void coloured_parts(void)
{
	ask("the crate with a red lid", CHOOSE_ALL);
	CHECK(choice.there > 0.5, "a red lid of a red crate: %g", choice.there);
	ask("the crate with a green lid", CHOOSE_ALL);
	CHECK(choice.there < 0.5, "a green lid: %g", choice.there);
	ask("the crate without a green lid", CHOOSE_ALL);
	CHECK(choice.there > 0.5, "none: %g", choice.there);
	ask("the crate with a green cover", CHOOSE_ALL);
	CHECK(choice.there < 0.5, "a green cover: %g", choice.there);
}

/* What compares, and what lies under another, is so or not. */
static void plain_facts(void)
{
	ask("the crate under the tin", CHOOSE_ALL);
	CHECK(choice.there < 0.5, "it stands beside it: %g", choice.there);
	best_of_roles("the mug further back than the crate", ". T . P . . A3", PARSE_BEHIND);
	CHECK(choice.there < 0.5, "nothing is: %g", choice.there);
	best_of_roles("the mug further back than the tin", ". T . P . . A3", PARSE_BEHIND);
	CHECK(choice.there > 0.5, "both are: %g", choice.there);
}

/* Looks are compared among those that are meant; the crate is darker than the tin, and the mugs are bright.
 */
static void comparisons(void)
{
	const char *tin = "something darker than the tin", *brighter = "something brighter than the crate";

	CHECK(ask("the darkest thing", CHOOSE_ALL) == 2 && choice.there > 0.5, "the darkest: %g",
		choice.there);
	CHECK(ask("the second darkest thing", CHOOSE_ALL) == 3, "the second darkest");
	CHECK(ask("the reddest thing", CHOOSE_ALL) == 2 && choice.there > 0.5, "the reddest: %g",
		choice.there);
	CHECK(best_of_roles(tin, "T P . . A1", PARSE_OTHER) == 2 && choice.there > 0.5,
		"darker than the tin: %g", choice.there);
	best_of_roles(brighter, "T P . . A1", PARSE_OTHER);
	CHECK(probability[2] < 0.1, "the crate is brighter than itself: %g", (double)probability[2]);
	best_of_roles("something darker than the crate", "T P . . A1", PARSE_OTHER);
	CHECK(choice.there < 0.5, "nothing is darker: %g", choice.there);
	CHECK(best_of_roles("the darkest mug", ". P T", PARSE_OTHER) < 2, "a mug");
}

int main(void)
{
	make_scene();
	surfaces();
	comparisons();
	coloured_parts();
	plain_facts();
	return unit_end();
}
