/* lang/: colour words, what nouns share, and what WordNet knows, where it is there. */
#include "lang/colours.h"
#include "lang/compared.h"
#include "lang/finish.h"
#include "lang/kinds.h"
#include "lang/naming.h"
#include "lang/spelling.h"
#include "lang/things.h"
#include "lang/parts.h"
#include "lang/wordnet.h"
#include "unit.h"

#include <math.h>

static void colours(void)
{
	double lab[3];
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
	CHECK(colour_word("reddish") == colour_word("red") && colour_word("rosy") == colour_word("rose"),
		"words for the same colour");
	for (int i = 0; i < COLOUR_WORDS; i++) {
		CHECK(colour_words_alike(i, i) > 1 - 1e-9, "colour %d is not like itself", i);
		for (int k = 0; k < COLOUR_WORDS; k++)
			CHECK(fabs(colour_words_alike(i, k) - colour_words_alike(k, i)) < 1e-12, "%d and %d",
				i, k);
	}
	CHECK(colour_words_alike(colour_word("red"), colour_word("crimson")) > 0.5, "crimson is red");
	CHECK(colour_words_alike(colour_word("red"), colour_word("blue")) < 0.01, "blue is not red");
	/* a colour is called by the nearest words, and the parts add up */
	double share[COLOUR_WORDS] = {0};
	struct colour_labs all;
	colour_lab(red, lab);
	colour_labs_make(&all);
	colour_call(&all, lab, 0.5, share);
	colour_call(&all, lab, 0.5, share);
	CHECK(share[colour_word("red")] > 0.3 && share[colour_word("scarlet")] > 0.9 &&
			share[colour_word("green")] < 0.01,
		"red is called %g red, %g green", share[colour_word("red")], share[colour_word("green")]);
}

static double share(const char *a, const char *b)
{
	struct kinds_lines first, second;

	kinds_find(&first, a);
	kinds_find(&second, b);
	return kinds_share(&first, &second);
}

static void kinds(void)
{
	static const struct kinds_lines none;
	struct kinds_lines lines, jacket;
	char last[KINDS_LENGTH];

	CHECK(finish_of("ring") >= 0 && finish_of("jar") == -1 && finish_of("") == -1 &&
			finish_of("ban") == -1 && finish_fits(finish_of("ring"), finish_of("banded")) == 1 &&
			finish_fits(finish_of("plain"), finish_of("striped")) == -1 &&
			!finish_fits(finish_of("shiny"), finish_of("striped")) && !finish_fits(-1, -1),
		"looks");
	CHECK(kinds_listed("holder", "jar") && !kinds_listed("holder", "jam") &&
			!kinds_listed("gathering", ""),
		"what holds others");
	CHECK(share("cube", "box") > 0 && share("box", "cube") > 0 && share("cube", "ball") == 0, "kinds");
	CHECK(share("", "box") == 0 && share("ox", "box") == 0 && share("box block", "box") == 0,
		"whole words");
	kinds_find(&lines, "clothes");
	kinds_find(&jacket, "jacket");
	CHECK(kinds_are_of(&lines, &jacket) && !kinds_are_of(&jacket, &lines), "a jacket is clothes");
	CHECK(share("anorak", "jacket") > 0 && share("jacket", "anorak") == 0 &&
			share("squirter", "spray bottle") > 0,
		"names that go one way");
	for (long at = 0; kinds_next(&at, last);) {
		kinds_find(&lines, last);
		CHECK(kinds_have(last) && memcmp(lines.bits, none.bits, sizeof none.bits), "%s is in no line",
			last);
	}
}

static void comparisons(void)
{
	static const struct {
		const char *word, *base;
		enum parse_degree degree;
		enum compared_look look;
	} words[] = {{"darkest", "dark", PARSE_MOST, COMPARED_DARK},
		{"paler", "pale", PARSE_MORE, COMPARED_BRIGHT},
		{"reddest", "red", PARSE_MOST, COMPARED_COLOUR},
		{"shinier", "shiny", PARSE_MORE, COMPARED_FINISH},
		{"stripiest", "stripy", PARSE_MOST, COMPARED_FINISH}};
	static const char *const none[] = {"largest", "nearest", "heaviest", "thinner", "dark", "silver",
		"forest", "modest", "marker", "drawer", "est", "er", "", "chest", "flower"};
	char base[COMPARED_LENGTH];

	for (size_t i = 0; i < sizeof words / sizeof *words; i++)
		CHECK(compared_of(words[i].word, base) == words[i].degree && !strcmp(base, words[i].base) &&
				compared_look(base) == words[i].look,
			"%s: '%s'", words[i].word, base);
	for (size_t i = 0; i < sizeof none / sizeof *none; i++)
		CHECK(compared_of(none[i], base) == PARSE_PLAIN, "%s compares", none[i]);
	CHECK(compared_look("colourful") == COMPARED_COLOURFUL && compared_look("soft") == COMPARED_NONE,
		"looks");
	if (wordnet_is_there())
		CHECK(compared_of("softest", base) == PARSE_MOST && !strcmp(base, "soft"), "softest");
}

static int name_one_thing(const char *a, const char *b)
{
	struct things_rows first, second;

	things_find(&first, a);
	things_find(&second, b);
	return things_share(&first, &second);
}

/* A field of a line of the table: items of small letters and digits, with one space or hyphen between words.
 */
static int is_well_formed(const char *text, size_t length, char between)
{
	for (size_t i = 0; i < length; i++) {
		const int is_letter =
				  (text[i] >= 'a' && text[i] <= 'z') || (text[i] >= '0' && text[i] <= '9'),
			  is_last = i + 1 == length;
		if (text[i] == between && (is_last || text[i + 1] != ' '))
			return 0;
		if (!is_letter && (!i || is_last || (text[i] != between && text[i] != ' ' && text[i] != '-')))
			return 0;
	}
	return length > 0;
}

/* The names of all lines, NULL after the last, and how long each is. */
struct lines {
	const char *names[4096];
	size_t length[4096];
};

/* The lines that have a name, by looking at each. */
static void check_lines_of(const struct lines *all, const char *name, size_t n)
{
	struct things_rows found;
	char word[64];
	int k = 0;

	snprintf(word, sizeof word, "%.*s", (int)n, name);
	things_find(&found, word);
	for (int row = 0; k < THINGS_ROWS && all->names[row]; row++)
		for (const char *p = all->names[row]; p < all->names[row] + all->length[row];
			p += strcspn(p, ",\t") + 2) {
			const size_t own = strcspn(p, ",\t");
			if ((own == n || (own == n + 1 && p[n] == 's')) && !memcmp(p, word, n)) {
				CHECK(k < found.n && found.row[k] == row, "%s is not in line %d", word, row);
				k++;
				break;
			}
		}
	CHECK(k == found.n, "%s: %d lines, not %d", word, found.n, k);
}

static void things(void)
{
	static const char between[] = {',', ';', ','};
	static struct lines all;
	const char *text;
	size_t length;
	int row = 0;

	for (; (all.names[row] = things_text(row, THINGS_NAMES, &all.length[row])); row++)
		for (int field = 0; field < 3; field++) {
			text = things_text(row, (enum things_field)field, &length);
			CHECK(text && is_well_formed(text, length, between[field]), "line %d, field %d: %.*s",
				row + 1, field + 1, (int)length, text);
		}
	CHECK(row > 1000, "%d things", row);
	for (int i = 0; i < row; i += 7) {
		text = all.names[i];
		const size_t n = strcspn(text, ",\t");
		check_lines_of(&all, text, n);
		check_lines_of(&all, text, n - (text[n - 1] == 's'));
	}
	CHECK(name_one_thing("laptop", "chromebook") && name_one_thing("chromebook", "laptop") &&
			!name_one_thing("laptop", "kettle"),
		"names of a laptop");
	CHECK(name_one_thing("scissor", "scissors"), "a plural");
	CHECK(!name_one_thing("", "") && !name_one_thing("lapto", "laptop") &&
			!name_one_thing("laptop,", "laptop") && !name_one_thing("aptop", "laptop"),
		"whole names");
}

static void parts_of_things(void)
{
	struct parts laptop, mug, word;

	parts_usual(&laptop, "laptop");
	parts_usual(&mug, "mug");
	parts_of_word(&word, "battery");
	CHECK(parts_share(&laptop, &word) && !parts_share(&mug, &word), "a battery");
	parts_usual(&mug, "nothing of the kind");
	CHECK(mug.n == 0, "nothing is known of it");
}

static double fits(const char *word, const char *known)
{
	struct wordnet_noun a, b;

	wordnet_find(&a, word);
	wordnet_find(&b, known);
	return wordnet_fits(&a, &b);
}

/* The chance that a thing which is called so is called `word` too. */
static double names(const char *word, const char *called)
{
	struct naming a, b;

	naming_of_word(&a, word);
	naming_of_thing(&b, called);
	return naming_fits(&a, &b, 0);
}

/* fits, of a thing that is called by a noun. */
static double fits_thing(const char *word, const char *called)
{
	struct wordnet_noun a, b;

	wordnet_find(&a, word);
	wordnet_find_thing(&b, called);
	return wordnet_fits(&a, &b);
}

static void wordnet(void)
{
	struct wordnet_noun noun;

	wordnet_find(&noun, "");
	CHECK(noun.n == 0, "no word");
	wordnet_find(&noun, "qqqqq");
	CHECK(noun.n == 0 && fits("qqqqq", "qqqqq") == 0, "no noun");
	if (!wordnet_is_there()) {
		CHECK(fits("book", "book") == 0 && !wordnet_is_adjective("shiny"),
			"without WordNet nothing is known");
		return;
	}
	CHECK(fits("food", "dish") > 0.05 && fits_thing("food", "dish") == 0,
		"a dish of a scene is no food: %g, %g", fits("food", "dish"), fits_thing("food", "dish"));
	CHECK(fits_thing("vessel", "dish") >= fits("vessel", "dish") &&
			fits_thing("food", "soup") >= fits("food", "soup"),
		"what is made fits no less, and what is only eaten");
	CHECK(fits("furniture", "chair") > 0.5 && fits("chair", "furniture") == 0 &&
			fits("table", "chair") == 0,
		"what a thing is a kind of names it, a kind of it and a sister do not: %g",
		fits("furniture", "chair"));
	CHECK(names("container", "mug") > 0.5 && names("vessel", "bowl") > 0.3 &&
			names("toilet", "kettle") < 0.1,
		"the sense that is of a thing: %g, %g, %g", names("container", "mug"),
		names("vessel", "bowl"), names("toilet", "kettle"));
	CHECK(fits("lamp", "laptop") == 0, "a lamp is no laptop");
	CHECK(names("throne", "stool") < 0.3, "a rare sense: %g", names("throne", "stool"));
	CHECK(names("wok", "pan") > 0.5 && names("pan", "wok") > 0.5 && names("pillar", "tube") > 0.8,
		"of one look, of one shape: %g, %g", names("wok", "pan"), names("pillar", "tube"));
	CHECK(names("oven", "fan") == 0 && names("lorry", "piano") == 0, "other things");
	CHECK(wordnet_is_adjective("shiny") && !wordnet_is_adjective("kettle") && !wordnet_is_adjective(""),
		"adjectives");
}

static void repairs(const char *word, const char *expected)
{
	static const char *const known[] = {"trumpet", "harp"};
	char right[SPELLING_LENGTH];
	const int is_repaired = spelling_repair(word, known, 2, right);

	CHECK(is_repaired == (expected != NULL) && (!expected || !strcmp(right, expected)), "%s: %s", word,
		is_repaired ? right : "as it is");
}

static void spelling(void)
{
	CHECK(spelling_near("tub", "tubs") && spelling_near("tub", "tab") && spelling_near("tub", "tbu"),
		"a slip");
	CHECK(!spelling_near("tub", "tub") && !spelling_near("tub", "tables"), "no slip, and many");
	repairs("trumpt", "trumpet");	  /* of the scene, */
	repairs("trumpetts", "trumpets"); /* in its plural, */
	repairs("ylelow", "yellow");	  /* a colour, */
	repairs("tabel", "table");	  /* an everyday noun, */
	repairs("behnid", "behind");	  /* or a word of grammar */
	repairs("harp", NULL);
	repairs("trumpet", NULL);
	repairs("xq", NULL);
	repairs("", NULL);
	repairs("aaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaa", NULL);
	/* what WordNet knows is no slip of a short word */
	if (wordnet_is_there())
		repairs("crates", NULL);
}

int main(void)
{
	spelling();
	colours();
	kinds();
	comparisons();
	things();
	parts_of_things();
	wordnet();
	return unit_end();
}
