/* Names of things, of their properties, and of what one does with them, for the unseen split. */
#include "synth/unseen_words.h"

#include <stddef.h>

#define COUNT(list) ((int)(sizeof(list) / sizeof *(list)))
#define BIT(x) (1u << (x))

static const struct synth_unseen_noun nouns[] = {
	{BIT(SYNTH_BALL), 0, "ball", "balls"},
	{BIT(SYNTH_BALL), 0, "sphere", "spheres"},
	{BIT(SYNTH_BALL), 0, "orb", "orbs"},
	{BIT(SYNTH_BOX), 0, "box", "boxes"},
	{BIT(SYNTH_BOX), 0, "carton", "cartons"},
	{BIT(SYNTH_BOX), BIT(SYNTH_BOOK), "block", "blocks"},
	{BIT(SYNTH_BOX), BIT(SYNTH_BOOK), "parcel", "parcels"},
	{BIT(SYNTH_CYLINDER), BIT(SYNTH_MUG) | BIT(SYNTH_BOTTLE), "cylinder", "cylinders"},
	{BIT(SYNTH_CYLINDER), BIT(SYNTH_BOTTLE), "can", "cans"},
	{BIT(SYNTH_CYLINDER), BIT(SYNTH_BOTTLE), "tin can", "tin cans"},
	{BIT(SYNTH_CONE), 0, "cone", "cones"},
	{BIT(SYNTH_CONE), 0, "pylon", "pylons"},
	{BIT(SYNTH_MUG), 0, "mug", "mugs"},
	{BIT(SYNTH_MUG), 0, "cup", "cups"},
	{BIT(SYNTH_MUG), 0, "coffee mug", "coffee mugs"},
	{BIT(SYNTH_MUG), 0, "teacup", "teacups"},
	{BIT(SYNTH_BOWL), 0, "bowl", "bowls"},
	{BIT(SYNTH_BOWL), 0, "cereal bowl", "cereal bowls"},
	{BIT(SYNTH_BOWL), BIT(SYNTH_PLATE), "soup dish", "soup dishes"},
	{BIT(SYNTH_PLATE), 0, "plate", "plates"},
	{BIT(SYNTH_PLATE), BIT(SYNTH_BOWL), "saucer", "saucers"},
	{BIT(SYNTH_PLATE), BIT(SYNTH_BOWL), "platter", "platters"},
	{BIT(SYNTH_BOOK), 0, "book", "books"},
	{BIT(SYNTH_BOOK), 0, "paperback", "paperbacks"},
	{BIT(SYNTH_BOOK), 0, "novel", "novels"},
	{BIT(SYNTH_BOTTLE), 0, "bottle", "bottles"},
	{BIT(SYNTH_BOTTLE), BIT(SYNTH_CYLINDER), "flask", "flasks"},
	{BIT(SYNTH_BOTTLE), 0, "water bottle", "water bottles"},
};

const struct synth_unseen_noun *synth_unseen_noun(enum synth_shape s, struct rng *rng)
{
	const struct synth_unseen_noun *found = NULL;
	uint32_t n = 0;

	for (int i = 0; i < COUNT(nouns); i++)
		if (nouns[i].shapes & BIT(s) && !rng_below(rng, ++n))
			found = &nouns[i];
	return found;
}

const struct synth_unseen_noun *synth_unseen_foreign(struct rng *rng)
{
	static const struct synth_unseen_noun foreign[] = {
		{0, 0, "laptop", "laptops"},
		{0, 0, "banana", "bananas"},
		{0, 0, "phone", "phones"},
		{0, 0, "teddy bear", "teddy bears"},
		{0, 0, "fork", "forks"},
		{0, 0, "spoon", "spoons"},
		{0, 0, "key", "keys"},
		{0, 0, "pencil", "pencils"},
		{0, 0, "umbrella", "umbrellas"},
		{0, 0, "stapler", "staplers"},
		{0, 0, "glove", "gloves"},
		{0, 0, "calculator", "calculators"},
	};

	return &foreign[rng_below(rng, COUNT(foreign))];
}

const char *synth_unseen_hue(enum synth_colour c, struct rng *rng)
{
	static const char *const hues[SYNTH_COLOURS][2] = {
		[SYNTH_RED] = {"red", "bright red"},
		[SYNTH_GREEN] = {"green", "green"},
		[SYNTH_BLUE] = {"blue", "dark blue"},
		[SYNTH_YELLOW] = {"yellow", "bright yellow"},
		[SYNTH_WHITE] = {"white", "white"},
		[SYNTH_BLACK] = {"black", "black"},
		[SYNTH_ORANGE] = {"orange", "orange"},
		[SYNTH_PURPLE] = {"purple", "violet"},
		[SYNTH_BROWN] = {"brown", "dark brown"},
		[SYNTH_PINK] = {"pink", "light pink"},
		[SYNTH_GREY] = {"grey", "gray"},
		[SYNTH_TEAL] = {"teal", "turquoise"},
	};

	return hues[c][rng_below(rng, 4) == 0];
}

unsigned synth_unseen_near_hues(enum synth_colour c)
{
	static const unsigned near[SYNTH_COLOURS] = {
		[SYNTH_RED] = BIT(SYNTH_ORANGE) | BIT(SYNTH_PINK) | BIT(SYNTH_BROWN),
		[SYNTH_GREEN] = BIT(SYNTH_TEAL),
		[SYNTH_BLUE] = BIT(SYNTH_TEAL) | BIT(SYNTH_PURPLE),
		[SYNTH_YELLOW] = BIT(SYNTH_ORANGE),
		[SYNTH_WHITE] = BIT(SYNTH_GREY),
		[SYNTH_BLACK] = BIT(SYNTH_GREY) | BIT(SYNTH_BROWN),
		[SYNTH_ORANGE] = BIT(SYNTH_RED) | BIT(SYNTH_YELLOW) | BIT(SYNTH_BROWN),
		[SYNTH_PURPLE] = BIT(SYNTH_PINK) | BIT(SYNTH_BLUE),
		[SYNTH_BROWN] = BIT(SYNTH_ORANGE) | BIT(SYNTH_RED) | BIT(SYNTH_BLACK),
		[SYNTH_PINK] = BIT(SYNTH_RED) | BIT(SYNTH_PURPLE),
		[SYNTH_GREY] = BIT(SYNTH_WHITE) | BIT(SYNTH_BLACK),
		[SYNTH_TEAL] = BIT(SYNTH_GREEN) | BIT(SYNTH_BLUE),
	};

	return near[c];
}

const char *synth_unseen_finish(enum synth_finish f, struct rng *rng)
{
	static const char *const finishes[SYNTH_FINISHES][2] = {
		[SYNTH_SHINY] = {"shiny", "gleaming"},
		[SYNTH_STRIPED] = {"striped", "stripy"},
		[SYNTH_SPECKLED] = {"speckled", "spotty"},
	};

	return finishes[f][rng_below(rng, 2)];
}

const char *synth_unseen_size(enum synth_size s, struct rng *rng)
{
	static const char *const sizes[SYNTH_SIZES][2] = {
		[SYNTH_SMALL] = {"small", "little"},
		[SYNTH_BIG] = {"big", "large"},
	};

	return sizes[s][rng_below(rng, 2)];
}

const struct synth_unseen_use *synth_unseen_use(enum synth_shape s, struct rng *rng)
{
	enum { HOLLOW = BIT(SYNTH_MUG) | BIT(SYNTH_BOWL) | BIT(SYNTH_BOX) | BIT(SYNTH_CYLINDER) };
	static const struct synth_unseen_use uses[] = {
		{BIT(SYNTH_MUG), BIT(SYNTH_BOWL), "drink coffee from", {"drink", "coffee"}},
		{BIT(SYNTH_MUG), BIT(SYNTH_BOWL), "sip tea out of", {"sip", "tea"}},
		{BIT(SYNTH_BOWL), BIT(SYNTH_MUG) | BIT(SYNTH_PLATE), "eat soup from", {"eat", "soup"}},
		{BIT(SYNTH_BOWL), BIT(SYNTH_MUG) | BIT(SYNTH_PLATE), "have cornflakes in",
			{"have", "cornflakes"}},
		{BIT(SYNTH_PLATE), BIT(SYNTH_BOWL), "serve a slice of cake on", {"serve", "cake"}},
		{BIT(SYNTH_PLATE), BIT(SYNTH_BOWL), "put a sandwich on", {"put", "sandwich"}},
		{BIT(SYNTH_BOOK), 0, "read", {"read", NULL}},
		{BIT(SYNTH_BOOK), 0, "read in bed", {"read", "bed"}},
		{BIT(SYNTH_BOTTLE), HOLLOW, "carry water in on a hike", {"carry", "water"}},
		{BIT(SYNTH_BOTTLE), HOLLOW, "pour wine from", {"pour", "wine"}},
		{BIT(SYNTH_BALL), 0, "throw and catch", {"throw", "catch"}},
		{BIT(SYNTH_BALL), 0, "kick around", {"kick", NULL}},
		{BIT(SYNTH_BOX), 0, "wrap up as a present", {"wrap", "present"}},
		{BIT(SYNTH_BOX), BIT(SYNTH_BOTTLE) | HOLLOW, "post things in", {"post", "things"}},
		{BIT(SYNTH_CYLINDER), BIT(SYNTH_BOTTLE), "open with a tin opener", {"open", "opener"}},
		{BIT(SYNTH_CONE), 0, "put on the road to warn drivers", {"put", "road"}},
	};
	const struct synth_unseen_use *found = NULL;
	uint32_t n = 0;

	for (int i = 0; i < COUNT(uses); i++)
		if (uses[i].shapes & BIT(s) && !rng_below(rng, ++n))
			found = &uses[i];
	return found;
}
