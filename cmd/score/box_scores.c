#include "cmd/score/scoring.h"

#include "base/file.h"
#include "base/jsontext.h"
#include "base/mem.h"
#include "mask/mask_index.h"

#include <math.h>

static int by_object(const void *a, const void *b)
{
	const struct box_pair *x = a, *y = b;

	return strcmp(x->name, y->name);
}

/* Pairs a prediction, NULL where there is none, with a truth that has a box. */
static void add(struct box_scores *s, const struct box_record *truth, const struct box_record *p)
{
	struct box_pair *pair = &s->pairs[s->n++];

	*pair = (struct box_pair){.name = truth->object ? truth->object : truth->ref,
		.is_missing = !p,
		.is_empty = p && p->is_empty,
		.true_aligned = truth->aligned,
		.true_turned = truth->turned};
	if (p && !p->is_empty) {
		pair->aligned = p->aligned;
		pair->turned = p->turned;
	}
}

static void pair_up(struct box_scores *s, const struct box_set *truth, const struct box_set *predictions,
	const struct mask_lookup *of, char *is_met)
{
	for (size_t i = 0; i < predictions->n; i++) {
		const struct box_record *p = &predictions->records[i];
		size_t at;
		if (mask_lookup_find(of, "", p->ref, p->object, &at) == MASK_NONE) {
			s->unmatched++;
			continue;
		}
		is_met[at] = 1;
		if (!truth->records[at].is_empty)
			add(s, &truth->records[at], p);
	}
	for (size_t i = 0; i < truth->n; i++) {
		s->empty_truth += truth->records[i].is_empty != 0;
		if (!is_met[i] && !truth->records[i].is_empty)
			add(s, &truth->records[i], NULL);
	}
}

static int make(
	struct box_scores *s, const struct box_set *predictions, const char *truth_path, struct err *e)
{
	const size_t n = s->truth.n;
	SCOPED_BY(mask_lookup_free) struct mask_lookup of = {0};
	SCOPED struct mask *names = boxes_names(&s->truth, e);
	SCOPED char *is_met = mem_zalloc(n, 1, "boxes", e);
	int bad = -1;

	s->pairs = mem_alloc(n + predictions->n, sizeof *s->pairs, "boxes", e);
	if (names && is_met && s->pairs && !mask_lookup_make(&of, names, n, e)) {
		pair_up(s, &s->truth, predictions, &of, is_met);
		box_score_sum(&s->all, s->pairs, s->n);
		qsort(s->pairs, s->n, sizeof *s->pairs, by_object);
		bad = s->n ? 0
			   : err_set(e, ERR_FORMAT, "%s: no box at all: there is nothing to score",
				     file_name(truth_path));
	}
	return bad;
}

int box_scores_read(struct box_scores *s, const char *truth, const char *predictions, struct err *e)
{
	SCOPED_BY(boxes_free) struct box_set p = {0};

	*s = (struct box_scores){0};
	int bad = boxes_read(&s->truth, truth, e) || boxes_read(&p, predictions, e) || make(s, &p, truth, e);
	return bad ? -1 : 0;
}

void box_scores_free(struct box_scores *s)
{
	free(s->pairs);
	boxes_free(&s->truth);
	*s = (struct box_scores){0};
}

/* How many of the pairs from `first` on have its name. */
static size_t same_name(const struct box_scores *s, size_t first)
{
	size_t n = 1;

	while (first + n < s->n && !strcmp(s->pairs[first + n].name, s->pairs[first].name))
		n++;
	return n;
}

static void text_figures(FILE *out, const char *name, const struct box_figures *f)
{
	fprintf(out, "%-12s %6.2f %% %6.2f %% %6.2f %%\n", name, 100 * f->iou, 100 * f->p25, 100 * f->p50);
}

static void put_text(FILE *out, const void *scores)
{
	const struct box_scores *s = scores;
	const struct box_score *all = &s->all;

	fprintf(out, "%-12s %8s %8s %8s\n", "boxes", "mIoU", "@0.25", "@0.5");
	text_figures(out, "aligned", &all->aligned);
	text_figures(out, "oriented", &all->turned);
	if (!isnan(all->distance))
		fprintf(out, "centre error %8.4g units, %.2f %% of the diagonal\n", all->distance,
			100 * all->relative);
	fprintf(out, "pairs        %6zu\nmissing      %6zu\nempty        %6zu\nempty truth  %6zu\n\n", s->n,
		all->missing, all->empty, s->empty_truth);
	fprintf(out, "pairs  aligned  oriented   centre  object\n");
	for (size_t i = 0, n; i < s->n; i += n) {
		struct box_score one;
		n = same_name(s, i);
		box_score_sum(&one, s->pairs + i, n);
		fprintf(out, "%5zu %6.2f %%  %6.2f %% ", n, 100 * one.aligned.iou, 100 * one.turned.iou);
		if (isnan(one.relative))
			fprintf(out, "%8s  %s\n", "-", s->pairs[i].name);
		else
			fprintf(out, "%6.2f %%  %s\n", 100 * one.relative, s->pairs[i].name);
	}
}

/* To six digits. */
static void put_number(struct jsontext *to, const char *key, double x)
{
	char text[32];

	snprintf(text, sizeof text, "%.6g", x);
	jsontext_raw(to, key, isnan(x) ? "null" : text);
}

static void put_figures(struct jsontext *to, const char *key, const struct box_figures *f)
{
	jsontext_open(to, key, '{');
	put_number(to, "miou", f->iou);
	put_number(to, "p25", f->p25);
	put_number(to, "p50", f->p50);
	jsontext_close(to, '}');
}

static void put_json(FILE *out, const void *scores)
{
	const struct box_scores *s = scores;
	struct jsontext to = {.out = out};

	jsontext_open(&to, NULL, '{');
	put_figures(&to, "aligned", &s->all.aligned);
	put_figures(&to, "oriented", &s->all.turned);
	put_number(&to, "centre", s->all.distance);
	put_number(&to, "centre_relative", s->all.relative);
	jsontext_number(&to, "pairs", (double)s->n);
	jsontext_number(&to, "missing", (double)s->all.missing);
	jsontext_number(&to, "empty", (double)s->all.empty);
	jsontext_number(&to, "empty_truth", (double)s->empty_truth);
	jsontext_open(&to, "objects", '{');
	for (size_t i = 0, n; i < s->n; i += n) {
		struct box_score one;
		n = same_name(s, i);
		box_score_sum(&one, s->pairs + i, n);
		jsontext_open(&to, s->pairs[i].name, '{');
		jsontext_number(&to, "pairs", (double)n);
		put_number(&to, "aligned", one.aligned.iou);
		put_number(&to, "oriented", one.turned.iou);
		put_number(&to, "centre_relative", one.relative);
		jsontext_close(&to, '}');
	}
	fputs("}}\n", out);
}

int box_scores_write(const struct box_scores *s, const char *path, int is_json, struct err *e)
{
	return file_out_put(path, is_json ? put_json : put_text, s, e);
}
