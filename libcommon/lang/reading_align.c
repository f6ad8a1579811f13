#include "lang/reading_align.h"

#include "nn/loss.h"

#include <math.h>
#include <string.h>

unsigned reading_relations(const char *name)
{
	static const struct {
		const char *name;
		unsigned relations;
	} others[] = {
		{"above", 1u << PARSE_ABOVE | 1u << PARSE_ON},
		{"below", 1u << PARSE_BELOW | 1u << PARSE_SUPPORTS},
		{"inside", 1u << PARSE_INSIDE | 1u << PARSE_SUPPORTS},
		{"with", 1u << PARSE_WITH},
		{"has", 1u << PARSE_WITH},
		{"on", 1u << PARSE_ON},
	};
	int r;

	for (size_t i = 0; i < sizeof others / sizeof *others; i++)
		if (!strcmp(name, others[i].name))
			return others[i].relations;
	r = parse_relation_find(name);
	return r < 0 || r == PARSE_OTHER ? 0 : 1u << r;
}

struct aligning {
	const struct reading *r;
	const struct parser_weights *w;
	const struct parser_batch *b;
	int sentence, first;
	const struct tokens *t;
	struct analysis *a;
	int word_of[READING_ANCHORS]; /* an anchor's word; -1: none yet; -2: has none */
	char used[TOKENS_MOST];
	int is_loose;				  /* a clause found no words */
	float arcs[TOKENS_MOST][TOKENS_MOST + 1]; /* log probabilities */
	float roles[TOKENS_MOST][ROLES], relations[TOKENS_MOST][PARSE_RELATIONS];
};

static void log_softmax(const float *x, int n, float *out)
{
	float most;
	const double all = log(loss_exp_sum(x, (size_t)n, &most));

	for (int i = 0; i < n; i++)
		out[i] = (float)((double)(x[i] - most) - all);
}

static void take_scores(struct aligning *s)
{
	float arcs[TOKENS_MOST + 1];

	for (int i = 0; i < s->t->n; i++) {
		const float *out = s->b->out + (size_t)(s->first + i) * NET_OUT;
		log_softmax(out, ROLES, s->roles[i]);
		log_softmax(out + ROLES, PARSE_RELATIONS, s->relations[i]);
		parser_arcs(s->w, s->b, s->sentence, i, arcs);
		log_softmax(arcs, s->t->n + 1, s->arcs[i]);
	}
}

static int is_noun(const struct aligning *s, int i, const char *noun)
{
	return !strcmp(s->t->word[i].lemma, noun) || !strcmp(s->t->word[i].text, noun);
}

static void find_target(struct aligning *s)
{
	int best = -1;

	for (int i = 0; i < s->t->n; i++)
		if (is_noun(s, i, s->r->target) &&
			(best < 0 || s->roles[i][ROLE_TARGET] > s->roles[best][ROLE_TARGET]))
			best = i;
	if (best >= 0) {
		s->a->word[best].role = ROLE_TARGET;
		s->used[best] = 1;
	}
}

/* The word for an anchor whose predicate is word p, -1 where the text has none; adds its score. */
static int find_anchor(const struct aligning *s, int anchor, int p, const char *taken, double *score)
{
	int best = -1;
	double most = -INFINITY;

	for (int i = 0; i < s->t->n; i++) {
		if (!is_noun(s, i, s->r->anchor[anchor].noun) || i == p || s->used[i] || taken[i])
			continue;
		double v = fmax(s->roles[i][ROLE_ANCHOR], -6) + fmax(s->arcs[i][p + 1], -6);
		/* what is faced is read as an anchor of what is then on the left */
		if (s->roles[i][ROLE_VIEW] > s->roles[i][ROLE_ANCHOR])
			v = s->roles[i][ROLE_VIEW] - 1;
		if (v > most) {
			most = v;
			best = i;
		}
	}
	if (best >= 0)
		*score += most;
	return best;
}

static int is_having(const struct aligning *s, int p)
{
	int c = s->t->word[p].closed;

	return c >= 0 && (closed_words[c].class == CLOSED_WITH || closed_words[c].class == CLOSED_HAVE ||
				 !strcmp(closed_words[c].text, "without"));
}

/* After "with" or "has" a relation may be turned round ("with a lamp behind it"), which readers forget. */
static int is_turned(const struct aligning *s, int p, enum parse_relation r)
{
	if (closed_inverse(r) == r || r == PARSE_INSIDE)
		return 0;
	while (p-- > 0)
		if (is_having(s, p))
			return 1;
	return 0;
}

/* The relations that clause c may have at word p. */
static unsigned allowed_at(const struct aligning *s, int c, int p)
{
	unsigned given = s->r->clause[c].relations, all = given;

	for (int r = 0; r < PARSE_RELATIONS; r++)
		if (given >> r & 1 && is_turned(s, p, (enum parse_relation)r))
			all |= 1u << closed_inverse((enum parse_relation)r);
	return all;
}

static double predicate_score(const struct aligning *s, int c, int p, int figure)
{
	double sum = 0;
	unsigned allowed = allowed_at(s, c, p);

	for (int r = 0; r < PARSE_RELATIONS; r++)
		if (!allowed || allowed >> r & 1)
			sum += exp((double)s->relations[p][r]);
	/* "with" may stand for most */
	if (is_having(s, p))
		sum = fmax(sum, exp((double)s->relations[p][PARSE_WITH]));
	/* a noun seldom says a relation */
	return (s->t->word[p].closed < 0 ? -2 : 0) + fmax(s->roles[p][ROLE_PREDICATE], -7) + log(sum + 1e-4) +
	       fmax(s->arcs[p][figure + 1], -5);
}

/* Of those that the reading allows. That a thing holds its anchor is the rarer way to read "below" and
 * "inside", and one without a name here is none that has a name unless that is likely. */
static enum parse_relation likeliest(const struct aligning *s, int c, int p)
{
	unsigned allowed = allowed_at(s, c, p);
	int best = -1;

	for (int r = 0; r < PARSE_RELATIONS; r++) {
		if ((allowed && !(allowed >> r & 1)) ||
			(!allowed && r != PARSE_OTHER && s->relations[p][r] < logf(0.6f)) ||
			(allowed && r == PARSE_SUPPORTS && !is_having(s, p) &&
				s->relations[p][r] < logf(0.4f)))
			continue;
		if (allowed && is_having(s, p) && r == PARSE_SUPPORTS)
			return PARSE_SUPPORTS;
		if (best < 0 || s->relations[p][r] > s->relations[p][best])
			best = r;
	}
	return (enum parse_relation)best;
}

static void place_clause(struct aligning *s, int c, int figure)
{
	int best = -1, words[READING_ANCHORS], best_words[READING_ANCHORS] = {0};
	double most = -12;

	for (int p = 0; p < s->t->n; p++) {
		char taken[TOKENS_MOST] = {0};
		if (s->used[p])
			continue;
		double score = predicate_score(s, c, p, figure);
		for (int k = 0; k < s->r->anchor_count; k++) {
			if (s->r->anchor[k].clause != c)
				continue;
			words[k] = find_anchor(s, k, p, taken, &score);
			if (words[k] >= 0)
				taken[words[k]] = 1;
		}
		if (score > most) {
			most = score;
			best = p;
			memcpy(best_words, words, sizeof words);
		}
	}
	for (int k = 0; k < s->r->anchor_count; k++)
		if (s->r->anchor[k].clause == c)
			s->word_of[k] = best < 0 ? -2 : best_words[k];
	if (best < 0) {
		s->is_loose = 1;
		return;
	}
	s->used[best] = 1;
	s->a->word[best].role = ROLE_PREDICATE;
	s->a->word[best].head = figure;
	s->a->word[best].relation = likeliest(s, c, best);
	s->a->word[best].negated = s->r->clause[c].negated;
	for (int k = 0; k < s->r->anchor_count; k++) {
		int i = s->r->anchor[k].clause == c ? best_words[k] : -1;
		if (i < 0)
			continue;
		int is_view = s->roles[i][ROLE_VIEW] > s->roles[i][ROLE_ANCHOR];
		s->used[i] = 1;
		s->a->word[i].role = is_view ? ROLE_VIEW : ROLE_ANCHOR;
		s->a->word[i].head = is_view ? ROOT : best;
	}
}

static enum word_role best_role(const struct aligning *s, int i, unsigned without)
{
	int best = -1;

	for (int r = 0; r < ROLES; r++)
		if (!(without >> r & 1) && (best < 0 || s->roles[i][r] > s->roles[i][best]))
			best = r;
	return (enum word_role)best;
}

/* The words that the reading says nothing of are what the weights take them for, if it allows that. */
static void fill(struct aligning *s, const struct analysis *free_analysis)
{
	int has_target = 0;

	for (int i = 0; i < s->t->n; i++)
		has_target |= s->a->word[i].role == ROLE_TARGET;
	for (int i = 0; i < s->t->n; i++) {
		enum word_role r = free_analysis->word[i].role;
		if (s->used[i])
			continue;
		s->a->word[i] = free_analysis->word[i];
		if (r == ROLE_TARGET && has_target && !is_noun(s, i, s->r->target))
			s->a->word[i].role =
				best_role(s, i, 1u << ROLE_TARGET | 1u << ROLE_PREDICATE | 1u << ROLE_ANCHOR);
		else if ((r == ROLE_TARGET && !has_target) || r == ROLE_ANCHOR)
			s->a->word[i].role = ROLES;
		else if (r == ROLE_PREDICATE && free_analysis->word[i].relation < PARSE_SUPPORTS)
			s->a->word[i].role = s->is_loose ? ROLES : ROLE_NONE;
	}
}

void reading_align(const struct reading *r, const struct parser_weights *w, const struct parser_batch *b,
	int sentence, const struct tokens *t, struct analysis *a)
{
	static _Thread_local struct aligning s;
	struct analysis free_analysis;
	double sure;

	s = (struct aligning){
		.r = r, .w = w, .b = b, .sentence = sentence, .first = b->start[sentence], .t = t, .a = a};
	*a = (struct analysis){.n = t->n};
	for (int i = 0; i < t->n; i++)
		a->word[i].head = ROOT;
	for (int k = 0; k < READING_ANCHORS; k++)
		s.word_of[k] = -1;
	parser_decode(w, b, sentence, t, &free_analysis, &sure);
	take_scores(&s);
	find_target(&s);
	/* figures come before what is said of them */
	for (int c = 0; c < r->clause_count; c++) {
		int figure = r->clause[c].figure;
		if (figure == ROOT)
			place_clause(&s, c, ROOT);
		else if (s.word_of[figure] >= 0)
			place_clause(&s, c, s.word_of[figure]);
		else
			s.is_loose = 1;
	}
	fill(&s, &free_analysis);
	for (int i = 0; i < t->n; i++) {
		int h = a->word[i].head;
		if (h != ROOT && !role_is_phrase(a->word[h].role) && a->word[h].role != ROLE_PREDICATE)
			a->word[i].head = ROOT;
		if (a->word[i].role == ROLE_ANCHOR && a->word[i].head == ROOT)
			a->word[i].role = ROLES;
	}
}
