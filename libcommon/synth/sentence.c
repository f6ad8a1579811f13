/* What the phrases of a sentence mean among a scene's objects, by the verdicts of synth/relations.h. */
#include "base/largest.h"
#include "synth/sentence.h"

#include "base/mem.h"

void synth_sentences_free(struct synth_sentences *list)
{
	free(list->items);
	synth_wordings_free(&list->wordings);
	*list = (struct synth_sentences){0};
}

int synth_sentences_add(struct synth_sentences *list, const struct synth_sentence *s, struct err *e)
{
	if (mem_grow((void **)&list->items, &list->capacity, list->n + 1, sizeof *s, "sentences", e))
		return -1;
	list->items[list->n++] = *s;
	return 0;
}

int synth_add_phrase(struct synth_sentence *s)
{
	if (s->phrase_count == SYNTH_PHRASES)
		return -1;
	s->phrases[s->phrase_count] = (struct synth_phrase){
		.words[SYNTH_NOUN] = "", .plural = "", .count = PARSE_ONE, .sense = synth_anything};
	return s->phrase_count++;
}

int synth_add_clause(struct synth_sentence *s, int phrase, enum parse_relation r, enum parse_degree d)
{
	struct synth_phrase *p = &s->phrases[phrase];

	if (s->clause_count == SYNTH_CLAUSES || p->clause_count == SYNTH_LIST)
		return -1;
	s->clauses[s->clause_count] = (struct synth_clause){.is = {r, d, -1, -1}};
	p->clauses[p->clause_count++] = s->clause_count;
	return s->clause_count++;
}

enum synth_list synth_words_of(enum synth_word w)
{
	static const enum synth_list lists[SYNTH_WORDS] = {
		SYNTH_SIZES_SAID, SYNTH_FINISHES_SAID, SYNTH_MATERIALS, SYNTH_COLOURS_SAID, SYNTH_NOUNS};

	return lists[w];
}

void synth_say(struct synth_phrase *p, enum synth_word w, const struct synth_row *row)
{
	p->words[w] = row->text;
	if (w == SYNTH_NOUN)
		p->plural = row->more;
	synth_sense_add(&p->sense, row);
}

static int carries_anything(const struct synth_viewpoint *v, int i)
{
	for (int j = 0; j < v->n; j++)
		if (v->objects[j].on == i)
			return 1;
	return -1;
}

/* Finds a clause's objects, at most two; none: who looks. -1 where they could be argued. */
static int find_anchors(const struct synth_viewpoint *v, const struct synth_sentence *s,
	const struct synth_clause *c, struct synth_relation *r)
{
	int found[2] = {-1, -1}, n = 0;

	for (int k = 0; k < c->anchor_count; k++) {
		uint64_t set;
		if (s->phrases[c->anchors[k]].viewer)
			continue;
		if (synth_resolve(v, s, c->anchors[k], 0, &set) || (set & ~v->visible))
			return -1;
		for (int i = 0; i < v->n; i++) {
			if (!(set >> i & 1))
				continue;
			if (n == 2)
				return -1;
			found[n++] = i;
		}
	}
	*r = (struct synth_relation){c->is.relation, c->is.degree, found[0], found[1]};
	return 0;
}

/* The verdict of a clause that ranks nothing about object i. */
static int judge_clause(const struct synth_viewpoint *v, const struct synth_sentence *s, int clause, int i)
{
	const struct synth_clause *c = &s->clauses[clause];
	int sign = c->negated ? -1 : 1;
	struct synth_relation r;

	if (c->is.relation == PARSE_OTHER) {
		unsigned bit = 1U << v->objects[i].shape;
		return sign * (c->said->surely & bit ? 1 : c->said->maybe & bit ? 0 : -1);
	}
	if (c->anchor_count && s->phrases[c->anchors[0]].is_anything)
		return sign * carries_anything(v, i);
	if (find_anchors(v, s, c, &r))
		return 0;
	return i == r.a || i == r.b ? -1 : sign * synth_relation_judge(v, &r, i, NULL);
}

/* 1 where the clause ranks what the rest of the phrase fits. */
static int ranks(const struct synth_sentence *s, const struct synth_phrase *p, int k)
{
	const struct synth_clause *c = &s->clauses[p->clauses[k]];

	return p->group ? 1
			: c->is.degree != PARSE_PLAIN &&
				  !(synth_relation_is_size(c->is.relation) && c->anchor_count);
}

/* Verdicts without what ranks: words, clauses and what is left out. */
static void judge_phrase(
	const struct synth_viewpoint *v, const struct synth_sentence *s, int phrase, int *values)
{
	const struct synth_phrase *p = &s->phrases[phrase];

	for (int i = 0; i < v->n; i++) {
		values[i] = synth_sense_judge(&p->sense, &v->objects[i]);
		for (int k = 0; k < p->clause_count && values[i] >= 0; k++)
			if (!ranks(s, p, k))
				values[i] = least_of(values[i], judge_clause(v, s, p->clauses[k], i));
	}
	for (int k = 0; k < p->except_count; k++) {
		uint64_t out;
		int bad = synth_resolve(v, s, p->except[k], 0, &out);
		for (int i = 0; i < v->n; i++)
			values[i] = bad ? least_of(values[i], 0) : out >> i & 1 ? -1 : values[i];
	}
}

/* Leaves the k-th from one end. All must be plainly told apart, and to be seen. */
static void take_ordinal(const struct synth_viewpoint *v, const struct synth_phrase *p, int *values)
{
	int before[SYNTH_MAX_OBJECTS] = {0}, is_clear = 1;

	for (int i = 0; i < v->n; i++) {
		is_clear &= values[i] != 0 && (values[i] < 0 || v->visible >> i & 1);
		for (int j = 0; j < v->n && values[i] > 0; j++) {
			int one = j == i || values[j] < 0 ? -1 : synth_relation_compare(v, p->from, j, i);
			is_clear &= one != 0;
			before[i] += one > 0;
		}
	}
	for (int i = 0; i < v->n; i++)
		values[i] = !is_clear ? 0 : values[i] > 0 && before[i] == p->ordinal - 1 ? 1 : -1;
}

/* 1 where exactly so many are meant, and of none it could be argued. */
static int are_so_many(const int *values, int n, int wanted)
{
	int count = 0, arguable = 0;

	for (int i = 0; i < n; i++) {
		count += values[i] > 0;
		arguable += values[i] == 0;
	}
	return count == wanted && !arguable;
}

static void rank(const struct synth_viewpoint *v, const struct synth_sentence *s, int phrase, int *values)
{
	const struct synth_phrase *p = &s->phrases[phrase];
	int among[SYNTH_MAX_OBJECTS];

	if (p->group && !are_so_many(values, v->n, p->group))
		memset(values, 0, (size_t)v->n * sizeof *values);
	if (p->ordinal)
		take_ordinal(v, p, values);
	memcpy(among, values, (size_t)v->n * sizeof *values);
	for (int k = 0; k < p->clause_count; k++) {
		const struct synth_clause *c = &s->clauses[p->clauses[k]];
		struct synth_relation r;
		if (!ranks(s, p, k))
			continue;
		int bad = find_anchors(v, s, c, &r);
		r.degree = PARSE_MOST;
		for (int i = 0; i < v->n; i++) {
			int one = bad ? 0 : values[i] < 0 ? -1 : synth_relation_judge(v, &r, i, among);
			values[i] = least_of(values[i], c->negated ? -one : one);
		}
	}
}

int synth_resolve(const struct synth_viewpoint *v, const struct synth_sentence *s, int p, int may_be_none,
	uint64_t *objects)
{
	const struct synth_phrase *phrase = &s->phrases[p];
	int values[SYNTH_MAX_OBJECTS], n = 0, wanted = phrase->count;

	*objects = 0;
	judge_phrase(v, s, p, values);
	rank(v, s, p, values);
	for (int i = 0; i < v->n; i++) {
		if (!values[i])
			return -1;
		n += values[i] > 0;
		*objects |= (uint64_t)(values[i] > 0) << i;
	}
	for (int k = 0; k < phrase->also_count; k++) {
		uint64_t more;
		if (synth_resolve(v, s, phrase->also[k], 0, &more) || (more & *objects))
			return -1;
		*objects |= more;
	}
	if (!n && may_be_none)
		return 0;
	return (wanted > 0 ? n == wanted : n >= 2) ? 0 : -1;
}
