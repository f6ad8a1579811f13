#include "score/score_groups.h"

#include "base/mem.h"
#include "base/names.h"
#include "mask/mask_index.h"

const char *const score_seen_name[SCORE_SEEN] = {"<0.15", "0.15-0.5", "0.5-0.85", ">=0.85", "(unknown)"};

void score_saying_names(const char *names[SCORE_SAYINGS])
{
	for (int r = 0; r < PARSE_RELATIONS; r++)
		names[r] = parse_relation_name((enum parse_relation)r);
	names[SCORE_SAYS_NONE] = "(none)";
	names[SCORE_SAYS_UNKNOWN] = "(unknown)";
}

int score_sayings(uint32_t *sets, const struct score_pair *pairs, size_t pair_n,
	const struct score_sentence *sentences, size_t n, size_t *unknown, struct err *e)
{
	SCOPED_BY(names_free) struct names refs = {0};

	*unknown = 0;
	if (names_make(&refs, sentences, sizeof *sentences, offsetof(struct score_sentence, ref), n, e))
		return -1;
	for (size_t i = 0; i < pair_n; i++) {
		const struct score_pair *p = &pairs[i];
		const char *ref = p->ref ? p->ref : p->truth->ref;
		const size_t at = ref ? names_find(&refs, ref) : NAMES_NONE;
		const uint32_t set =
			at == NAMES_NONE ? (uint32_t)1 << SCORE_SAYS_UNKNOWN : sentences[at].relations;
		sets[i] = p->is_empty ? 0 : set ? set : (uint32_t)1 << SCORE_SAYS_NONE;
		*unknown += !p->is_empty && at == NAMES_NONE;
	}
	return 0;
}

static int group_of(double seen)
{
	return seen < 0.15   ? SCORE_SEEN_LITTLE
	       : seen < 0.5  ? SCORE_SEEN_PARTLY
	       : seen < 0.85 ? SCORE_SEEN_MOSTLY
			     : SCORE_SEEN_WELL;
}

/* The group of one truth that has something in it. */
static int judge(int *group, const struct rle *truth, const struct rle *whole, struct err *e)
{
	SCOPED_BY(rle_fitted_free) struct rle_fitted f = {.own = whole};

	if (rle_fit(&f, truth, e))
		return -1;
	*group = f.area ? group_of((double)rle_area(truth) / (double)f.area) : SCORE_SEEN_UNKNOWN;
	return 0;
}

/* The set of each truth (truth_n). */
static int judge_all(uint32_t *seen, const struct mask *truth, size_t truth_n, const struct mask *wholes,
	const struct mask_lookup *lookup, size_t *unknown, struct err *e)
{
	for (size_t t = 0; t < truth_n; t++) {
		const struct mask *m = &truth[t];
		int group = SCORE_SEEN_UNKNOWN;
		size_t at;
		seen[t] = 0;
		if (!rle_area(&m->rle))
			continue;
		if (mask_lookup_find(lookup, m->view, m->ref, m->object, &at) != MASK_NONE &&
			judge(&group, &m->rle, &wholes[at].rle, e))
			return -1;
		*unknown += group == SCORE_SEEN_UNKNOWN;
		seen[t] = (uint32_t)1 << group;
	}
	return 0;
}

int score_seen(uint32_t *sets, const struct score_pair *pairs, size_t pair_n, const struct mask *truth,
	size_t truth_n, const struct mask *wholes, size_t n, size_t *unknown, struct err *e)
{
	SCOPED_BY(mask_lookup_free) struct mask_lookup lookup = {0};

	*unknown = 0;
	if (mask_lookup_make(&lookup, wholes, n, e))
		return -1;
	SCOPED uint32_t *seen = mem_alloc(truth_n, sizeof *seen, "masks", e);
	const int bad = !seen || judge_all(seen, truth, truth_n, wholes, &lookup, unknown, e);
	for (size_t i = 0; i < pair_n && !bad; i++)
		sets[i] = seen[pairs[i].truth_index];
	return bad ? -1 : 0;
}
