#include "lang/relation_words.h"

#include "base/utf8.h"

#include <string.h>

const char *const relation_name[RELATIONS] = {"left", "right", "front", "behind", "between", "next to", "on",
	"under", "above", "inside", "nearest", "farthest", "largest", "smallest", "middle"};

enum {
	NOTHING = 0,
	LEFT = 1 << RELATION_LEFT,
	RIGHT = 1 << RELATION_RIGHT,
	FRONT = 1 << RELATION_FRONT,
	BEHIND = 1 << RELATION_BEHIND,
	BETWEEN = 1 << RELATION_BETWEEN,
	NEXT_TO = 1 << RELATION_NEXT_TO,
	ON = 1 << RELATION_ON,
	UNDER = 1 << RELATION_UNDER,
	ABOVE = 1 << RELATION_ABOVE,
	INSIDE = 1 << RELATION_INSIDE,
	NEAREST = 1 << RELATION_NEAREST,
	FARTHEST = 1 << RELATION_FARTHEST,
	LARGEST = 1 << RELATION_LARGEST,
	SMALLEST = 1 << RELATION_SMALLEST,
	MIDDLE = 1 << RELATION_MIDDLE,
};

static const char any_side[] = "far very extreme upper lower top bottom near outer inner other opposite same "
			       "front back left right nearest closest";
static const char strengthened[] =
	"by next beside alongside behind above below beneath under underneath over in on at "
	"inside outside between against near around opposite across up down before after "
	"here there where away";

/* Words that may stand for one another; a phrase names them by the letter. */
#define CLASS(letter) [(letter) - 'A']
static const char *const classes[26] = {
	/* before a noun */
	CLASS('D') = "the a an its his her their our your my this that one each",
	CLASS('O') = "its his her their",
	/* between that and a side */
	CLASS('V') = "far very extreme upper lower top bottom near outer inner other opposite same",
	CLASS('W') = any_side,
	/* parts of a place, and those that have a relation of their own */
	CLASS('P') = "side sides half edge edges end ends row corner corners part border rim",
	CLASS('Q') = "front back rear middle centre center central foreground background",
	CLASS('H') = "left right",
	CLASS('N') = "side sides half end",
	/* after "right": it then only strengthens, or measures */
	CLASS('R') = strengthened,
	CLASS('A') = "angle angles angled",
	/* after "left": somebody left it there */
	CLASS('L') = "on in behind by over open lying standing there out alone unattended",
	/* after "front": the thing's own */
	CLASS('F') = "cover covers page pages door doors pocket pockets leg legs wheel wheels panel face",
	/* after "in": a manner, not a container */
	CLASS('I') =
		"picture image photo scene view frame row line group shape form colour color style way dark",
	/* before "on", "over" and "by" that are not about a place */
	CLASS('S') = "turned switched printed written painted drawn based",
	CLASS('T') = "turned knocked tipped flipped all left",
	CLASS('B') = "made given held worn taken shown drawn",
	/* before "by" that is */
	CLASS('K') = "placed located positioned parked seated",
	CLASS('G') = "farthest furthest farther further",
};

/* Words with spaces between them. A capital is a word of its class, % before it says that it may be absent; *
 * is any word, -ed one with that ending, and . a comma or the like, or the end. What follows | must be there
 * but is not taken: it may begin a phrase of its own. */
static const struct phrase {
	uint32_t relations;
	const char *text;
} phrases[] = {
	{LEFT, "left"},
	{LEFT, "leftmost"},
	{LEFT, "D left"},
	{LEFT, "%D V left"},
	{LEFT | BEHIND, "back left"},
	{NOTHING, "left | L"},

	{RIGHT, "right"},
	{RIGHT, "rightmost"},
	{RIGHT, "D right"},
	{RIGHT, "%D V right"},
	{RIGHT | BEHIND, "back right"},
	{NOTHING, "right | R"},
	{NOTHING, "%D right | A"},

	{FRONT, "front"},
	{FRONT, "frontmost"},
	{FRONT, "foremost"},
	{FRONT, "near P"},
	{FRONT, "in %D foreground"},
	{NOTHING, "O front"},
	{NOTHING, "front | F"},

	{BEHIND, "behind"},
	{BEHIND, "rear"},
	{BEHIND, "rearmost"},
	{BEHIND, "backmost"},
	{BEHIND, "in back"},
	{BEHIND, "in %D background"},
	{BEHIND, "at %D back"},
	{BEHIND, "in %D back"},
	{BEHIND, "on %D back"},
	{BEHIND, "near %D back"},
	{BEHIND, "to %D back"},
	{BEHIND, "towards %D back"},
	{BEHIND, "from %D back"},
	{BEHIND, "G back"},
	{BEHIND, "back P"},
	{BEHIND, "far P"},
	{NOTHING, "on O back ."},

	{BETWEEN, "between"},
	{BETWEEN, "inbetween"},
	{BETWEEN, "sandwiched"},
	{BETWEEN, "flanked by"},
	{BETWEEN, "on either side"},
	{BETWEEN, "on both sides"},

	{NEXT_TO, "next to"},
	{NEXT_TO, "beside"},
	{NEXT_TO, "alongside"},
	{NEXT_TO, "adjacent"},
	{NEXT_TO, "against"},
	{NEXT_TO, "leaning on"},
	{NEXT_TO, "close to"},
	{NEXT_TO, "close by"},
	{NEXT_TO, "nearby"},
	{NEXT_TO, "near"},
	{NEXT_TO, "at %D side of"},
	{NEXT_TO, "at %D foot of"},
	{NEXT_TO, "by | D"},
	{NEXT_TO, "K by"},
	{NOTHING, "-ed by"},
	{NOTHING, "B by"},
	{NOTHING, "near | %D %W P"},
	{NOTHING, "near | %D Q"},
	{NOTHING, "close to | %D %W P"},
	{NOTHING, "close to | %D Q"},

	{ON, "on"},
	{ON, "onto"},
	{ON, "upon"},
	{ON, "atop"},
	{ON, "on %D top of"},
	{NOTHING, "on | %D %V H"},
	{NOTHING, "on | %D %W N"},
	{NOTHING, "on | %D Q"},
	{NOTHING, "on | it"},
	{NOTHING, "on | them"},
	{NOTHING, "on | and"},
	{NOTHING, "on ."},
	{NOTHING, "S on"},

	{UNDER, "under"},
	{UNDER, "underneath"},
	{UNDER, "below"},
	{UNDER, "beneath"},

	{ABOVE, "above"},
	{ABOVE, "over"},
	{NOTHING, "over | there"},
	{NOTHING, "over | here"},
	{NOTHING, "over | to"},
	{NOTHING, "T over"},

	{INSIDE, "inside"},
	{INSIDE, "within"},
	{INSIDE, "into"},
	{INSIDE, "in | D"},
	{NOTHING, "in | %D %W P"},
	{NOTHING, "in | %D Q"},
	{NOTHING, "in | D I"},
	{NOTHING, "in | D * I"},
	{NOTHING, "in | D * * I"},
	{NOTHING, "in | D H of"},

	{NEAREST, "nearest"},
	{NEAREST, "closest"},
	{NEAREST, "nearer"},
	{NEAREST, "closer"},
	{NEAREST, "least distance"},
	{NEAREST, "shortest distance"},
	{NEAREST, "smallest distance"},

	{FARTHEST, "farthest"},
	{FARTHEST, "furthest"},
	{FARTHEST, "farther"},
	{FARTHEST, "further from"},
	{FARTHEST, "further away"},
	{FARTHEST, "far from"},
	{FARTHEST, "far away"},
	{FARTHEST, "most distant"},
	{FARTHEST, "most remote"},
	{FARTHEST, "greatest distance"},
	{NOTHING, "G | to %D H"},
	{NOTHING, "G | H"},

	{LARGEST, "largest"},
	{LARGEST, "biggest"},
	{LARGEST, "tallest"},
	{LARGEST, "longest"},
	{LARGEST, "widest"},
	{LARGEST, "larger"},
	{LARGEST, "bigger"},
	{LARGEST, "taller"},
	{LARGEST, "wider"},

	{SMALLEST, "smallest"},
	{SMALLEST, "tiniest"},
	{SMALLEST, "littlest"},
	{SMALLEST, "shortest"},
	{SMALLEST, "narrowest"},
	{SMALLEST, "smaller"},
	{SMALLEST, "tinier"},
	{SMALLEST, "shorter"},
	{SMALLEST, "narrower"},

	{MIDDLE, "middle"},
	{MIDDLE, "centre"},
	{MIDDLE, "center"},
	{MIDDLE, "central"},
};

enum { WINDOW = 6 }; /* words that the longest phrase looks at */

struct word {
	const char *text;
	size_t len;
	int is_first; /* after a comma or the like, or at the beginning */
};

struct words {
	int n; /* below WINDOW: the text ends after them */
	struct word items[WINDOW];
};

/* Letters, digits and whatever is not ASCII, but for the dashes and quotes that Unicode has. */
static int is_letter(uint32_t c)
{
	if (c < 0x80)
		return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
	return c != 0xa0 && !(c >= 0x2000 && c <= 0x206f);
}

/* Blanks and what stands inside compounds; all else parts phrases. */
static int is_joint(uint32_t c)
{
	return c == ' ' || (c >= '\t' && c <= '\r') || c == '-' || c == '\'' || c == '/' || c == '"' ||
	       c == 0xa0 || c == 0x2010 || c == 0x2011 || c == 0x2019;
}

/* The next word from *at on: 1, or 0 at the end. */
static int next_word(struct word *w, const char *text, size_t len, size_t *at)
{
	size_t before = *at;

	w->is_first = !before;
	while (*at < len) {
		before = *at;
		uint32_t c = utf8_next(text, len, at);
		if (is_letter(c))
			break;
		w->is_first |= !is_joint(c);
		before = *at;
	}
	w->text = text + before;
	while (*at < len) {
		size_t end = *at;
		if (!is_letter(utf8_next(text, len, at))) {
			*at = end;
			break;
		}
	}
	w->len = *at - before;
	return w->len > 0;
}

static char lower(char c)
{
	return c >= 'A' && c <= 'Z' ? (char)(c - 'A' + 'a') : c;
}

static int is_same(const struct word *w, const char *text, size_t len)
{
	if (w->len != len)
		return 0;
	for (size_t i = 0; i < len; i++)
		if (lower(w->text[i]) != text[i])
			return 0;
	return 1;
}

static int is_of_class(const struct word *w, char letter)
{
	for (const char *p = classes[letter - 'A']; *p;) {
		size_t i = 0;
		while (i < w->len && lower(w->text[i]) == p[i])
			i++;
		if (i == w->len && (p[i] == ' ' || !p[i]))
			return 1;
		while (*p && *p++ != ' ')
			;
	}
	return 0;
}

/* Whether a word is what a phrase's element, `len` long, asks for. */
static int fits(const struct word *w, const char *element, size_t len)
{
	if (*element == '*')
		return 1;
	if (*element == '-')
		return w->len >= len && lower(w->text[w->len - 2]) == 'e' &&
		       lower(w->text[w->len - 1]) == 'd';
	if (*element >= 'A' && *element <= 'Z')
		return is_of_class(w, *element);
	return is_same(w, element, len);
}

/* How many words from `at` on fit the phrase, or -1; *taken gets those before its |. */
static int match(const char *phrase, const struct words *words, int at, int *taken)
{
	while (*phrase) {
		size_t len = strcspn(phrase, " ");
		const char *rest = phrase + len + (phrase[len] == ' ');
		const struct word *w =
			at < words->n && (!at || !words->items[at].is_first) ? &words->items[at] : NULL;
		if (*phrase == '|') {
			int ignored, end = match(rest, words, at, &ignored);
			*taken = at;
			return end;
		}
		if (*phrase == '.') {
			*taken = at;
			return w ? -1 : at + 1;
		}
		if (*phrase == '%') {
			int end = w && fits(w, phrase + 1, len - 1) ? match(rest, words, at + 1, taken) : -1;
			if (end >= 0)
				return end;
		} else if (w && fits(w, phrase, len)) {
			at++;
		} else {
			return -1;
		}
		phrase = rest;
	}
	*taken = at;
	return at;
}

/* The relations of the longest phrase that the words begin with; *taken how many are done with. */
static uint32_t begin_of(const struct words *words, int *taken)
{
	uint32_t relations = 0;
	int longest = 0;

	*taken = 1;
	for (size_t i = 0; i < sizeof phrases / sizeof *phrases; i++) {
		const char first = *phrases[i].text;
		if (first >= 'a' && first <= 'z' && first != lower(*words->items[0].text))
			continue; /* most phrases, at little cost */
		int own, len = match(phrases[i].text, words, 0, &own);
		if (len <= longest)
			continue;
		longest = len;
		relations = phrases[i].relations;
		*taken = own;
	}
	return relations;
}

uint32_t relations_of(const char *text)
{
	struct words words = {0};
	size_t len = strlen(text), at = 0;
	uint32_t relations = 0;

	for (;;) {
		int taken;
		while (words.n < WINDOW && next_word(&words.items[words.n], text, len, &at))
			words.n++;
		if (!words.n)
			return relations;
		relations |= begin_of(&words, &taken);
		words.n -= taken;
		memmove(words.items, words.items + taken, (size_t)words.n * sizeof *words.items);
	}
}
