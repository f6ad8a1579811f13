#include "lang/sentence.h"

#include "lang/phrases.h"

#include <string.h>

static const char *const relation_names[LANG_RELATIONS] = {"left", "right", "front", "behind", "near", "on",
	"under", "above", "nearest to", "farthest from", "between", "left side", "right side", "front side",
	"back side", "middle", "leftmost", "rightmost", "nearest", "farthest", "middle one", "largest",
	"smallest", "tallest", "highest", "lowest"};

const char *lang_relation_name(enum lang_relation r)
{
	return relation_names[r];
}

/* Adds text to a word, as much as there is room for. */
static void append(struct lang_word *w, const char *text, size_t length)
{
	size_t have = strlen(w->text), room = LANG_LENGTH - 1 - have;

	memcpy(w->text + have, text, length < room ? length : room);
	w->text[have + (length < room ? length : room)] = 0;
}

/* Words from pieces; hyphens only part them. */
static void read_words(struct lang_sentence *s, const char *pieces)
{
	int piece = 0;

	for (const char *p = pieces; *p; piece++) {
		size_t n = strcspn(p, " ");
		if (n > 2 && p[0] == '#' && p[1] == '#' && s->word_count) {
			struct lang_word *w = &s->words[s->word_count - 1];
			if (w->first + w->count == piece) {
				append(w, p + 2, n - 2);
				w->count++;
			}
		} else if (n != 1 || *p != '-') {
			if (s->word_count == LANG_WORDS)
				return;
			struct lang_word *w = &s->words[s->word_count++];
			*w = (struct lang_word){.first = piece, .count = 1};
			append(w, p, n);
		}
		p += n + (p[n] == ' ');
	}
}

static void put(struct lang_phrase *p, int word)
{
	if (p->n < LANG_WORDS)
		p->words[p->n++] = (unsigned char)word;
}

static const char *text_of(const struct lang_sentence *s, const struct lang_phrase *p, int i)
{
	return s->words[p->words[i]].text;
}

static int has_one_of(const struct lang_sentence *s, const struct lang_phrase *p, const char *list)
{
	for (int i = 0; i < p->n; i++)
		if (lang_is_one_of(text_of(s, p, i), list))
			return 1;
	return 0;
}

/* "that you can see" speaks of no can. */
static int is_auxiliary(const struct lang_sentence *s, int word)
{
	return word && !strcmp(s->words[word].text, "can") &&
	       lang_is_one_of(s->words[word - 1].text, lang_viewers);
}

/* Keeps the words that say something. */
static void keep_content(const struct lang_sentence *s, struct lang_phrase *p)
{
	int n = 0;

	for (int i = 0; i < p->n; i++)
		if (lang_says_something(text_of(s, p, i)) && !is_auxiliary(s, p->words[i]))
			p->words[n++] = p->words[i];
	p->n = n;
}

/* Up to where the words after a phrase are its anchors. */
static int anchor_end(const struct lang_sentence *s, const struct lang_phrase *p)
{
	int end = 0;

	while (end < p->n && !(lang_is_one_of(text_of(s, p, end), ", . ;") ||
				     (end && lang_is_one_of(text_of(s, p, end), lang_enders))))
		end++;
	return end;
}

/* Cuts words [from,to) at each "and" before an article, or (a pair) at the first "and" if there is none
 * such. */
static void cut_anchors(struct lang_clause *c, const struct lang_sentence *s, const struct lang_phrase *p,
	int from, int to, int is_pair)
{
	struct lang_phrase parts[LANG_ANCHORS] = {{0}};
	int n = 0, plain_and = -1, cuts = 0;

	while (to > from && lang_is_one_of(text_of(s, p, to - 1), lang_links))
		to--;
	for (int i = from; i < to; i++)
		if (lang_is_one_of(text_of(s, p, i), "and")) {
			plain_and = plain_and < 0 ? i : plain_and;
			cuts += i + 1 < to && lang_is_one_of(text_of(s, p, i + 1), lang_determiners);
		}
	for (int i = from; i < to; i++) {
		const int is_and = lang_is_one_of(text_of(s, p, i), "and");
		const int is_cut =
			is_and && (cuts ? i + 1 < to && lang_is_one_of(text_of(s, p, i + 1), lang_determiners)
					: is_pair && i == plain_and);
		if (!is_cut)
			put(&parts[n], p->words[i]);
		else if (++n == LANG_ANCHORS)
			break;
	}
	for (int i = 0; i < LANG_ANCHORS; i++) {
		keep_content(s, &parts[i]);
		if (parts[i].n)
			c->anchors[c->anchor_count++] = parts[i];
	}
}

static int side_of(enum lang_relation r)
{
	switch (r) {
	case LANG_LEFT:
		return LANG_LEFT_SIDE;
	case LANG_RIGHT:
		return LANG_RIGHT_SIDE;
	case LANG_FRONT:
		return LANG_FRONT_SIDE;
	case LANG_BEHIND:
		return LANG_BACK_SIDE;
	default:
		return -1;
	}
}

/* What a phrase with anchors says, where it says it of who looks, or of a table: *relation then has no
 * anchors. 1 where it does, 0 where it is of other things, -1 where it says nothing. */
static int is_about_scene(
	const struct lang_sentence *s, const struct lang_phrase *p, int end, enum lang_relation *relation)
{
	struct lang_phrase anchor = *p;

	anchor.n = end;
	if (has_one_of(s, &anchor, lang_viewers) &&
		(*relation == LANG_NEAREST || *relation == LANG_NEAR || *relation == LANG_FRONT)) {
		*relation = LANG_NEAREST_US;
		return 1;
	}
	if (has_one_of(s, &anchor, lang_viewers) && *relation == LANG_FARTHEST) {
		*relation = LANG_FARTHEST_US;
		return 1;
	}
	if (!has_one_of(s, &anchor, lang_surfaces))
		return 0;
	if (side_of(*relation) >= 0) {
		*relation = (enum lang_relation)side_of(*relation);
		return 1;
	}
	return *relation == LANG_ON || *relation == LANG_NEAR || *relation == LANG_ABOVE ? -1 : 0;
}

/* The words after a phrase make its clause; those past the anchors go back to the target. */
static void read_clause(
	struct lang_sentence *s, const struct lang_match *m, const struct lang_phrase *p, int *last)
{
	struct lang_clause c = {.relation = m->relation};
	int end = anchor_end(s, p), about = 0;

	if (m->form == LANG_AFTER)
		about = is_about_scene(s, p, end, &c.relation);
	if (m->form == LANG_AGAIN && *last >= 0) {
		c.anchor_count = s->clauses[*last].anchor_count;
		memcpy(c.anchors, s->clauses[*last].anchors, sizeof c.anchors);
	} else if ((m->form == LANG_AFTER && !about) || m->form == LANG_PAIR) {
		cut_anchors(&c, s, p, 0, end, m->form == LANG_PAIR);
	}
	for (int i = end; i < p->n; i++)
		put(&s->target, p->words[i]);
	const int has_anchors = c.relation <= LANG_BETWEEN;
	if (about < 0 || (has_anchors && !c.anchor_count) || s->clause_count == LANG_CLAUSES)
		return;
	if (has_anchors)
		*last = s->clause_count;
	s->clauses[s->clause_count++] = c;
}

/* "with A and B on either side": the anchors came before the phrase, and are taken from it. */
static void read_pair_before(struct lang_sentence *s, struct lang_phrase *p)
{
	struct lang_clause c = {.relation = LANG_BETWEEN};
	int with = p->n;

	while (with && !lang_is_one_of(text_of(s, p, with - 1), "with"))
		with--;
	if (!with)
		return;
	cut_anchors(&c, s, p, with, p->n, 1);
	p->n = with - 1;
	if (c.anchor_count && s->clause_count < LANG_CLAUSES)
		s->clauses[s->clause_count++] = c;
}

/* The last word of the first run of target words; "and" goes on. */
static int find_head(const struct lang_sentence *s)
{
	int head = -1;

	for (int i = 0, at = 0; i < s->word_count; i++) {
		while (at < s->target.n && s->target.words[at] < i)
			at++;
		if (at < s->target.n && s->target.words[at] == i)
			head = i;
		else if (head >= 0 && strcmp(s->words[i].text, "and") != 0)
			break;
	}
	return head;
}

void lang_sentence_read(struct lang_sentence *s, const char *pieces)
{
	struct lang_match m, open = {0}; /* open: the phrase whose words are being gathered */
	struct lang_phrase gathered = {0};
	int last = -1, is_open = 0;

	memset(s, 0, sizeof *s);
	read_words(s, pieces);
	for (int at = 0; at < s->word_count;) {
		struct lang_phrase *into = is_open ? &gathered : &s->target;
		if (!lang_match(s, at, &m)) {
			put(into, at++);
			continue;
		}
		at += m.length;
		if (m.form == LANG_ADJECTIVE || m.form == LANG_SIDE_WORD || m.form == LANG_OUTERMOST) {
			if (s->clause_count < LANG_CLAUSES)
				s->clauses[s->clause_count++] = (struct lang_clause){.relation = m.relation};
			continue;
		}
		if (m.form == LANG_PAIR_BEFORE) {
			read_pair_before(s, into);
			continue;
		}
		if (is_open)
			read_clause(s, &open, &gathered, &last);
		open = m;
		is_open = 1;
		gathered.n = 0;
	}
	if (is_open)
		read_clause(s, &open, &gathered, &last);
	keep_content(s, &s->target);
	for (int i = 0; i < s->word_count; i++)
		put(&s->all, i);
	keep_content(s, &s->all);
	s->head = find_head(s);
}
