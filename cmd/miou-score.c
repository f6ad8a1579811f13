/* miou-score: how well predicted masks match the true ones. */
#include "base/err.h"
#include "base/file.h"
#include "base/mem.h"
#include "cli/cli.h"
#include "formats/masks.h"
#include "mask/score.h"

#include <stdlib.h>
#include <string.h>

/* A file of masks, as scoring sees them. */
struct side {
	const char *path;
	struct mask_set set;
	size_t count;		  /* of masks */
	struct score_mask *masks; /* (count), pointing into set */
	long *lines;		  /* (set.n) of the file */
};

static void side_free(struct side *s)
{
	masks_free(&s->set);
	free(s->masks);
	free(s->lines);
}

/* "FILE:LINE: ..." for a record that names what an earlier one named. */
static int duplicate_err(const struct side *s, size_t earlier, size_t later, struct err *e)
{
	const struct score_mask *m = &s->masks[later];

	return err_set(e, ERR_FORMAT, "%s:%ld: view '%s', %s '%s' is on line %ld already", file_name(s->path),
		s->lines[later], m->view, m->ref ? "ref" : "object", m->ref ? m->ref : m->object,
		s->lines[earlier]);
}

static int side_read(struct side *s, const char *path, struct err *e)
{
	size_t earlier, later;

	s->path = path;
	if (masks_read_lines(&s->set, &s->lines, path, e))
		return -1;
	s->masks = mem_alloc(s->set.n, sizeof *s->masks, path, e);
	if (!s->masks)
		return -1;
	for (size_t i = 0; i < s->set.n; i++) {
		const struct mask_record *r = &s->set.records[i];
		s->masks[i] = (struct score_mask){r->view, r->ref, r->object, &r->mask};
	}
	s->count = s->set.n;
	int found = score_duplicate(s->masks, s->set.n, &earlier, &later, e);
	return found > 0 ? duplicate_err(s, earlier, later, e) : found;
}

/* The end of the pairs of the object at `begin`. */
static size_t object_end(const struct score_pairs *pairs, size_t begin)
{
	size_t end = begin;

	while (end < pairs->n && !strcmp(pairs->items[end].object, pairs->items[begin].object))
		end++;
	return end;
}

static void put_table(FILE *out, const struct score *s, const struct score_pairs *pairs)
{
	fprintf(out, "mIoU         %6.2f %%\noverall IoU  %6.2f %%\n", 100 * s->miou, 100 * s->oiou);
	for (int k = 0; k < 3; k++)
		fprintf(out, "P@%-10g %6.2f %%\n", score_cut[k], 100 * s->precision[k]);
	fprintf(out, "pairs        %6zu\nmissing      %6zu\nempty truth  %6zu\n\npairs     mIoU  object\n",
		s->pairs, s->missing, s->empty_truth);
	for (size_t begin = 0, end; begin < pairs->n; begin = end) {
		struct score one;
		end = object_end(pairs, begin);
		score_sum(&one, pairs->items + begin, end - begin);
		if (one.pairs)
			fprintf(out, "%5zu %6.2f %%  %s\n", one.pairs, 100 * one.miou,
				pairs->items[begin].object);
		else
			fprintf(out, "%5zu %8s  %s\n", one.pairs, "-", pairs->items[begin].object);
	}
}

static int put_json(FILE *out, const struct score *s, const struct score_pairs *pairs, struct err *e)
{
	cJSON *root = cJSON_CreateObject();
	int is_whole = cJSON_AddNumberToObject(root, "miou", s->miou) &&
		       cJSON_AddNumberToObject(root, "oiou", s->oiou) &&
		       cJSON_AddNumberToObject(root, "p25", s->precision[0]) &&
		       cJSON_AddNumberToObject(root, "p50", s->precision[1]) &&
		       cJSON_AddNumberToObject(root, "p75", s->precision[2]) &&
		       cJSON_AddNumberToObject(root, "pairs", (double)s->pairs) &&
		       cJSON_AddNumberToObject(root, "empty_truth", (double)s->empty_truth) &&
		       cJSON_AddNumberToObject(root, "missing", (double)s->missing);
	cJSON *objects = cJSON_AddObjectToObject(root, "objects");
	for (size_t begin = 0, end; begin < pairs->n; begin = end) {
		struct score one;
		end = object_end(pairs, begin);
		score_sum(&one, pairs->items + begin, end - begin);
		cJSON *row = cJSON_AddObjectToObject(objects, pairs->items[begin].object);
		is_whole = is_whole && cJSON_AddNumberToObject(row, "pairs", (double)one.pairs) &&
			   (one.pairs ? cJSON_AddNumberToObject(row, "miou", one.miou)
				      : cJSON_AddNullToObject(row, "miou"));
	}
	char *text = is_whole ? cJSON_PrintUnformatted(root) : NULL;
	cJSON_Delete(root);
	if (!text)
		return err_set(e, ERR_SYSTEM, "scores: out of memory");
	fprintf(out, "%s\n", text);
	cJSON_free(text);
	return 0;
}

static int write_scores(
	const struct cli *c, const struct score *s, const struct score_pairs *pairs, struct err *e)
{
	struct file_out out;

	if (file_out_open(&out, c->output, e))
		return -1;
	if (!c->json) {
		put_table(out.stream, s, pairs);
	} else if (put_json(out.stream, s, pairs, e)) {
		file_out_abort(&out);
		return -1;
	}
	return file_out_commit(&out, e);
}

/* Drops truth of views that no prediction is of. The predictions of a view lie together in what the tools
 * write, so the last match is tried first. */
static void keep_predicted_views(struct side *truth, const struct side *predictions)
{
	size_t kept = 0, at = 0;

	for (size_t i = 0; i < truth->set.n; i++)
		for (size_t k = 0; k < predictions->set.n; k++) {
			const size_t try = (at + k) % predictions->set.n;
			if (strcmp(truth->masks[i].view, predictions->masks[try].view))
				continue;
			truth->masks[kept++] = truth->masks[i];
			at = try;
			break;
		}
	truth->count = kept;
}

static int compare(const struct cli *c, const struct side *truth, const struct side *predictions,
	struct score_pairs *pairs, struct score *s, struct err *e)
{
	if (score_match(pairs, truth->masks, truth->count, predictions->masks, predictions->count, e))
		return -1;
	for (size_t i = 0; i < pairs->n; i++)
		if (score_measure(&pairs->items[i], e))
			return -1;
	score_sum(s, pairs->items, pairs->n);
	if (!s->pairs)
		return err_set(e, ERR_FORMAT, "%s: no mask with anything in it: there is nothing to score",
			file_name(truth->path));
	score_sort(pairs->items, pairs->n);
	cli_note(c, 1, "%zu predictions of views without truth were left out", pairs->unlabelled);
	if (pairs->unmatched)
		cli_warn(c,
			"%s: %zu predictions of labelled views match no truth's ref or object and were left out",
			file_name(predictions->path), pairs->unmatched);
	return 0;
}

int main(int argc, char **argv)
{
	const char *truth_path = NULL;
	double fail_under = 0;
	int is_partial = 0;
	const struct cli_option options[] = {
		{"truth", 0, CLI_STRING, &truth_path, "TRUTH", "the true masks (required)", 0, 0},
		{"predicted-views", 0, CLI_FLAG, &is_partial, NULL,
			"score only views that have a prediction; else truth of others counts as missing", 0,
			0},
		{"fail-under", 0, CLI_REAL, &fail_under, "X", "exit 1 where mIoU is below X, in 0 to 1", 0,
			1},
		{0},
	};
	const struct cli_tool tool = {
		.name = "miou-score",
		.operands = "[PREDICTIONS]",
		.summary = "Score predicted masks against true ones.",
		.options = options,
		.common = CLI_OUTPUT | CLI_JSON | CLI_VERBOSE | CLI_QUIET,
		.max_operands = 1,
	};
	struct side truth = {0}, predictions = {0};
	struct score_pairs pairs = {0};
	struct score s;
	struct cli c;
	struct err e;

	cli_parse(&c, &tool, argc, argv);
	const char *path = c.operand_count ? c.operands[0] : "-";
	if (!truth_path)
		cli_usage(&c, "--truth TRUTH is required");
	if (!strcmp(truth_path, "-") && !strcmp(path, "-"))
		cli_usage(&c, "truth and predictions cannot both be stdin");
	int bad = side_read(&truth, truth_path, &e) || side_read(&predictions, path, &e);
	if (!bad && is_partial)
		keep_predicted_views(&truth, &predictions);
	bad = bad || compare(&c, &truth, &predictions, &pairs, &s, &e) || write_scores(&c, &s, &pairs, &e);
	if (!bad && s.miou < fail_under)
		bad = err_set(&e, ERR_CHECK, "mIoU %.4f is below %g", s.miou, fail_under);
	score_pairs_free(&pairs);
	side_free(&predictions);
	side_free(&truth);
	return bad ? cli_fail(&c, &e) : cli_done(&c);
}
