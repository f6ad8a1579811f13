#include "lang/examples.h"

#include <ctype.h>
#include <stdio.h>
#include <string.h>

enum { MADE_MOST = 160, MADE_LENGTH = 40, DEPTH_MOST = 2 };

/* A sentence in the making: words with what they are. */
struct making {
	const struct example_wordings *w;
	const struct example_list *nouns;
	struct rng *r;
	int n, depth, has_noun, noun, is_plural;
	int spoken_of[2], spoken; /* anchors that wait for their predicate: "see the box ? T near it" */
	struct made {
		char text[MADE_LENGTH];
		enum word_role role;
		int head, negated, begin;
		enum parse_relation relation;
	} word[MADE_MOST];
};

static int chance(struct making *m, double p)
{
	return rng_uniform(m->r) < p;
}

static const char *pick(struct making *m, const struct example_list *list)
{
	return list->item[rng_below(m->r, (uint32_t)list->n)];
}

static int put(struct making *m, const char *text, size_t length)
{
	if (m->n == MADE_MOST)
		return m->n - 1;
	struct made *w = &m->word[m->n];
	*w = (struct made){.head = ROOT};
	snprintf(w->text, sizeof w->text, "%.*s", (int)length, text);
	return m->n++;
}

/* One of the choices of "a|b|"; words of it are parted by "_". Returns the index of the last. */
static int put_choice(struct making *m, const char *text, size_t length)
{
	int choices = 1, last = m->n - 1;
	const char *end = text + length;

	for (const char *p = text; p < end; p++)
		choices += *p == '|';
	for (int skip = (int)rng_below(m->r, (uint32_t)choices); skip; text++)
		skip -= *text == '|';
	while (text < end && *text != '|') {
		const char *stop = text;
		while (stop < end && *stop != '_' && *stop != '|')
			stop++;
		last = put(m, text, (size_t)(stop - text));
		text = stop + (stop < end && *stop == '_');
	}
	return last;
}

static int put_any(struct making *m, const char *choices)
{
	return put_choice(m, choices, strlen(choices));
}

static void mark(struct making *m, int from, int to, enum word_role role, int head)
{
	for (int i = from; i < to; i++)
		if (strcmp(m->word[i].text, "of")) {
			m->word[i].role = role;
			m->word[i].head = head;
		}
}

static void clause(struct making *m, int figure, int forms, int denied);

enum { FORM_PLACED = 1, FORM_HAVING = 2, FORM_TURNED = 4, FORM_HAS = 8, FORM_WITH = 16 };

static void make_plural(char *noun)
{
	size_t n = strlen(noun);

	if (n + 3 > MADE_LENGTH)
		return;
	if (n > 2 && (noun[n - 1] == 's' || noun[n - 1] == 'x' || !strcmp(noun + n - 2, "ch") ||
			     !strcmp(noun + n - 2, "sh")))
		snprintf(noun + n, MADE_LENGTH - n, "es");
	else if (n > 1 && noun[n - 1] == 'f')
		snprintf(noun + n - 1, MADE_LENGTH - n, "ves");
	else if (n > 2 && noun[n - 1] == 'y' && !strchr("aeiou", noun[n - 2]))
		snprintf(noun + n - 1, MADE_LENGTH - n, "ies");
	else
		snprintf(noun + n, MADE_LENGTH - n, "s");
}

static void put_before(struct making *m, int *list, int *count)
{
	const struct example_clause *c = &m->w->before.item[rng_below(m->r, (uint32_t)m->w->before.n)];
	const char *star = strchr(c->text, '*');
	size_t length = strcspn(star + 1, " ");
	int i;

	if (star > c->text)
		put(m, c->text, (size_t)(star - c->text - 1));
	i = put_choice(m, star + 1, length);
	m->word[i].role = ROLE_PREDICATE;
	m->word[i].relation = c->relation;
	if (star[1 + length]) /* "left hand" */
		put_any(m, star + 2 + length);
	list[(*count)++] = i;
}

static void put_marked(struct making *m, const struct example_list *list, int owner)
{
	int first = m->n;

	put_any(m, pick(m, list));
	for (int i = first; i < m->n; i++) {
		m->word[i].role = ROLE_ATTRIBUTE;
		m->word[i].head = owner;
	}
}

/* "in dark green", "of red colour", "made of wood", "with a shiny surface". */
static void put_look(struct making *m, int owner)
{
	switch (rng_below(m->r, 6)) {
	case 0:
		put_any(m, "in|in|in_a|coloured|painted|all_in");
		put_marked(m, &example_hues, owner);
		return;
	case 1:
		put_any(m, "of|of|of_a|in_a");
		put_marked(m, &example_hues, owner);
		put_any(m, "colour|color|shade|tone");
		return;
	case 2:
		put_any(m, "whose_colour_is|whose_color_is|that_is|which_is|that_is_all");
		put_marked(m, &example_hues, owner);
		return;
	case 3:
		put_any(m, "with_a");
		put_marked(m, chance(m, 0.5) ? &example_hues : &example_attributes, owner);
		put_any(m, "surface|finish|coat|pattern|look");
		return;
	default:
		put_any(m, "made_of|made_of|made_out_of|of");
		put_marked(m, &example_stuffs, owner);
		return;
	}
}

/* A noun with what stands before it, and at times its look after it. Returns its index. */
static int noun_phrase(
	struct making *m, enum word_role role, int head, const char *noun, int is_plural, int plain)
{
	static const char determiners[] =
		"the|the|the|the|the|the|a|a|an|my|that|this|these|another|some|our|";
	int list[8], count = 0, first, last, owner;

	if (!plain)
		put_any(m, is_plural ? chance(m, 0.3)
					       ? "the_two|two|three|the_three|four|both|2|3|some|several"
					       : "the|the|these|my|"
				     : determiners);
	if (!plain && chance(m, role == ROLE_TARGET ? 0.3 : 0.15))
		put_before(m, list, &count);
	if (chance(m, 0.35))
		for (int k = chance(m, 0.25) ? 2 : 1; k; k--) {
			first = m->n;
			put_any(m, pick(m, &example_attributes));
			for (int i = first; i < m->n && count < 8; i++) {
				m->word[i].role = ROLE_ATTRIBUTE;
				list[count++] = i;
			}
			if (k > 1 && chance(m, 0.3))
				put(m, "and", 3);
		}
	first = m->n;
	last = put_any(m, noun);
	if (is_plural)
		make_plural(m->word[last].text);
	owner = role == ROLE_TARGET ? ROOT : last;
	mark(m, first, last, ROLE_NAME, owner);
	m->word[last].role = role;
	m->word[last].head = head;
	for (int i = 0; i < count; i++)
		m->word[list[i]].head = owner;
	if (chance(m, role == ROLE_TARGET ? 0.1 : 0.03)) {
		put_look(m, owner);
		if (role == ROLE_TARGET && chance(m, 0.4))
			put(m, ",", 1);
	}
	return last;
}

/* Whether the word before already is an article or the like. */
static int follows_article(const struct making *m)
{
	static const char *const words[] = {"the", "a", "this", "that", "all", "every", "each", "other",
		"same", "correct", "which", "first", "second", "third", "fourth", "last", "any", "2nd", "no"};

	for (size_t i = 0; m->n && i < sizeof words / sizeof *words; i++)
		if (!strcmp(m->word[m->n - 1].text, words[i]))
			return 1;
	return 0;
}

static int anchor(struct making *m, enum word_role role, int may_nest)
{
	int head, first = m->n;

	m->depth++;
	if (chance(m, 0.05)) { /* "the red one", "it" names nothing */
		put_any(m, "the|the|that|another");
		if (chance(m, 0.6))
			put_any(m, pick(m, &example_attributes));
		head = put_any(m, "one|thing|object|other_one|ones");
		mark(m, head, head + 1, role, ROOT);
		if (head - first == 2 && strcmp(m->word[head - 1].text, "other"))
			mark(m, head - 1, head, ROLE_ATTRIBUTE, head);
	} else {
		head = noun_phrase(
			m, role, ROOT, pick(m, m->nouns), chance(m, 0.15), m->n && follows_article(m));
	}
	if (may_nest && m->depth < DEPTH_MOST + 1 && chance(m, 0.35)) {
		if (chance(m, 0.4))
			put_any(m, "that_is|that_'s|which_is");
		clause(m, head,
			strcmp(m->word[m->n - 1].text, "is") && strcmp(m->word[m->n - 1].text, "'s")
				? FORM_PLACED | FORM_HAVING | FORM_TURNED
				: FORM_PLACED,
			0);
	}
	m->depth--;
	return head;
}

/* "with", "that has", or that it has not. Returns the word that says so. */
static int put_having(struct making *m, int has, int denied)
{
	if (denied)
		return put_any(m,
			has ? "has_no|does_n't_have_a|has_n't_got_a"
			    : "without|without|without_a|without_the|with_no|that_has_no|that_does_n't_have_a|which_does_not_have_a|"
			      "not_the_one_with_the");
	return put_any(m, has ? "has|has|has_got|'s_got"
			      : "with|with|with|that_has|which_has|having|that_have|that_'s_got");
}

static void expand_clause(struct making *m, const struct example_clause *c, int figure, int denied, int has)
{
	int anchors[4], n = 0, main = -1, with = -1;

	for (const char *p = c->text; *p;) {
		size_t length = strcspn(p, " ");
		if (*p == '*') {
			main = put_choice(m, p + 1, length - 1);
		} else if ((*p == '@' || *p == '0') && length == 1) {
			int is_last = !strchr(p, ' ');
			if (n < 4)
				anchors[n++] =
					anchor(m, ROLE_ANCHOR, *p == '@' && (is_last || chance(m, 0.3)));
			/* "the desk and the chair" */
			if (n < 4 && *p == '@' && is_last && chance(m, 0.06)) {
				put(m, "and", 3);
				anchors[n++] = anchor(m, ROLE_ANCHOR, 0);
			}
		} else if (*p == '$' && length == 1) {
			int first = m->n;
			put_having(m, has, denied);
			/* the word that means having is the relation's where no other is */
			for (with = m->n - 1; with > first; with--)
				if (strstr("with without has have having got", m->word[with].text) &&
					strlen(m->word[with].text) > 2)
					break;
		} else if (*p == '^' && length == 1) {
			put_any(m,
				"||||||sitting|standing|placed|lying|located|resting|leaning|stacked|hanging|mounted|sits|set|positioned|"
				"found|set_down|that_you_can_see|that_stands|that_rests|kept");
		} else if (*p == '~' && length == 1) {
			put_any(m, "||||just|directly|right|immediately");
		} else {
			put_choice(m, p, length);
		}
		p += length;
		p += *p == ' ';
	}
	if (main < 0)
		main = with;
	if (main < 0)
		return;
	m->word[main].role = ROLE_PREDICATE;
	m->word[main].relation = c->relation;
	m->word[main].negated = c->negated ^ denied;
	m->word[main].head = figure;
	for (int i = 0; i < n; i++)
		m->word[anchors[i]].head = main;
}

/* "standing", "that you can see" */
static void put_pose(struct making *m, int is_relative)
{
	put_any(m,
		is_relative
			? "standing|lying|resting|placed|located|positioned|found|set_down|put|kept|seen|that_stands|"
			  "that_lies|that_you_can_see|which_can_be_seen|that_was_put|you_see|to_be_found|that_rests"
			: "standing|lying|resting|placed|located|positioned|found|set_down|put|kept|seen");
}

static void clause(struct making *m, int figure, int forms, int denied)
{
	const struct example_clauses *of;
	const struct example_clause *c;
	int tries = 0;

	do {
		of = (forms & (FORM_HAS | FORM_WITH))		? &m->w->having
		     : (forms & FORM_HAVING) && chance(m, 0.3)	? &m->w->having
		     : (forms & FORM_TURNED) && chance(m, 0.12) ? &m->w->turned
								: &m->w->placed;
		c = &of->item[rng_below(m->r, (uint32_t)of->n)];
	} while (((c->negated && (denied || chance(m, 0.5))) || ((forms & FORM_HAS) && c->text[0] != '$')) &&
		 ++tries < 50);
	if (c->text[0] == '$' && !denied && !c->negated)
		denied = chance(m, 0.18);
	if (of == &m->w->placed && (forms & FORM_TURNED) && chance(m, 0.25))
		put_any(m, ",|that_is|that_'s|which_is|it_is|that_sits");
	else if (of == &m->w->placed && !strchr("*^", c->text[0]) && strncmp(c->text, "not ", 4) != 0 &&
		 strncmp(c->text, "the ", 4) != 0 && strncmp(c->text, "that ", 5) != 0 && chance(m, 0.2))
		put_pose(m, forms & FORM_TURNED);
	expand_clause(m, c, figure, denied, forms & FORM_HAS);
}

static const char *target_noun(struct making *m)
{
	return m->nouns->item[m->noun];
}

static void target_clauses(struct making *m)
{
	int n = chance(m, 0.12) ? 0 : chance(m, 0.25) ? 2 : 1;

	for (int k = 0; k < n; k++) {
		if (k)
			put_any(m, "and|,|,|and_is|");
		clause(m, ROOT, FORM_PLACED | FORM_HAVING | FORM_TURNED, 0);
	}
}

/* "the one", "the left one": the target where its noun is left out. */
static void target_one(struct making *m)
{
	int list[8], count = 0, last;

	put_any(m, "the|the|the|that|this");
	if (chance(m, 0.25))
		put_before(m, list, &count);
	if (chance(m, 0.2)) {
		last = put_any(m, pick(m, &example_attributes));
		mark(m, last, last + 1, ROLE_ATTRIBUTE, ROOT);
	}
	last = put_any(m, "one|one|one|thing|object");
	if (!m->has_noun)
		m->word[last].role = ROLE_TARGET;
}

static void function(struct making *m)
{
	struct example_clause c = {PARSE_OTHER, 0, pick(m, &m->w->functions)};

	expand_clause(m, &c, ROOT, 0, 0);
}

static void adjective(struct making *m)
{
	int list[8], count = 0;

	put_before(m, list, &count);
	m->word[list[0]].head = ROOT;
}

/* "the red one", that is meant. */
static void one_of_look(struct making *m, enum word_role role)
{
	int first, last;

	put_any(m, "the|the|that|a");
	first = m->n;
	put_any(m, pick(m, &example_attributes));
	last = put_any(m, "one|one|one|thing|ones");
	mark(m, last, last + 1, role, ROOT);
	mark(m, first, last, ROLE_ATTRIBUTE, role == ROLE_TARGET ? ROOT : last);
	if (chance(m, 0.25))
		clause(m, role == ROLE_TARGET ? ROOT : last, FORM_PLACED | FORM_HAVING, 0);
}

static const struct example_clause *pick_clause(struct making *m, const struct example_clauses *of)
{
	return &of->item[rng_below(m->r, (uint32_t)of->n)];
}

/* "near it", "between them": of what was spoken of. */
static void points_back(struct making *m, const struct example_clauses *of)
{
	const struct example_clause *c = pick_clause(m, of);
	int at = m->n;

	expand_clause(m, c, ROOT, 0, 0);
	while (at < m->n && m->word[at].role != ROLE_PREDICATE)
		at++;
	for (int k = 0; k < m->spoken && at < m->n; k++)
		m->word[m->spoken_of[k]].head = at;
}

/* 1 where the symbol was one. */
static int symbol(struct making *m, const char *p, size_t length, int before_sure)
{
	if (length == 2 && p[0] == 'C' && p[1] == '2') {
		clause(m, ROOT, FORM_PLACED, 1);
		return 1;
	}
	if (length != 1)
		return 0;
	switch (*p) {
	case 'T':
	case 'N':
		noun_phrase(m, ROLE_TARGET, ROOT, target_noun(m), *p == 'T' && chance(m, 0.06), before_sure);
		m->has_noun = 1;
		if (*p == 'T')
			target_clauses(m);
		return 1;
	case 'L':
		noun_phrase(m, ROLE_TARGET, ROOT, target_noun(m), 1, 1);
		m->has_noun = 1;
		return 1;
	case 'n':
		if (chance(m, 0.7))
			noun_phrase(m, ROLE_TARGET, ROOT, target_noun(m), 0, 1);
		else
			put(m, "one", 3);
		return 1;
	case 'U':
		target_one(m);
		if (chance(m, 0.8))
			target_clauses(m);
		return 1;
	case 'C':
		clause(m, ROOT, FORM_PLACED, 0);
		return 1;
	case 'H':
		clause(m, ROOT, FORM_HAS, 0);
		return 1;
	case 'A':
		adjective(m);
		return 1;
	case 'Q':
		one_of_look(m, ROLE_TARGET);
		return 1;
	case 'O':
		one_of_look(m, ROLE_ALSO);
		return 1;
	case 'q': {
		int first = m->n;
		put_any(m, pick(m, &example_attributes));
		mark(m, first, m->n, ROLE_ATTRIBUTE, ROOT);
		return 1;
	}
	case 'F':
		function(m);
		return 1;
	case 'V':
		anchor(m, ROLE_VIEW, 1);
		return 1;
	case 'B': {
		const int at = anchor(m, ROLE_ANCHOR, 0);
		if (m->spoken < 2)
			m->spoken_of[m->spoken++] = at;
		return 1;
	}
	case 'D':
		points_back(m, &m->w->back);
		return 1;
	case 'P':
		points_back(m, &m->w->back_to_two);
		return 1;
	case 'G':
		expand_clause(m, pick_clause(m, &m->w->inverted), ROOT, 0, 0);
		return 1;
	case 'W':
		clause(m, ROOT, FORM_WITH, 0);
		return 1;
	case 'X':
		anchor(m, ROLE_EXCEPT, 1);
		return 1;
	case 'S':
		anchor(m, ROLE_ALSO, 1);
		return 1;
	default:
		return 0;
	}
}

static void sentence(struct making *m, const char *text)
{
	/* the target's noun may stand after "the one", which is the target only where none does */
	m->has_noun = strpbrk(text, "NL") != NULL || strchr(text, 'n') == text;
	for (const char *p = text; *p;) {
		size_t length = strcspn(p, " ");
		if (!symbol(m, p, length, follows_article(m))) {
			int first = m->n;
			put_choice(m, p, length);
			for (int i = first; i < m->n; i++)
				if (!m->has_noun && (!strcmp(m->word[i].text, "thing") ||
							    !strncmp(m->word[i].text, "everything", 10) ||
							    !strcmp(m->word[i].text, "object") ||
							    !strcmp(m->word[i].text, "something") ||
							    !strcmp(m->word[i].text, "anything") ||
							    !strcmp(m->word[i].text, "whatever")))
					m->word[i].role = ROLE_TARGET;
		}
		p += length;
		p += *p == ' ';
	}
}

/* A slip of the fingers. */
static void misspell(struct making *m, char *w)
{
	size_t n = strlen(w), i;
	char c;

	if (n < 4 || !isalpha((unsigned char)w[0]))
		return;
	i = 1 + rng_below(m->r, (uint32_t)n - 2);
	if (chance(m, 0.5)) {
		c = w[i];
		w[i] = w[i + 1] ? w[i + 1] : w[i];
		w[i + 1] = w[i + 1] ? c : 0;
	} else {
		memmove(w + i, w + i + 1, n - i);
	}
}

static void write_text(struct making *m, struct example *x)
{
	int at = 0, capital = chance(m, 0.6), stops = chance(m, 0.75), slips = chance(m, 0.08);

	for (int i = 0; i < m->n; i++) {
		struct made *w = &m->word[i];
		int is_pause = !strcmp(w->text, ",") || !strcmp(w->text, ".") || !strcmp(w->text, "?");
		if (slips && chance(m, 0.2))
			misspell(m, w->text);
		if (is_pause && !stops)
			w->text[0] = 0;
		if (!w->text[0]) {
			w->begin = -1;
			continue;
		}
		if (at + MADE_LENGTH + 2 > EXAMPLE_LENGTH)
			break;
		if (at && !is_pause && w->text[0] != '\'' && strcmp(w->text, "n't") != 0)
			x->text[at++] = ' ';
		w->begin = at;
		at += sprintf(x->text + at, "%s", w->text);
	}
	x->text[at] = 0;
	if (capital)
		x->text[0] = (char)toupper((unsigned char)x->text[0]);
}

static void analyse(const struct making *m, struct example *x, const char *pieces)
{
	int at[MADE_MOST], next = 0;

	tokens_take(&x->tokens, x->text, pieces, NULL, 0);
	x->analysis = (struct analysis){.n = x->tokens.n};
	for (int i = 0; i < m->n; i++) {
		while (next < x->tokens.n && x->tokens.word[next].span.begin < m->word[i].begin)
			next++;
		at[i] = next < x->tokens.n && x->tokens.word[next].span.begin == m->word[i].begin ? next : -1;
	}
	for (int i = 0; i < x->tokens.n; i++)
		x->analysis.word[i].head = ROOT;
	for (int i = 0; i < m->n; i++) {
		const struct made *w = &m->word[i];
		if (at[i] < 0 || w->role == ROLE_NONE)
			continue;
		x->analysis.word[at[i]].role = w->role;
		x->analysis.word[at[i]].head = w->head == ROOT ? ROOT : at[w->head];
		x->analysis.word[at[i]].relation = w->relation;
		x->analysis.word[at[i]].negated = w->negated;
	}
	analysis_repair(&x->analysis);
}

void example_make(struct example *x, enum examples_set set, const char *pieces, struct rng *r)
{
	struct making m = {.w = set == EXAMPLES_TEST ? &example_wordings_test : &example_wordings_train,
		.nouns = &example_nouns[set],
		.r = r};

	m.noun = (int)rng_below(r, (uint32_t)m.nouns->n);
	sentence(&m, pick(&m, &m.w->sentences));
	write_text(&m, x);
	analyse(&m, x, pieces);
}
