#include "lang/examples_private.h"

#include <stdio.h>
#include <string.h>

int making_chance(struct making *m, double p)
{
	return rng_uniform(m->r) < p;
}

const char *making_pick(struct making *m, const struct example_list *list)
{
	return list->item[rng_below(m->r, (uint32_t)list->n)];
}

int making_put(struct making *m, const char *text, size_t length)
{
	if (m->n == MADE_MOST)
		return m->n - 1;
	struct made *w = &m->word[m->n];
	*w = (struct made){.head = ROOT};
	snprintf(w->text, sizeof w->text, "%.*s", (int)length, text);
	return m->n++;
}

/* One of the choices of "a|b|"; words of it are parted by "_". Returns the index of the last. */
int making_put_choice(struct making *m, const char *text, size_t length)
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
		last = making_put(m, text, (size_t)(stop - text));
		text = stop + (stop < end && *stop == '_');
	}
	return last;
}

int making_put_any(struct making *m, const char *choices)
{
	return making_put_choice(m, choices, strlen(choices));
}

void making_mark(struct making *m, int from, int to, enum word_role role, int head)
{
	for (int i = from; i < to; i++)
		if (strcmp(m->word[i].text, "of")) {
			m->word[i].role = role;
			m->word[i].head = head;
		}
}

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

void making_put_before(struct making *m, int *list, int *count)
{
	const struct example_clause *c = &m->w->before.item[rng_below(m->r, (uint32_t)m->w->before.n)];
	const char *star = strchr(c->text, '*');
	size_t length = strcspn(star + 1, " ");
	int i;

	if (star > c->text)
		making_put(m, c->text, (size_t)(star - c->text - 1));
	i = making_put_choice(m, star + 1, length);
	m->word[i].role = ROLE_PREDICATE;
	m->word[i].relation = c->relation;
	if (star[1 + length]) /* "left hand" */
		making_put_any(m, star + 2 + length);
	list[(*count)++] = i;
}

static void put_marked(struct making *m, const struct example_list *list, int owner)
{
	int first = m->n;

	making_put_any(m, making_pick(m, list));
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
		making_put_any(m, "in|in|in_a|coloured|painted|all_in");
		put_marked(m, &example_hues, owner);
		return;
	case 1:
		making_put_any(m, "of|of|of_a|in_a");
		put_marked(m, &example_hues, owner);
		making_put_any(m, "colour|color|shade|tone");
		return;
	case 2:
		making_put_any(m, "whose_colour_is|whose_color_is|that_is|which_is|that_is_all");
		put_marked(m, &example_hues, owner);
		return;
	case 3:
		making_put_any(m, "with_a");
		put_marked(m, making_chance(m, 0.5) ? &example_hues : &example_attributes, owner);
		making_put_any(m, "surface|finish|coat|pattern|look");
		return;
	default:
		making_put_any(m, "made_of|made_of|made_out_of|of");
		put_marked(m, &example_stuffs, owner);
		return;
	}
}

/* A noun with what stands before it, and at times its look after it. Returns its index. */
int making_noun_phrase(
	struct making *m, enum word_role role, int head, const char *noun, int is_plural, int plain)
{
	static const char determiners[] =
		"the|the|the|the|the|the|a|a|an|my|that|this|these|another|some|our|";
	int list[8], count = 0, first, last, owner;

	if (!plain)
		making_put_any(m, is_plural
					  ? making_chance(m, 0.3)
						    ? "the_two|two|three|the_three|four|both|2|3|some|several"
						    : "the|the|these|my|"
					  : determiners);
	if (!plain && making_chance(m, role == ROLE_TARGET ? 0.3 : 0.15))
		making_put_before(m, list, &count);
	if (making_chance(m, 0.35))
		for (int k = making_chance(m, 0.25) ? 2 : 1; k; k--) {
			first = m->n;
			making_put_any(m, making_pick(m, &example_attributes));
			for (int i = first; i < m->n && count < 8; i++) {
				m->word[i].role = ROLE_ATTRIBUTE;
				list[count++] = i;
			}
			if (k > 1 && making_chance(m, 0.3))
				making_put(m, "and", 3);
		}
	first = m->n;
	last = making_put_any(m, noun);
	if (is_plural)
		make_plural(m->word[last].text);
	owner = role == ROLE_TARGET ? ROOT : last;
	making_mark(m, first, last, ROLE_NAME, owner);
	m->word[last].role = role;
	m->word[last].head = head;
	for (int i = 0; i < count; i++)
		m->word[list[i]].head = owner;
	if (making_chance(m, role == ROLE_TARGET ? 0.1 : 0.03)) {
		put_look(m, owner);
		if (role == ROLE_TARGET && making_chance(m, 0.4))
			making_put(m, ",", 1);
	}
	return last;
}

/* Whether the word before already is an article or the like. */
int making_follows_article(const struct making *m)
{
	static const char *const words[] = {"the", "a", "this", "that", "all", "every", "each", "other",
		"same", "correct", "which", "first", "second", "third", "fourth", "last", "any", "2nd", "no"};

	for (size_t i = 0; m->n && i < sizeof words / sizeof *words; i++)
		if (!strcmp(m->word[m->n - 1].text, words[i]))
			return 1;
	return 0;
}

void making_function(struct making *m, int figure)
{
	struct example_clause c = {PARSE_OTHER, 0, making_pick(m, m->w->functions)};

	making_expand(m, &c, figure, 0, 0);
}

int making_anchor(struct making *m, enum word_role role, int may_nest)
{
	int head, first = m->n;

	m->depth++;
	if (making_chance(m, 0.05)) { /* "the red one", "it" names nothing */
		making_put_any(m, "the|the|that|another");
		if (making_chance(m, 0.6))
			making_put_any(m, making_pick(m, &example_attributes));
		head = making_put_any(m, "one|thing|object|other_one|ones");
		making_mark(m, head, head + 1, role, ROOT);
		if (head - first == 2 && strcmp(m->word[head - 1].text, "other"))
			making_mark(m, head - 1, head, ROLE_ATTRIBUTE, head);
	} else if (making_chance(m, 0.04)) { /* "the thing that boils water" */
		making_put_any(m, "the|the|a|that");
		head = making_put_any(m, "thing|thing|one|object|item");
		making_mark(m, head, head + 1, role, ROOT);
		making_function(m, head);
		m->depth--;
		return head;
	} else {
		head = making_noun_phrase(m, role, ROOT, making_pick(m, m->nouns), making_chance(m, 0.15),
			m->n && making_follows_article(m));
	}
	if (may_nest && m->depth < DEPTH_MOST + 1 && making_chance(m, 0.35)) {
		if (making_chance(m, 0.4))
			making_put_any(m, "that_is|that_'s|which_is");
		making_clause(m, head,
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
		return making_put_any(m,
			has ? "has_no|does_n't_have_a|has_n't_got_a"
			    : "without|without|without_a|without_the|with_no|that_has_no|that_does_n't_have_a|which_does_not_have_a|"
			      "not_the_one_with_the");
	return making_put_any(m, has ? "has|has|has_got|'s_got"
				     : "with|with|with|that_has|which_has|having|that_have|that_'s_got");
}

void making_expand(struct making *m, const struct example_clause *c, int figure, int denied, int has)
{
	int anchors[4], n = 0, main = -1, with = -1;

	for (const char *p = c->text; *p;) {
		size_t length = strcspn(p, " ");
		if (*p == '*') {
			main = making_put_choice(m, p + 1, length - 1);
		} else if ((*p == '@' || *p == '0') && length == 1) {
			int is_last = !strchr(p, ' ');
			if (n < 4)
				anchors[n++] = making_anchor(
					m, ROLE_ANCHOR, *p == '@' && (is_last || making_chance(m, 0.3)));
			/* "the desk and the chair" */
			if (n < 4 && *p == '@' && is_last && making_chance(m, 0.06)) {
				making_put(m, "and", 3);
				anchors[n++] = making_anchor(m, ROLE_ANCHOR, 0);
			}
		} else if (*p == '%' && length == 1) {
			if (n < 4)
				anchors[n++] = making_noun_phrase(m, ROLE_ANCHOR, ROOT,
					m->nouns->item[m->noun], making_chance(m, 0.2), 1);
		} else if (*p == '$' && length == 1) {
			int first = m->n;
			put_having(m, has, denied);
			/* the word that means having is the relation's where no other is */
			for (with = m->n - 1; with > first; with--)
				if (strstr("with without has have having got", m->word[with].text) &&
					strlen(m->word[with].text) > 2)
					break;
		} else if (*p == '^' && length == 1) {
			making_put_any(m,
				"||||||sitting|standing|placed|lying|located|resting|leaning|stacked|hanging|mounted|sits|set|positioned|"
				"found|set_down|that_you_can_see|that_stands|that_rests|kept");
		} else if (*p == '~' && length == 1) {
			making_put_any(m, "||||just|directly|right|immediately");
		} else {
			making_put_choice(m, p, length);
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
	making_put_any(m,
		is_relative
			? "standing|lying|resting|placed|located|positioned|found|set_down|put|kept|seen|that_stands|"
			  "that_lies|that_you_can_see|which_can_be_seen|that_was_put|you_see|to_be_found|that_rests"
			: "standing|lying|resting|placed|located|positioned|found|set_down|put|kept|seen");
}

void making_clause(struct making *m, int figure, int forms, int denied)
{
	const struct example_clauses *of;
	const struct example_clause *c;
	int tries = 0;

	do {
		of = (forms & (FORM_HAS | FORM_WITH))		       ? &m->w->having
		     : (forms & FORM_HAVING) && making_chance(m, 0.3)  ? &m->w->having
		     : (forms & FORM_TURNED) && making_chance(m, 0.12) ? &m->w->turned
								       : &m->w->placed;
		c = &of->item[rng_below(m->r, (uint32_t)of->n)];
	} while (((c->negated && (denied || making_chance(m, 0.5))) ||
			 ((forms & FORM_HAS) && c->text[0] != '$')) &&
		 ++tries < 50);
	if (c->text[0] == '$' && !denied && !c->negated)
		denied = making_chance(m, 0.18);
	if (of == &m->w->placed && (forms & FORM_TURNED) && making_chance(m, 0.25))
		making_put_any(m, ",|that_is|that_'s|which_is|it_is|that_sits");
	else if (of == &m->w->placed && !strchr("*^", c->text[0]) && strncmp(c->text, "not ", 4) != 0 &&
		 strncmp(c->text, "the ", 4) != 0 && strncmp(c->text, "that ", 5) != 0 &&
		 making_chance(m, 0.2))
		put_pose(m, forms & FORM_TURNED);
	making_expand(m, c, figure, denied, forms & FORM_HAS);
}
