/* A row of data is a line of five fields between tabs: list, text, what it says, what goes with it, how often
 * (1 where it is not said). What a word says are names of values of its property; after "/" stand those that
 * it may be thought to mean. */
#include "synth/wordings.h"

#include "base/embed.h"
#include "base/mem.h"

#include <stdio.h>

EMBED(synth_sentences, "libcommon/synth/sentences.tsv");
EMBED(synth_unseen, "libcommon/synth/unseen.tsv");
EMBED(synth_moves, "libcommon/synth/moves.tsv");
EMBED(synth_moves_kept, "libcommon/synth/moves-kept-back.tsv");
extern const unsigned char synth_sentences_begin[], synth_sentences_end[], synth_unseen_begin[],
	synth_unseen_end[], synth_moves_begin[], synth_moves_end[], synth_moves_kept_begin[],
	synth_moves_kept_end[];

enum { FIELDS = 5, NAME = 16 };

static const char *const lists[SYNTH_LISTS] = {"train", "test", "plain", "chatty", "not", "other", "nothing",
	"neither", "ordinal", "extreme", "group-of", "most", "pair", "than", "all", "count", "also", "except",
	"function", "view", "kind", "relation", "said", "said-test", "size", "finish", "material", "colour",
	"noun", "group", "foreign", "use", "motion-plain", "motion-moves", "motion-still", "motion-starts",
	"motion-stops", "motion-pauses", "motion-raised", "motion-lowered", "motion-falls", "motion-rolls",
	"motion-slides", "motion-left", "motion-right", "motion-nearer", "motion-farther", "motion-towards",
	"motion-away", "motion-behind", "motion-front", "motion-swaps", "motion-fastest", "motion-slowest",
	"motion-most", "motion-first", "motion-last", "motion-while", "motion-before", "motion-after"};

const struct synth_sense synth_anything = {{~0U, ~0U, ~0U, ~0U}, {0}};

const char *synth_motion_name(enum synth_list motion)
{
	return motion < SYNTH_MOTIONS ? NULL : lists[motion];
}

static enum synth_list find_list(const char *name)
{
	int i = 0;

	while (i < SYNTH_LISTS && strcmp(lists[i], name) != 0)
		i++;
	return (enum synth_list)i;
}

static void read_values(struct synth_row *r, const char *names)
{
	unsigned *to = &r->surely;
	char name[NAME];

	r->property = r->list == SYNTH_SIZES_SAID      ? SYNTH_SIZE
		      : r->list == SYNTH_FINISHES_SAID ? SYNTH_FINISH
		      : r->list == SYNTH_COLOURS_SAID  ? SYNTH_COLOUR
						       : SYNTH_SHAPE;
	for (int n = 0; sscanf(names, "%15s%n", name, &n) == 1; names += n) {
		if (*name == '/')
			to = &r->maybe;
		for (int i = 0; synth_value_name(r->property, i); i++)
			*to |= (unsigned)!strcmp(synth_value_name(r->property, i), name) << i;
	}
}

static void read_relation(struct synth_row *r, const char *sense)
{
	static const char *const degrees[] = {"plain", "more", "most"};
	char relation[NAME] = "", degree[NAME] = "";

	sscanf(sense, "%15s %15s %d", relation, degree, &r->anchors);
	r->relation = (enum parse_relation)parse_relation_find(relation);
	for (int i = 0; i < 3; i++)
		if (!strcmp(degrees[i], degree))
			r->degree = (enum parse_degree)i;
	r->form = r->more[0];
}

/* Takes a line apart in place. */
static void read_row(struct synth_row *r, char *line)
{
	char *fields[FIELDS];

	for (int i = 0; i < FIELDS; i++) {
		fields[i] = line;
		line += strcspn(line, "\t");
		if (*line)
			*line++ = 0;
	}
	*r = (struct synth_row){.list = find_list(fields[0]), .text = fields[1], .more = fields[3]};
	r->weight = *fields[4] ? atoi(fields[4]) : 1;
	if (r->list == SYNTH_KINDS)
		r->frames = find_list(fields[2]);
	else if (r->list >= SYNTH_RELATIONS && r->list <= SYNTH_SAID_TEST)
		read_relation(r, fields[2]);
	else if (r->list >= SYNTH_MOTIONS)
		r->form = r->more[0];
	else if (r->list > SYNTH_SAID_TEST)
		read_values(r, fields[2]);
}

int synth_wordings_load(struct synth_wordings *w, enum synth_table_of table, struct err *e)
{
	const unsigned char *const all[SYNTH_TABLES][2] = {{synth_sentences_begin, synth_sentences_end},
		{synth_unseen_begin, synth_unseen_end}, {synth_moves_begin, synth_moves_end},
		{synth_moves_kept_begin, synth_moves_kept_end}};
	const unsigned char *begin = all[table][0];
	size_t size = (size_t)(all[table][1] - begin), lines = 0;

	for (size_t i = 0; i < size; i++)
		lines += begin[i] == '\n';
	*w = (struct synth_wordings){.rows = mem_alloc(lines, sizeof *w->rows, "wordings", e),
		.text = mem_alloc(size + 1, 1, "wordings", e)};
	if (!w->rows || !w->text)
		return -1;
	memcpy(w->text, begin, size);
	w->text[size] = 0;
	for (char *line = w->text, *next; *line; line = next) {
		next = line + strcspn(line, "\n");
		*next++ = 0;
		if (*line != '#')
			read_row(&w->rows[w->n++], line);
	}
	return 0;
}

void synth_wordings_free(struct synth_wordings *w)
{
	mem_free_all(w->rows, w->text);
	*w = (struct synth_wordings){0};
}

static int fits(const struct synth_row *r, const struct synth_query *q)
{
	return r->list == q->list && (!q->of || r->surely >> synth_object_value(q->of, r->property) & 1) &&
	       (!q->text || !strcmp(r->text, q->text)) && (!q->forms || strchr(q->forms, r->form)) &&
	       (!q->like || (r->relation == q->like->relation && r->degree == q->like->degree &&
				    r->anchors == q->like->anchors));
}

const struct synth_row *synth_draw(const struct synth_wordings *w, const struct synth_query *q, struct rng *r)
{
	const struct synth_row *found = NULL, *row = w->rows;
	uint32_t sum = 0;

	for (int i = 0; i < w->n; i++)
		if (fits(&w->rows[i], q)) {
			sum += (uint32_t)w->rows[i].weight;
			if (q->is_stepwise && !rng_below(r, sum))
				found = &w->rows[i];
		}
	if (q->is_stepwise || !sum)
		return found;
	for (int at = (int)rng_below(r, sum);; row++) {
		at -= fits(row, q) ? row->weight : 0;
		if (at < 0)
			return row;
	}
}

void synth_sense_add(struct synth_sense *s, const struct synth_row *word)
{
	s->surely[word->property] &= word->surely;
	s->maybe[word->property] = word->maybe;
}

int synth_sense_judge(const struct synth_sense *s, const struct synth_object *o)
{
	int verdict = 1;

	for (int p = 0; p < SYNTH_PROPERTIES; p++) {
		unsigned bit = 1U << synth_object_value(o, (enum synth_property)p);
		if (!((s->surely[p] | s->maybe[p]) & bit))
			return -1;
		verdict &= (s->surely[p] & bit) != 0;
	}
	return verdict;
}
