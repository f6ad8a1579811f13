#include "cmd/score/score_tables.h"

#include "base/mem.h"
#include "score/score_groups.h"

#include <stdlib.h>

int score_relations(struct scores *s, const struct score_sample *sample, const struct parses *sentences,
	size_t *unknown, struct err *e)
{
	struct score_sentence *list = mem_alloc(sentences->n, sizeof *list, "sentences", e);
	uint32_t *sets = mem_alloc(sample->n, sizeof *sets, "pairs", e);
	const char *names[SCORE_SAYINGS];
	int bad = !list || !sets;

	for (size_t i = 0; i < sentences->n && !bad; i++)
		list[i] = (struct score_sentence){sentences->items[i].ref, sentences->items[i].set};
	score_saying_names(names);
	bad = bad || score_sayings(sets, sample->pairs, sample->n, list, sentences->n, unknown, e) ||
	      score_table_groups(&s->relations, sample, sets, names, SCORE_SAYINGS, 0, e);
	free(list);
	free(sets);
	return bad ? -1 : 0;
}

int score_visibility(struct scores *s, const struct score_sample *sample, const struct score_masks *truth,
	const struct score_masks *whole, size_t *unknown, struct err *e)
{
	const uint32_t always = ((uint32_t)1 << SCORE_SEEN_UNKNOWN) - 1;
	uint32_t *sets = mem_alloc(sample->n, sizeof *sets, "pairs", e);
	int bad = !sets ||
		  score_seen(sets, sample->pairs, sample->n, truth->set.items, truth->n, whole->set.items,
			  whole->n, unknown, e) ||
		  score_table_groups(&s->visibility, sample, sets, score_seen_name, SCORE_SEEN, always, e);

	free(sets);
	return bad ? -1 : 0;
}
