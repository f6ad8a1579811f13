#include "cmd/score/scoring.h"

#include "base/file.h"
#include "base/mem.h"
#include "base/names.h"
#include "mask/mask_index.h"
#include "score/score_best.h"
#include "score/score_choice.h"
#include "score/score_groups.h"
#include "score/score.h"

void score_masks_free(struct score_masks *s)
{
	masks_free(&s->set);
	free(s->lines);
	s->lines = NULL;
}

static int check_twice(const struct score_masks *s, struct err *e)
{
	SCOPED_BY(mask_index_free) struct mask_index x = {0};
	size_t earlier, later;

	if (mask_index_make(&x, s->set.items, s->n, MASK_BY_REF, e))
		return -1;
	const int found = mask_index_twice(&x, &earlier, &later);
	if (!found)
		return 0;
	const struct mask *m = &s->set.items[later];
	return err_set(e, ERR_FORMAT, "%s:%ld: view '%s', %s '%s' is on line %ld already", file_name(s->path),
		s->lines[later], m->view, m->ref ? "ref" : "object", m->ref ? m->ref : m->object,
		s->lines[earlier]);
}

int score_masks_read(struct score_masks *s, const char *path, struct err *e)
{
	*s = (struct score_masks){.path = path};
	if (masks_read_lines(&s->set, &s->lines, path, e))
		return -1;
	s->n = s->set.n;
	int bad = check_twice(s, e);
	return bad;
}

/* ERR_FORMAT where a mask of a view has another shape than the first mask that `truth` has of it, or where
 * none is of a view of the truth: before anything reorders either. */
static int score_masks_check(const struct score_masks *s, const struct score_masks *truth, struct err *e)
{
	const struct mask *of = truth->set.items;
	SCOPED_BY(names_free) struct names views = {0};
	int bad = names_make(&views, of, sizeof *of, offsetof(struct mask, view), truth->n, e);
	size_t seen = 0;

	for (size_t i = 0; i < s->n && !bad; i++) {
		const size_t at = names_find(&views, s->set.items[i].view);
		seen += at != NAMES_NONE;
		if (at != NAMES_NONE)
			bad = masks_check_shape(&s->set.items[i], "its truth", of[at].rle.height,
				of[at].rle.width, s->path, s->lines[i], e);
	}
	if (!bad && s->n && truth->n && !seen)
		bad = err_set(e, ERR_FORMAT,
			"%s: none of its views is one of %s: are they named alike? They have '%.200s' and '%.200s'",
			file_name(s->path), file_name(truth->path), s->set.items[0].view, of[0].view);
	return bad;
}

static int score_relations(struct scores *s, const struct score_sample *sample,
	const struct parses *sentences, size_t *unknown, struct err *e)
{
	SCOPED struct score_sentence *list = mem_alloc(sentences->n, sizeof *list, "sentences", e);
	SCOPED uint32_t *sets = mem_alloc(sample->n, sizeof *sets, "pairs", e);
	const char *names[SCORE_SAYINGS];
	int bad = !list || !sets;

	for (size_t i = 0; i < sentences->n && !bad; i++)
		list[i] = (struct score_sentence){sentences->items[i].ref, sentences->items[i].set};
	score_saying_names(names);
	return -(bad || score_sayings(sets, sample->pairs, sample->n, list, sentences->n, unknown, e) ||
		 score_table_groups(&s->relations, sample, sets, names, SCORE_SAYINGS, 0, e));
}

/* Make the table of relations, or of visibility, of a sample of pairs; *unknown gets how many pairs have no
 * sentence, or masks of the truth no whole. Return 0, or -1 with *e set. */
static int score_visibility(struct scores *s, const struct score_sample *sample,
	const struct score_masks *truth, const struct score_masks *whole, size_t *unknown, struct err *e)
{
	const uint32_t always = ((uint32_t)1 << SCORE_SEEN_UNKNOWN) - 1;
	SCOPED uint32_t *sets = mem_alloc(sample->n, sizeof *sets, "pairs", e);

	return !sets ||
	       score_seen(sets, sample->pairs, sample->n, truth->set.items, truth->n, whole->set.items,
		       whole->n, unknown, e) ||
	       score_table_groups(&s->visibility, sample, sets, score_seen_name, SCORE_SEEN, always, e);
}

int scoring_read(struct scoring *in, const struct scoring_files *p, int is_partial, struct err *e)
{
	in->files = p;
	return -(score_masks_read(&in->truth, p->truth, e) ||
		 score_masks_read(&in->predictions, p->predictions, e) ||
		 (p->other && score_masks_read(&in->other, p->other, e)) ||
		 (p->whole && score_masks_read(&in->whole, p->whole, e)) ||
		 (p->sentences && sentences_read(&in->sentences, p->sentences, e)) ||
		 (p->parses && parses_read(&in->parses, p->parses, e)) ||
		 score_masks_check(&in->truth, &in->truth, e) ||
		 score_masks_check(&in->predictions, &in->truth, e) ||
		 score_masks_check(&in->other, &in->truth, e) ||
		 score_masks_check(&in->whole, &in->truth, e) ||
		 (is_partial && score_keep_views(in->truth.set.items, &in->truth.n, in->predictions.set.items,
					in->predictions.n, in->other.set.items, in->other.n, e)));
}

int scoring_take_best(struct scoring *in, struct err *e)
{
	struct masks named = {0};

	if (score_best(&named, in->truth.set.items, in->truth.n, in->predictions.set.items, in->predictions.n,
		    e))
		return -1;
	masks_free(&in->predictions.set);
	in->predictions.set = named;
	in->predictions.n = named.n;
	return 0;
}

void scoring_free(struct scoring *in)
{
	score_masks_free(&in->predictions);
	score_masks_free(&in->truth);
	score_masks_free(&in->other);
	score_masks_free(&in->whole);
	sentences_free(&in->sentences);
	parses_free(&in->parses);
}

static void tell_left_out(
	const struct report *to, const struct score_pairs *pairs, const struct score_masks *predictions)
{
	report_note(to, 1, "%zu predictions of views without truth were left out", pairs->unlabelled);
	if (pairs->unmatched)
		report_warn(to,
			"%s: %zu predictions of labelled views match no truth's ref or object and were left out",
			file_name(predictions->path), pairs->unmatched);
}

/* Matched, measured and sorted pairs of the predictions and, with --compare, of the others beside them. The
 * figures of all are summed before they are sorted, so that no object's name changes their last digit. */
static int pair_up(const struct report *to, const struct scoring *in, int is_compared,
	struct score_pairs *pairs, struct score_pairs *others, struct score *sum, struct score *other_sum,
	struct err *e)
{
	const struct score_masks *t = &in->truth;

	if (score_match(pairs, t->set.items, t->n, in->predictions.set.items, in->predictions.n, e) ||
		(is_compared &&
			(score_match(others, t->set.items, t->n, in->other.set.items, in->other.n, e) ||
				score_join(pairs, others, e))) ||
		score_measure_all(pairs, e) || score_measure_all(others, e) ||
		score_choices(pairs, in->truth.set.items, in->truth.n, e) ||
		score_choices(others, in->truth.set.items, in->truth.n, e))
		return -1;
	score_sum(sum, pairs->items, pairs->n);
	score_sum(other_sum, others->items, others->n);
	if (!sum->pairs)
		return err_set(e, ERR_FORMAT, "%s: no mask with anything in it: there is nothing to score",
			file_name(in->truth.path));
	score_sort(pairs->items, pairs->n);
	score_sort(others->items, others->n);
	tell_left_out(to, pairs, &in->predictions);
	if (is_compared)
		tell_left_out(to, others, &in->other);
	return 0;
}

/* The tables of --parses and --whole. */
static int by_group(const struct report *to, struct scores *s, const struct score_sample *sample,
	const struct scoring *in, struct err *e)
{
	size_t no_sentence = 0, no_whole = 0;

	if ((s->has_relations && score_relations(s, sample, &in->parses, &no_sentence, e)) ||
		(s->has_visibility && score_visibility(s, sample, &in->truth, &in->whole, &no_whole, e)))
		return -1;
	if (no_sentence)
		report_warn(to, "%s: %zu pairs have no sentence there", file_name(in->files->parses),
			no_sentence);
	if (no_whole)
		report_warn(to, "%s: %zu masks of the truth have no whole there", file_name(in->whole.path),
			no_whole);
	return 0;
}

int scoring_pairs(const struct scoring *in, struct scores *s, const struct report *to, struct err *e)
{
	SCOPED_BY(score_pairs_free) struct score_pairs pairs = {0}, others = {0};
	struct score sum, other_sum;
	int bad = pair_up(to, in, s->is_compared, &pairs, &others, &sum, &other_sum, e);
	const struct score_sample sample = {
		pairs.n, pairs.items, s->is_compared ? others.items : NULL, s->how};

	bad = bad || score_row_make(&s->all, "", &sample, e) ||
	      score_table_objects(&s->objects, &sample, e) || by_group(to, s, &sample, in, e);
	if (!bad) {
		s->all.score = sum;
		s->all.other.score = other_sum;
	}
	return bad;
}

int scoring_boxes(const struct scoring_files *files, const char *path, int is_json, double *miou,
	const struct report *to, struct err *e)
{
	SCOPED_BY(box_scores_free) struct box_scores s = {0};

	if (box_scores_read(&s, files->truth, files->predictions, e))
		return -1;
	if (s.unmatched)
		report_warn(to, "%s: %zu boxes match no truth's ref or object and were left out",
			file_name(files->predictions), s.unmatched);
	*miou = s.all.aligned.iou;
	return box_scores_write(&s, path, is_json, e);
}

int scoring_answers(const struct scoring *in, const char *path, int is_json, double *right,
	const struct report *to, struct err *e)
{
	SCOPED_BY(answer_scores_free) struct answer_scores s = {0};
	struct answer_score all;

	if (answer_scores_make(&s, &in->sentences, &in->truth, &in->predictions, e))
		return -1;
	if (s.answers.unknown)
		report_warn(to, "%s: %zu sentences mean an object that %s does not have",
			file_name(in->files->sentences), s.answers.unknown, file_name(in->files->truth));
	if (s.answers.unmatched)
		report_warn(to, "%s: %zu predictions have no sentence's ref and were left out",
			file_name(in->files->predictions), s.answers.unmatched);
	answer_score_sum(&all, &s.answers, ANSWER_ANY, NULL);
	*right = all.right;
	return answer_scores_write(&s, path, is_json, e);
}
