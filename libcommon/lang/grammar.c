/* The analysis by grammar alone: noun phrases are runs of open-class words, and what stands between them
 * places one by the other. No vectors and no word list but the closed classes. */
#include "lang/analysis.h"
#include "lang/closed.h"

#include <string.h>

struct state {
	struct analysis *a;
	const struct tokens *t;
	int figure;    /* the noun that a following predicate is said of, ROOT for the target */
	int predicate; /* that waits for its anchor, or -1 */
	int has;       /* the noun after "with" or "has", which a place word and "it" may turn round; or -1 */
	int owner;     /* the figure at that "with" */
	int with;      /* the word "with" or "has" itself, or -1 */
	int negated;   /* the next predicate is */
	int found;     /* the target has its noun */
	int except, view, also;
};

/* An open word that may be a noun. */
static int is_open(const struct tokens *t, int i)
{
	return i < t->n && tokens_class(t, i) < 0 && strcmp(t->word[i].text, "'s");
}

/* A verb after its subject: "chair facing", "cat asleep on". */
static int is_verb(const struct tokens *t, int i)
{
	const char *w = t->word[i].text;

	return (token_ends(w, "ing", 3) || token_ends(w, "ed", 3)) && i + 1 < t->n &&
	       (tokens_class(t, i + 1) == CLOSED_PLACE || tokens_class(t, i + 1) == CLOSED_DETERMINER ||
		       tokens_class(t, i + 1) == CLOSED_PREPOSITION || tokens_class(t, i + 1) == CLOSED_WITH);
}

static int is_noun_start(const struct tokens *t, int i)
{
	return i < t->n && (is_open(t, i) || tokens_class(t, i) == CLOSED_GENERIC);
}

static int relation_of(const struct tokens *t, int i)
{
	return closed_words[t->word[i].closed].relation;
}

static int is_weak(const struct tokens *t, int i)
{
	int r = tokens_class(t, i) == CLOSED_PLACE ? relation_of(t, i) : -1;

	return r == PARSE_ON || r == PARSE_INSIDE || tokens_is(t, i, "at") || tokens_is(t, i, "by") ||
	       tokens_is(t, i, "against") || tokens_is(t, i, "over");
}

/* A place word that stands before a noun as an adjective does: "the left chair", "the middle one". */
static int is_adjective_place(const struct tokens *t, int i)
{
	int r;

	if (tokens_class(t, i) == CLOSED_SIZE)
		return 1;
	if (tokens_class(t, i) != CLOSED_PLACE)
		return 0;
	r = relation_of(t, i);
	if (r == PARSE_ON || r == PARSE_INSIDE || r == PARSE_BETWEEN || r == PARSE_WALL || r == PARSE_FLOOR ||
		r == PARSE_ACROSS || tokens_is(t, i, "by") || tokens_is(t, i, "at") ||
		tokens_is(t, i, "against") || tokens_is(t, i, "beside") || tokens_is(t, i, "near") ||
		tokens_is(t, i, "under") || tokens_is(t, i, "below") || tokens_is(t, i, "above") ||
		tokens_is(t, i, "behind"))
		return 0;
	return 1;
}

static void set(struct state *s, int i, enum word_role role, int head)
{
	s->a->word[i].role = role;
	s->a->word[i].head = head;
}

static void set_predicate(struct state *s, int i, int figure, enum parse_relation r)
{
	set(s, i, ROLE_PREDICATE, figure);
	s->a->word[i].relation = r;
	s->a->word[i].negated = s->negated;
	s->negated = 0;
}

/* Where the phrase that begins at i has its head; -1 where none begins. *end is past it. */
static int phrase_at(const struct state *s, int i, int *end)
{
	const struct tokens *t = s->t;
	int head = -1, j;

	for (j = i; j < t->n; j++) {
		int c = tokens_class(t, j);
		if (j > i && t->word[j].before && head >= 0)
			break;
		if (is_open(t, j)) {
			if (head >= 0 && is_verb(t, j))
				break;
			head = j;
		} else if (c == CLOSED_GENERIC) {
			head = j;
			j++;
			break;
		} else if (c == CLOSED_ATTRIBUTE || c == CLOSED_SIZE) {
			if (head >= 0 && c == CLOSED_SIZE)
				break;
		} else if (tokens_is(t, j, "wall") || tokens_is(t, j, "floor") || tokens_is(t, j, "ground") ||
			   tokens_is(t, j, "corner")) {
			if (!is_noun_start(t, j + 1))
				head = j;
		} else if ((head < 0 && (c == CLOSED_DETERMINER || c == CLOSED_NUMBER ||
						c == CLOSED_ORDINAL || c == CLOSED_ADVERB)) ||
			   (head >= 0 && tokens_is(t, j, "'s") && is_open(t, j + 1) && !is_verb(t, j + 1))) {
			continue;
		} else if (head < 0 && is_adjective_place(t, j)) {
			/* an adjective only where a noun follows at once */
			int k = j + 1;
			while (k < t->n &&
				(is_adjective_place(t, k) || tokens_class(t, k) == CLOSED_ATTRIBUTE ||
					tokens_class(t, k) == CLOSED_NUMBER))
				k++;
			if (!is_noun_start(t, k) || t->word[k].before || tokens_is(t, j + 1, "of"))
				break;
		} else {
			break;
		}
	}
	*end = j;
	return head;
}

static enum word_role role_of_phrase(struct state *s, int *hang)
{
	*hang = ROOT;
	if (s->view) {
		s->view = 0;
		return ROLE_VIEW;
	}
	if (s->except) {
		s->except = 0;
		return ROLE_EXCEPT;
	}
	if (s->predicate >= 0) {
		*hang = s->predicate;
		return ROLE_ANCHOR;
	}
	if (s->also && s->found) {
		s->also = 0;
		return ROLE_ALSO;
	}
	return ROLE_TARGET;
}

static int is_generic(const struct tokens *t, int i)
{
	return tokens_class(t, i) == CLOSED_GENERIC;
}

/* The phrase from i to end with its head; returns end. */
static int take_phrase(struct state *s, int i, int head, int end)
{
	const struct tokens *t = s->t;
	int hang, of;
	enum word_role role = role_of_phrase(s, &hang);

	/* "the one", once the target is known, is the target again */
	if (role == ROLE_TARGET && s->found && !is_generic(t, head) && s->with < 0 && !t->word[i].before &&
		i > 0 && tokens_class(t, i - 1) != CLOSED_BE)
		role = ROLE_NONE;
	set(s, head, role, hang);
	of = role == ROLE_TARGET ? ROOT : head;
	for (int j = i; j < end; j++) {
		if (j == head)
			continue;
		if (tokens_class(t, j) == CLOSED_SIZE || tokens_class(t, j) == CLOSED_PLACE)
			set_predicate(s, j, of, (enum parse_relation)relation_of(t, j));
		else if (tokens_class(t, j) == CLOSED_ATTRIBUTE)
			set(s, j, ROLE_ATTRIBUTE, of);
		else if (is_open(t, j))
			set(s, j,
				j + 1 == head || (j < head && is_open(t, j + 1)) ? ROLE_NAME : ROLE_ATTRIBUTE,
				of);
	}
	if (role == ROLE_TARGET) {
		s->found |= !is_generic(t, head);
		s->figure = ROOT;
	} else if (role != ROLE_NONE) {
		s->figure = head;
	}
	if (role == ROLE_ANCHOR && s->with >= 0 && s->predicate == s->with)
		s->has = head;
	/* "the desk and the chair": another anchor of the same */
	if (!(role == ROLE_ANCHOR && end < t->n &&
		    (tokens_class(t, end) == CLOSED_CONJUNCTION || t->word[end].before) &&
		    s->a->word[s->predicate].relation == PARSE_BETWEEN))
		s->predicate = -1;
	return end;
}

/* The main word of the place words from i; *end past them. */
static int place_at(const struct state *s, int i, int *end)
{
	const struct tokens *t = s->t;
	int best = -1, j;

	for (j = i; j < t->n; j++) {
		int c = tokens_class(t, j);
		if (j > i && t->word[j].before)
			break;
		if (c == CLOSED_PLACE || (c == CLOSED_SIZE && best < 0)) {
			if (best < 0 || is_weak(t, best) || tokens_is(t, best, "right") ||
				tokens_is(t, best, "far") || tokens_is(t, best, "away") ||
				tokens_is(t, best, "close"))
				best = j;
		} else if (!(c == CLOSED_ADVERB || c == CLOSED_PREPOSITION || tokens_is(t, j, "the") ||
				   tokens_is(t, j, "its") || tokens_is(t, j, "hand") ||
				   tokens_is(t, j, "side") || tokens_is(t, j, "end") ||
				   tokens_is(t, j, "it"))) {
			break;
		}
		if (best >= 0 && is_weak(t, best) &&
			(tokens_is(t, j + 1, "the") || tokens_is(t, j + 1, "its")) &&
			!(tokens_class(t, j + 2) == CLOSED_PLACE &&
				(!is_noun_start(t, j + 3) || tokens_is(t, j + 3, "hand") ||
					tokens_is(t, j + 3, "side") || tokens_is(t, j + 3, "end")))) {
			j++;
			break;
		}
	}
	*end = j;
	return best;
}

/* 1 where the words from i to end point back at what was spoken of: "on its left", "in front of it", "on
 * top". */
static int points_back(const struct tokens *t, int i, int end)
{
	for (int j = i; j < end; j++)
		if (tokens_is(t, j, "its") || tokens_is(t, j, "it") || tokens_is(t, j, "them") ||
			tokens_is(t, j, "their"))
			return 1;
	if (tokens_is(t, end, "it") || tokens_is(t, end, "them"))
		return 1;
	return end >= t->n || t->word[end].before;
}

static int take_place(struct state *s, int i)
{
	const struct tokens *t = s->t;
	int end, main = place_at(s, i, &end);
	enum parse_relation r = (enum parse_relation)relation_of(t, main);

	if (tokens_is(t, main, "top") && is_weak(t, main - 1))
		r = PARSE_ON;
	if (s->has >= 0 && points_back(t, i, end)) {
		/* "with the ball on its left": the figure is right of the ball */
		int anchor = s->has, negated = s->a->word[s->with].negated;
		set(s, s->with, ROLE_NONE, ROOT);
		set_predicate(s, main, s->owner, closed_inverse(r));
		s->a->word[main].negated |= negated;
		s->a->word[anchor].head = main;
		s->figure = s->owner;
		s->has = s->with = s->predicate = -1;
		return end;
	}
	set_predicate(s, main, s->figure, r);
	s->predicate = main;
	/* "the larger of the two cups": the noun to come is the target's */
	if (end >= t->n || t->word[end].before ||
		(!s->found && tokens_is(t, main + 1, "of") && closed_words[t->word[main].closed].value))
		s->predicate = -1;
	if ((r == PARSE_INSIDE || r == PARSE_ON) && end < t->n && s->predicate >= 0 &&
		(tokens_is(t, end, "wall") || tokens_is(t, end, "floor") || tokens_is(t, end, "ground") ||
			tokens_is(t, end, "corner"))) {
		set(s, main, ROLE_NONE, ROOT);
		set_predicate(s, end, s->figure, (enum parse_relation)relation_of(t, end));
		s->predicate = -1;
		return end + 1;
	}
	return end;
}

static void take_with(struct state *s, int i, int negated)
{
	s->with = i;
	s->owner = s->figure;
	s->has = -1;
	s->negated |= negated;
	set_predicate(s, i, s->figure, PARSE_WITH);
	s->predicate = i;
}

static int step(struct state *s, int i)
{
	const struct tokens *t = s->t;
	int c = tokens_class(t, i), end, head;

	if (t->word[i].before == PAUSE_STOP) {
		s->figure = ROOT;
		s->predicate = s->has = -1;
	}
	if (c == CLOSED_NEGATION) {
		if (tokens_is(t, i, "without"))
			return take_with(s, i, 1), i + 1;
		if (tokens_is(t, i, "no") && s->with >= 0 && s->predicate == s->with)
			s->a->word[s->with].negated = 1;
		else
			s->negated = 1;
		return i + 1;
	}
	if (c == CLOSED_EXCEPT)
		return s->except = 1, i + 1;
	if (c == CLOSED_WITH || (c == CLOSED_HAVE && (s->found || s->figure != ROOT)))
		return take_with(s, i, 0), i + 1;
	if (c == CLOSED_VIEW && (tokens_is(t, i, "facing") || tokens_is(t, i, "looking")) &&
		!(i && tokens_is(t, i - 1, "is")) &&
		(i == 0 || t->word[i].before || tokens_is(t, i - 1, "when"))) {
		s->view = 1;
		return i + 1;
	}
	if (c == CLOSED_CONJUNCTION && s->figure == ROOT && s->found)
		s->also = !(tokens_class(t, i + 1) == CLOSED_PLACE || tokens_class(t, i + 1) == CLOSED_BE);
	head = phrase_at(s, i, &end);
	if (head >= 0)
		return take_phrase(s, i, head, end);
	if (c == CLOSED_PLACE || c == CLOSED_SIZE)
		return take_place(s, i);
	if (c == CLOSED_ATTRIBUTE)
		set(s, i, ROLE_ATTRIBUTE, s->figure);
	return i + 1;
}

void grammar_analyse(struct analysis *a, const struct tokens *t)
{
	struct state s = {
		.a = a, .t = t, .figure = ROOT, .predicate = -1, .has = -1, .owner = ROOT, .with = -1};

	*a = (struct analysis){.n = t->n};
	for (int i = 0; i < t->n; i++)
		a->word[i].head = ROOT;
	for (int i = 0; i < t->n;)
		i = step(&s, i);
	analysis_repair(a);
}
