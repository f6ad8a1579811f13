#include "lang/relation_words.h"
#include "unit.h"

/* Sentences with the names of their relations, in the order of enum relation. */
static const char *const table[][2] = {
	/* each relation in its usual words */
	{"the cup to the left of the plate", "left"},
	{"left of the plate", "left"},
	{"the leftmost cup", "left"},
	{"on the left-hand side of the plate", "left"},
	{"the mug on the left", "left"},
	{"at the far left", "left"},
	{"the left half", "left"},
	{"the yellow box at the upper left", "left"},
	{"the second from the left in the row", "left"},
	{"the cup to the right of the plate", "right"},
	{"standing right of it", "right"},
	{"at the rightmost place", "right"},
	{"the right one", "right"},
	{"in the right corner", "right"},
	{"the cup in front of the plate", "front"},
	{"on the near side of the plate", "front"},
	{"at the front of the table", "front"},
	{"near the front edge of the table", "front"},
	{"in the foreground", "front"},
	{"the cup behind the plate", "behind"},
	{"in back of the plate", "behind"},
	{"on the far side of the plate", "behind"},
	{"at the back of the table", "behind"},
	{"near the back edge of the table", "behind"},
	{"the cup at the rear", "behind"},
	{"in the background", "behind"},
	{"between the cup and the plate", "between"},
	{"in between the cup and the plate", "between"},
	{"with the cup and the plate on either side", "between"},
	{"next to the plate", "next to"},
	{"beside the plate", "next to"},
	{"close to the plate", "next to"},
	{"the cup by the plate", "next to"},
	{"leaning against the wall", "next to"},
	{"near the kettle", "next to"},
	{"at the foot of the bag", "next to"},
	{"on the table", "on"},
	{"on the wooden table", "on"},
	{"on top of the book", "on"},
	{"upon it", "on"},
	{"under the shelf", "under"},
	{"below the shelf", "under"},
	{"underneath", "under"},
	{"above the kettle", "above"},
	{"hanging over the sink", "above"},
	{"inside the box", "inside"},
	{"the spoon in a blue box", "inside"},
	{"nearest to the plate", "nearest"},
	{"closest to the plate", "nearest"},
	{"at the least distance from the plate", "nearest"},
	{"farthest from the plate", "farthest"},
	{"furthest away from the plate", "farthest"},
	{"most distant from the plate", "farthest"},
	{"the biggest cup", "largest"},
	{"the larger of the two", "largest"},
	{"the smallest cup", "smallest"},
	{"in the middle of the table", "middle"},
	{"near the centre of the table", "middle"},
	{"in the central part of the table", "middle"},

	/* words that mean something else */
	{"right by the bowl", "next to"},
	{"right behind the bowl", "behind"},
	{"right on the table", "on"},
	{"the right angled shelf", ""},
	{"the bowl that is left on the table", "on"},
	{"farthest to the left", "left"},
	{"farthest to the right", "right"},
	{"furthest back", "behind"},
	{"with letters printed on its front side", ""},
	{"the box with its lid on", ""},
	{"a pad with drawings on it", ""},
	{"the lamp that is turned on", ""},
	{"the book with a torn front cover", ""},
	{"the penguin lying on its back", ""},
	{"the table in a bright blue colour", ""},
	{"cups in a row", ""},
	{"standing near the edge of the desk", ""},
	{"surrounded by the cables", ""},
	{"made by the potter", ""},
	{"at the shortest distance", "nearest"},
	{"the one over there", ""},
	{"over to the right from the bowl", "right"},

	/* parts of words are not words */
	{"a bright leftover frontier onion belonging to copyright", ""},
	{"the rightful owner", ""},

	/* several */
	{"right by the bowl on the wooden table", "next to,on"},
	{"on the right by the plate", "right,next to"},
	{"in front of the penguin and right of the laptop", "right,front"},
	{"at the front right corner of the desk", "right,front"},
	{"at the back left", "left,behind"},
	{"to the left, on the shelf", "left,on"},
	{"left; right. behind", "left,right,behind"},

	/* capitals, joints and ends */
	{"To The LEFT Of", "left"},
	{"IN-BETWEEN", "between"},
	{"next\tto", "next to"},
	{"next, to", ""},
	{"\xe2\x80\x9cleft\xe2\x80\x9d", "left"},
	{"left\xe2\x80\x91hand", "left"},
	{"the mug \xe2\x80\x94 left of it", "left"},
	{"l\xc3\xa9"
	 "ft",
		""},
	{"\xff\xfe left \x80", "left"},
	{"left", "left"},
	{"on", ""},
	{"next", ""},
	{"in the", "inside"},
	{"the red cup", ""},
	{"", ""},
	{" ,.- ", ""},
};

static void test_table(void)
{
	for (size_t i = 0; i < sizeof table / sizeof *table; i++) {
		uint32_t found = relations_of(table[i][0]);
		char names[256] = "";
		for (int r = 0; r < RELATIONS; r++)
			if (found >> r & 1)
				snprintf(names + strlen(names), sizeof names - strlen(names), "%s%s",
					*names ? "," : "", relation_name[r]);
		CHECK(!strcmp(names, table[i][1]), "'%s': %s, not %s", table[i][0], names, table[i][1]);
	}
}

/* Every relation is somewhere in the table. */
static void test_names(void)
{
	uint32_t all = 0;

	for (size_t i = 0; i < sizeof table / sizeof *table; i++)
		all |= relations_of(table[i][0]);
	CHECK(all == ((uint32_t)1 << RELATIONS) - 1, "%x", (unsigned)all);
}

/* A long word, and many words. */
static void test_long(void)
{
	enum { LEN = 1 << 18 };
	char *text = malloc(LEN + 8);

	if (!text)
		abort();
	memset(text, 'a', LEN);
	strcpy(text + LEN, " left");
	CHECK(relations_of(text) == 1 << RELATION_LEFT, "a long word");
	for (int i = 0; i < LEN; i++)
		text[i] = "in a "[i % 5];
	CHECK(relations_of(text) & 1 << RELATION_LEFT, "many words");
	free(text);
}

int main(void)
{
	test_table();
	test_names();
	test_long();
	return unit_end();
}
