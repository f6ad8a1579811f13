/* lang/: sentences taken apart, and colour words. */
#include "lang/colours.h"
#include "lang/phrases.h"
#include "lang/sentence.h"
#include "unit.h"

#include <math.h>
#include <string.h>

static void put_phrase(char *out, size_t room, const struct lang_sentence *s, const struct lang_phrase *p)
{
	for (int i = 0; i < p->n; i++) {
		size_t have = strlen(out);
		snprintf(out + have, room - have, "%s%s", i ? " " : "", s->words[p->words[i]].text);
	}
}

/* "target | relation(anchor; anchor) ..." */
static void put_sentence(char *out, size_t room, const char *pieces)
{
	struct lang_sentence s;

	lang_sentence_read(&s, pieces);
	*out = 0;
	put_phrase(out, room, &s, &s.target);
	for (int i = 0; i < s.clause_count; i++) {
		const struct lang_clause *c = &s.clauses[i];
		size_t have = strlen(out);
		snprintf(out + have, room - have, "%s%s(", i ? " " : " | ", lang_relation_name(c->relation));
		for (int k = 0; k < c->anchor_count; k++) {
			if (k)
				strncat(out, "; ", room - strlen(out) - 1);
			put_phrase(out, room, &s, &c->anchors[k]);
		}
		strncat(out, ")", room - strlen(out) - 1);
	}
}

static void sentences(void)
{
	static const char *const cases[][2] = {
		{"the small mug on the plate , to the left of the red book",
			"small mug | on(plate) left(red book)"},
		{"the thing lying on top of the green mat", " | on(green mat)"},
		{"a ear ##bu ##d case", "earbud case"},
		{"the item between the bottle and the erase ##r box", " | between(bottle; eraser box)"},
		{"the ball between the black and white cones", "ball | between(black; white cones)"},
		{"the plate with the orange cup and the red cup on either side",
			"plate | between(orange cup; red cup)"},
		{"the black and white doll", "black white doll"},
		{"the object next to the green mat , on its left", " | near(green mat) left(green mat)"},
		{"the leftmost one of the three white plates", "white plates | leftmost()"},
		{"the left one of the two mug ##s", "mugs | leftmost()"},
		{"the left - hand can", "can | leftmost()"},
		{"the mug left of the can", "mug | left(can)"},
		{"the mug on the left - hand side of the can", "mug | left(can)"},
		{"the mug at the left of the table", "mug | left side()"},
		{"the mug at the left edge of the desk", "mug | left side()"},
		{"the mug towards the back edge of the table", "mug | back side()"},
		{"the mug in the middle of the table", "mug | middle()"},
		{"the middle one of the three mugs", "mugs | middle one()"},
		{"the nearest mug", "mug | nearest()"},
		{"the mug nearest to us", "mug | nearest()"},
		{"the mug nearest to the book", "mug | nearest to(book)"},
		{"the mug at the least distance from the book", "mug | nearest to(book)"},
		{"the mug most distant from where we stand", "mug | farthest()"},
		{"the mug farthest away from the book", "mug | farthest from(book)"},
		{"the mug farthest to the right", "mug | rightmost()"},
		{"the mug farthest to the right of the book", "mug | rightmost() right(book)"},
		{"the mug on the far side of the book", "mug | behind(book)"},
		{"the mug on the other side of the book from us", "mug | behind(book)"},
		{"the mug in front of the kettle and the red bag", "mug | front(kettle; red bag)"},
		{"the mug in front of the kettle and nearest to us", "mug | front(kettle) nearest()"},
		{"the item at the foot of the bag", " | near(bag)"},
		{"the item directly under the mouse", " | under(mouse)"},
		{"the mug above the book", "mug | above(book)"},
		{"the largest mug , behind the book that is red", "mug red | largest() behind(book)"},
		{"the book on the table", "book"},
		{"the mug made by hand in white", "mug made hand white"},
		{"the highest one", " | highest()"},
		{"the mug that you can see behind the can", "mug | behind(can)"},
		{"", ""},
		{"left", "left"},
		{"between", ""},
		{"the mug between and", "mug"},
		{"on either side", ""},
		{"to the left of", ""},
	};
	char text[512];

	for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
		put_sentence(text, sizeof text, cases[i][0]);
		CHECK(!strcmp(text, cases[i][1]), "'%s' is '%s', expected '%s'", cases[i][0], text,
			cases[i][1]);
	}
}

/* Pieces of a word are counted, also where a hyphen or a lone ## stands among them. */
static void pieces(void)
{
	struct lang_sentence s;

	lang_sentence_read(&s, "the see - through bot ##tle ##s");
	CHECK(s.word_count == 4, "%d words", s.word_count);
	CHECK(!strcmp(s.words[3].text, "bottles") && s.words[3].first == 4 && s.words[3].count == 3,
		"'%s' begins at %d, %d pieces", s.words[3].text, s.words[3].first, s.words[3].count);
	CHECK(!strcmp(s.words[2].text, "through") && s.words[2].first == 3, "'%s'", s.words[2].text);
	lang_sentence_read(&s, "##a - ##b c");
	CHECK(s.words[s.word_count - 1].first == 3, "a lone continuation");
}

/* Long, and made of whatever parses: nothing is written past an end. */
static void long_sentences(void)
{
	static char text[1 << 16];
	static const char *const bits[] = {"the mug ", "to the left of the ",
		"between a and the b and the c and the d ", "on its left ", "with a and b on either side ",
		"aaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaa ", "##bbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbb ",
		"nearest ", ", "};
	struct lang_sentence s;

	for (unsigned seed = 1; seed <= 200; seed++) {
		unsigned state = seed;
		size_t n = 0;
		while (n < 6000) {
			state = state * 1664525u + 1013904223u;
			const char *bit = bits[(state >> 16) % (sizeof bits / sizeof *bits)];
			memcpy(text + n, bit, strlen(bit));
			n += strlen(bit);
		}
		text[n - 1] = 0;
		lang_sentence_read(&s, text);
		int bad =
			s.word_count > LANG_WORDS || s.clause_count > LANG_CLAUSES || s.target.n > LANG_WORDS;
		for (int c = 0; c < s.clause_count; c++)
			bad |= s.clauses[c].anchor_count > LANG_ANCHORS ||
			       (s.clauses[c].relation <= LANG_BETWEEN) != (s.clauses[c].anchor_count > 0);
		CHECK(!bad, "seed %u", seed);
	}
}

static void colours(void)
{
	double lab[3], word[3];
	const double red[3] = {1, 0, 0}, white[3] = {1, 1, 1}, outside[3] = {2, -1, -1};

	/* known values of CIE L*a*b* (D65) */
	colour_lab(red, lab);
	CHECK(fabs(lab[0] - 53.24) < 0.05 && fabs(lab[1] - 80.09) < 0.1 && fabs(lab[2] - 67.20) < 0.1,
		"red is %g %g %g", lab[0], lab[1], lab[2]);
	colour_lab(white, lab);
	CHECK(fabs(lab[0] - 100) < 0.01 && fabs(lab[1]) < 0.02 && fabs(lab[2]) < 0.02, "white is %g %g %g",
		lab[0], lab[1], lab[2]);
	colour_lab(outside, lab);
	CHECK(fabs(lab[0] - 53.24) < 0.05, "what is outside is cut");
	CHECK(colour_word("mug") == -1 && colour_word("crimson") >= 0 && colour_word("") == -1,
		"colour words");
	for (int i = 0; i < COLOUR_WORDS; i++) {
		colour_word_lab(i, word);
		const float own[3] = {(float)word[0], (float)word[1], (float)word[2]};
		const float dark[3] = {(float)word[0] - 40, (float)word[1], (float)word[2]};
		CHECK(fabs(colour_fit(own, word) - 1) < 1e-6, "colour %d does not fit itself", i);
		CHECK(fabs(colour_fit(dark, word) - exp(-0.5 * 20 * 20 / 625)) < 1e-5, "darker colour %d", i);
	}
}

int main(void)
{
	sentences();
	pieces();
	long_sentences();
	colours();
	return unit_end();
}
