#include "synth/unseen_text.h"

#include <ctype.h>
#include <stdio.h>
#include <string.h>

/* A text in the making. */
struct writer {
	const struct synth_unseen *x;
	const struct synth_unseen_fill *fill;
	struct rng *rng;
	char *text;
	size_t used;
	int is_bad;
	int is_it; /* the first clause's first anchor was named before: it is "it" now */
};

static void put(struct writer *w, const char *text)
{
	size_t n = strlen(text);

	if (w->used + n >= SYNTH_UNSEEN_TEXT) {
		w->is_bad = 1;
		return;
	}
	memcpy(w->text + w->used, text, n + 1);
	w->used += n;
}

static void put_clauses(struct writer *w, const struct synth_unseen_phrase *p);

/* "small striped red mug" */
static void put_words(struct writer *w, const struct synth_unseen_phrase *p, int is_plural)
{
	if (p->size) {
		put(w, p->size);
		put(w, " ");
	}
	for (int i = 0; i < p->word_count; i++) {
		put(w, p->words[i]);
		put(w, " ");
	}
	if (p->colour) {
		put(w, p->colour);
		put(w, " ");
	}
	if (*p->noun)
		put(w, is_plural ? p->plural : p->noun);
	else
		put(w, is_plural ? "ones" : "one");
	w->is_bad |= !*p->noun && !p->word_count && !p->colour && !p->size && !p->clause_count;
}

/* The target where it is the noun alone that counts. */
static void put_noun(struct writer *w, const struct synth_unseen_phrase *p, int is_plural)
{
	put(w, is_plural ? p->plural : p->noun);
	w->is_bad |= !*p->noun;
}

/* "the plate that's behind the red ball", "the two balls" */
static void put_anchor(struct writer *w, int phrase)
{
	const struct synth_unseen_phrase *p = &w->x->phrases[phrase];

	put(w, p->count == 2 ? "the two " : "the ");
	put_words(w, p, p->count != PARSE_ONE);
	if (p->clause_count) {
		put(w, " ");
		put_clauses(w, p);
	}
}

static void put_wording(struct writer *w, const struct synth_unseen_clause *c, int is_first)
{
	for (const char *t = c->text; *t && !w->is_bad; t++) {
		char letter[2] = {*t, 0};
		if (*t != '%')
			put(w, letter);
		else if (*++t == 'A' && is_first && w->is_it)
			put(w, "it");
		else
			put_anchor(w, c->anchors[*t == 'A' ? 0 : c->anchor_count - 1]);
	}
	w->is_bad |= !c->text;
}

/* After the noun: "left of it", "that's left of it", "which has it on its right". */
static void put_after(struct writer *w, const struct synth_unseen_clause *c, int is_first, int is_nested)
{
	static const char *const copulas[] = {"", "", "that's ", "that is ", "which is "};
	/* Within another phrase the bare form could belong to either noun. */
	uint32_t from = is_nested ? 2 : 0;

	if (c->form == 'p' && !(c->degree == PARSE_MOST && !c->anchor_count))
		put(w, copulas[from + rng_below(w->rng, 5 - from)]);
	if (c->form == 'h')
		put(w, rng_below(w->rng, 2) ? "that " : "which ");
	put_wording(w, c, is_first);
}

static void put_clauses(struct writer *w, const struct synth_unseen_phrase *p)
{
	int is_nested = p != &w->x->phrases[0];

	for (int i = 0; i < p->clause_count; i++) {
		const struct synth_unseen_clause *c = &w->x->clauses[p->clauses[i]];
		if (i)
			put(w, " and ");
		w->is_bad |= c->form == 'c' || c->relation == PARSE_OTHER;
		put_after(w, c, !is_nested && !i, is_nested);
	}
}

/* The target's first clause, whose form must be one of these. */
static void put_first(struct writer *w, const char *forms)
{
	const struct synth_unseen_phrase *p = &w->x->phrases[0];
	const struct synth_unseen_clause *c = &w->x->clauses[p->clauses[0]];

	/* Nobody looks "nearest to the cup". */
	if (p->clause_count != 1 || !strchr(forms, c->form) || (!forms[1] && c->degree == PARSE_MOST)) {
		w->is_bad = 1;
		return;
	}
	if (forms[1] && c->form == 'p')
		put(w, "is ");
	put_wording(w, c, 1);
}

static void put_number(struct writer *w, int n)
{
	static const char *const numbers[] = {"two", "three", "four", "five", "six"};

	w->is_bad |= n < 2 || n > 6;
	if (!w->is_bad)
		put(w, numbers[n - 2]);
}

static void put_ordinal(struct writer *w, int k)
{
	static const char *const ordinals[][2] = {{"second", "2nd"}, {"third", "3rd"}, {"fourth", "4th"}};

	w->is_bad |= k < 2 || k > 4;
	if (!w->is_bad)
		put(w, ordinals[k - 2][rng_below(w->rng, 5) == 0]);
}

static void put_left_out(struct writer *w, int phrase)
{
	const struct synth_unseen_phrase *p = &w->x->phrases[phrase];

	put_words(w, p, 0);
	if (p->clause_count) {
		put(w, " ");
		put_clauses(w, p);
	}
}

/* The adjective of the first clause. */
static void put_adjective(struct writer *w, const struct synth_unseen_phrase *p)
{
	const struct synth_unseen_clause *c = &w->x->clauses[p->clauses[0]];

	w->is_bad |= !p->clause_count || c->form != 'c';
	if (!w->is_bad)
		put(w, c->text);
}

static void put_slot(struct writer *w, char slot)
{
	static const char *const ends[PARSE_RELATIONS] = {[PARSE_LEFT] = "left",
		[PARSE_RIGHT] = "right",
		[PARSE_FRONT] = "front",
		[PARSE_BEHIND] = "back"};
	const struct synth_unseen_phrase *p = &w->x->phrases[0];

	switch (slot) {
	case 'T':
	case 'P':
		put_words(w, p, slot == 'P');
		break;
	case 'N':
		put_noun(w, p, 0);
		break;
	case 'R':
		w->is_bad |= !p->clause_count && w->used > 4 && !strcmp(w->text + w->used - 4, "one ");
		put_clauses(w, p);
		break;
	case 'V':
		put_first(w, "ph");
		break;
	case 'L':
		put_first(w, "p");
		break;
	case 'A':
		w->is_bad |= !p->clause_count || !w->x->clauses[p->clauses[0]].anchor_count ||
			     (w->x->clauses[p->clauses[0]].form != 'p' &&
				     w->x->clauses[p->clauses[0]].form != 'c') ||
			     w->x->phrases[w->x->clauses[p->clauses[0]].anchors[0]].viewer;
		if (!w->is_bad)
			put_anchor(w, w->x->clauses[p->clauses[0]].anchors[0]);
		w->is_it = 1;
		break;
	case 'X':
	case 'Y':
		put_left_out(w, w->fill->left_out[slot - 'X']);
		break;
	case 'K':
		put_number(w, p->group ? p->group : p->count);
		break;
	case 'O':
		put_ordinal(w, p->ordinal);
		break;
	case 'E':
		put(w, ends[p->from]);
		break;
	case 'C':
		put_adjective(w, p);
		break;
	case 'F':
		put(w, w->fill->use);
		break;
	default: /* Z */
		put(w, w->fill->inner);
	}
}

static int starts_with_vowel(const char *word)
{
	return *word && strchr("aeiou", *word) != NULL;
}

/* No spaces before stops or at the end, or twice; "an" before a vowel. */
static void tidy(char *text)
{
	char from[SYNTH_UNSEEN_TEXT], *to = text;

	memcpy(from, text, strlen(text) + 1);
	for (const char *p = from; *p; p++) {
		if (*p == ' ' && (!p[1] || strchr(" ,?.", p[1])))
			continue;
		*to++ = *p;
		int is_word = p == from || p[-1] == ' ';
		if (is_word && *p == 'a' && p[1] == ' ' && starts_with_vowel(p + 2))
			*to++ = 'n';
	}
	*to = 0;
}

int synth_unseen_write(struct synth_unseen *x, const struct synth_unseen_fill *f, struct rng *rng)
{
	char text[SYNTH_UNSEEN_TEXT] = "";
	struct writer w = {.x = x, .fill = f, .rng = rng, .text = text};

	for (const char *p = f->frame; *p && !w.is_bad; p++) {
		char letter[2] = {*p, 0};
		if (*p == '%')
			put_slot(&w, *++p);
		else
			put(&w, letter);
	}
	/* "an" may make it one longer for each word. */
	if (w.is_bad || w.used > SYNTH_UNSEEN_TEXT - 24)
		return -1;
	tidy(text);
	memcpy(x->text, text, sizeof text);
	return 0;
}

/* Makes one word of five letters or more wrong: two letters change places, one is missing, or one is there
 * twice. The first and last letters stay. */
static void slip(char *text, struct rng *rng)
{
	char *best = NULL;
	size_t length = 0;
	uint32_t n = 0;

	for (char *p = text; *p;) {
		size_t k = 0;
		while (islower((unsigned char)p[k]))
			k++;
		if (k >= 5 && (p == text || p[-1] == ' ') && (!p[k] || p[k] == ' ') && !rng_below(rng, ++n)) {
			best = p;
			length = k;
		}
		p += k ? k : 1;
	}
	if (!best || strlen(text) + 1 >= SYNTH_UNSEEN_TEXT)
		return;
	char *at = best + 1 + rng_below(rng, (uint32_t)length - 3);
	uint32_t how = at[0] == at[1] ? 1 : rng_below(rng, 3);
	if (how == 0) {
		char letter = at[0];
		at[0] = at[1];
		at[1] = letter;
	} else if (how == 1) {
		memmove(at, at + 1, strlen(at));
	} else {
		memmove(at + 1, at, strlen(at) + 1);
	}
}

void synth_unseen_type(char *text, struct rng *rng)
{
	size_t n = strlen(text);

	if (!rng_below(rng, 3)) {
		text[0] = (char)toupper((unsigned char)text[0]);
		if (text[n - 1] != '?' && n + 1 < SYNTH_UNSEEN_TEXT)
			memcpy(text + n, ".", 2);
	} else if (!rng_below(rng, 5)) {
		char *apostrophe = strchr(text, '\'');
		if (apostrophe)
			memmove(apostrophe, apostrophe + 1, strlen(apostrophe));
		if (text[strlen(text) - 1] == '?')
			text[strlen(text) - 1] = 0;
	}
	if (!rng_below(rng, 14))
		slip(text, rng);
}
