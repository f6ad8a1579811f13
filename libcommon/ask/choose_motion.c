#include "ask/choose_motion.h"

#include "ask/judge.h"
#include "base/mem.h"

#include <math.h>

#include <string.h>

static const char *piece_at(const char *pieces, int piece)
{
	for (; piece > 0 && *pieces; piece--)
		pieces += strcspn(pieces, " ") + (pieces[strcspn(pieces, " ")] == ' ');
	return pieces;
}

/* Words of a sentence, from begin to end - 1 of `whole`, taken apart as a sentence of their own; their places
 * in the text and their pieces stay those of the whole. */
static int parse_some(struct parse *p, const struct parse *whole, const struct parser *parser,
	const struct choose_sentence *s, int width, int begin, int end, struct err *e)
{
	const size_t length = strlen(s->text);
	const int first = begin < end ? whole->words[begin].span.begin : 0,
		  last = begin < end ? whole->words[end - 1].span.end : 0;
	const int piece = begin < end ? whole->words[begin].piece : 0;
	const char *from = piece_at(s->pieces, piece),
		   *to = end < whole->word_count ? piece_at(s->pieces, whole->words[end].piece)
						 : from + strlen(from);
	SCOPED char *text = mem_zalloc(length + 1, 1, "sentence", e),
		    *pieces = mem_zalloc((size_t)(to - from) + 1, 1, "sentence", e);

	if (!text || !pieces)
		return -1;
	memset(text, ' ', length);
	memcpy(text + first, s->text + first, (size_t)(last - first));
	memcpy(pieces, from, (size_t)(to - from));
	const int count = (end < whole->word_count ? whole->words[end].piece : (int)s->words) - piece;
	const struct parser_vectors v = {
		pieces, s->middle ? s->middle + (size_t)piece * (size_t)width : NULL, count, width};
	struct parser once = *parser;
	once.memo = NULL; /* the text does not stay */
	if (parse_sentence(p, &once, text, &v, e))
		return -1;
	for (int i = 0; i < p->word_count; i++)
		p->words[i].piece += piece;
	return 0;
}

/* The thing of the other sentence is that of the whole one: "while it is lifted". */
static int is_same_thing(const struct parse *p)
{
	const struct parse_phrase *f = &p->phrases[0];

	return !f->noun.n && !f->attributes.n && !f->clauses.n;
}

/* The time that a motion tells. */
static struct motions_span time_by(
	const struct tracks *t, enum motion_kind when, enum motion_kind last, struct motions_span of)
{
	const struct motions_span all = {0, t->times - 1};

	if (when == MOTION_WHILE)
		return of;
	if (last == MOTION_STOPS)
		of.a = of.b;
	if (last == MOTION_STARTS)
		of.b = of.a;
	return when == MOTION_BEFORE ? (struct motions_span){all.a, of.a}
				     : (struct motions_span){of.b, all.b};
}

/* m->motion: when the target's motion may be, by the sentence of another's. */
static int find_time(struct meaning *m, const struct choose_sentence *s, struct parse *other,
	enum motion_kind *rank, enum motion_kind when, struct err *e)
{
	struct motion_meaning *to = m->motion;
	const struct vocabulary_sentence v = {other, s->vectors, s->words};
	const size_t n = objects_of(m);

	for (int w = 0; w < other->word_count && when != MOTION_WHILE; w++)
		if (parse_word_is(other, w, "other|others|else|rest|everything|anything|any|all")) {
			*rank = when == MOTION_BEFORE ? MOTION_FIRST : MOTION_LAST;
			return 0;
		}
	if (!motion_said_take(&to->said, other)) {
		to->said.n = 1;
		to->said.events[0] = (struct motion_event){.kind = MOTION_MOVES, .about = -1};
	}
	const int is_same = is_same_thing(other);
	const enum motion_kind gone = to->said.events[0].kind;
	if (judge_sentence(m, &v, e))
		return -1;
	const size_t best = best_of(fit_of(m, 0), n);
	for (size_t o = 0; o < n; o++) {
		const size_t whose = is_same ? o : best;
		to->happens[o] = there_of(m, 0)[whose];
		to->own[o] = time_by(to->moving.tracks, when, gone, to->when[whose]);
	}
	memcpy(to->when, to->own, n * sizeof *to->when);
	to->gone = gone;
	return 0;
}

int choose_motion(struct meaning *m, const struct choose_scene *scene, const struct parser *parser,
	const struct choose_sentence *s, struct parse *p, struct err *e)
{
	struct motion_meaning *to = m->motion;
	struct motion_cut cut;
	enum motion_kind rank = MOTION_NONE;
	struct parse main = {0}, other = {0};
	int bad = 0;

	motions_look(&to->moving, to->moving.tracks, scene->cameras, &s->from);
	motion_meaning_begin(to);
	if (motion_said_cut(&cut, p, s->text)) {
		const int width = scene->lifted->width;
		bad = parse_some(&main, p, parser, s, width, cut.begin, cut.end, e) ||
		      (cut.when != MOTION_NONE &&
			      (parse_some(&other, p, parser, s, width, cut.other_begin, cut.other_end, e) ||
				      find_time(m, s, &other, &rank, cut.when, e)));
		const struct parse whole = *p;
		*p = main;
		main = whole;
	}
	parse_free(&main);
	parse_free(&other);
	if (bad)
		return -1;
	motion_said_take(&to->said, p);
	if (rank != MOTION_NONE && to->said.n < MOTION_EVENTS)
		to->said.events[to->said.n++] = (struct motion_event){.kind = rank, .about = -1};
	return 0;
}

void choose_when(const struct motion_meaning *m, const char *chosen, double when[2])
{
	const struct tracks *t = m->moving.tracks;

	when[0] = INFINITY;
	when[1] = -INFINITY;
	for (size_t o = 0; o < t->n; o++)
		if (chosen[o]) {
			when[0] = fmin(when[0], t->t[m->when[o].a]);
			when[1] = fmax(when[1], t->t[m->when[o].b]);
		}
}
