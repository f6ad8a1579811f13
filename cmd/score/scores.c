#include "cmd/score/scoring.h"

#include "base/file.h"
#include "base/jsontext.h"
#include "base/number.h"

#include <math.h>
#include <string.h>

void scores_free(struct scores *s)
{
	score_table_free(&s->objects);
	score_table_free(&s->relations);
	score_table_free(&s->visibility);
}

/* A table with its name: that of its key in JSON, and of what a row is in text and CSV. */
struct section {
	const char *key, *row;
	const struct score_table *table;
	int is_full; /* in JSON: all figures in each row */
};

enum { SECTIONS = 3 };

static int sections_of(struct section sections[SECTIONS], const struct scores *s)
{
	int n = 0;

	sections[n++] = (struct section){"objects", "object", &s->objects, 0};
	if (s->has_relations)
		sections[n++] = (struct section){"relations", "relation", &s->relations, 1};
	if (s->has_visibility)
		sections[n++] = (struct section){"visibility", "visibility", &s->visibility, 1};
	return n;
}

/* Text */

static void text_figure(
	FILE *out, const char *name, double value, const struct interval *i, const struct score_row *row)
{
	fprintf(out, "%-12s %6.2f %%", name, 100 * value);
	if (row->unit)
		fprintf(out, "  [%.1f, %.1f]", 100 * i->low, 100 * i->high);
	fputc('\n', out);
}

static void text_units(FILE *out, const struct scores *s)
{
	const struct score_row *row = &s->all;

	if (!row->unit) {
		fprintf(out, "interval     none: there is one pair alone\n");
		return;
	}
	fprintf(out, "interval     %g %% of %zu resamples of %zu %s", 100 * s->how->confidence,
		s->how->resamples, row->units, score_unit_name[row->unit]);
	if (row->unit == SCORE_UNIT_PAIRS)
		fprintf(out, ", as there are fewer than %d objects", SCORE_LEAST_OBJECTS);
	fputc('\n', out);
}

static void text_compared(FILE *out, const struct score_row *row)
{
	const struct score_compared *c = &row->other;

	fputc('\n', out);
	text_figure(out, "other mIoU", c->score.miou, &c->miou, row);
	text_figure(out, "other oIoU", c->score.oiou, &c->oiou, row);
	fprintf(out, "difference  %+7.2f %%", 100 * c->difference);
	if (row->unit)
		fprintf(out, "  [%+.2f, %+.2f], p %.3g", 100 * c->range.low, 100 * c->range.high, c->p);
	fprintf(out, "\nbetter       %6zu\nworse        %6zu\nequal        %6zu\nother missed %6zu\n",
		c->better, c->worse, c->equal, c->score.missing);
}

static void text_row(FILE *out, const struct scores *s, const struct score_row *row)
{
	char interval[64] = "-";
	const int is_scored = row->score.pairs > 0;

	if (!is_scored)
		fprintf(out, "%5zu %8s", row->score.pairs, "-");
	else
		fprintf(out, "%5zu %6.2f %%", row->score.pairs, 100 * row->score.miou);
	if (row->unit)
		snprintf(
			interval, sizeof interval, "[%.1f, %.1f]", 100 * row->miou.low, 100 * row->miou.high);
	if (s->how)
		fprintf(out, "  %-14s", interval);
	if (s->is_compared && !is_scored)
		fprintf(out, "  %8s  %10s", "-", "-");
	else if (s->is_compared)
		fprintf(out, "  %6.2f %%  %+8.2f %%", 100 * row->other.score.miou,
			100 * row->other.difference);
	fprintf(out, "  %s\n", row->name);
}

static void text_section(FILE *out, const struct scores *s, const struct section *section)
{
	fprintf(out, "\npairs     mIoU");
	if (s->how)
		fprintf(out, "  %-14s", "interval");
	if (s->is_compared)
		fprintf(out, "     other  difference");
	fprintf(out, "  %s\n", section->row);
	for (size_t i = 0; i < section->table->n; i++)
		text_row(out, s, &section->table->rows[i]);
}

static void put_text(FILE *out, const void *scores)
{
	const struct scores *s = scores;
	const struct score *all = &s->all.score;
	struct section sections[SECTIONS];
	const int n = sections_of(sections, s);

	text_figure(out, "mIoU", all->miou, &s->all.miou, &s->all);
	text_figure(out, "overall IoU", all->oiou, &s->all.oiou, &s->all);
	for (int k = 0; k < 3; k++)
		fprintf(out, "P@%-10g %6.2f %%\n", score_cut[k], 100 * all->precision[k]);
	fprintf(out, "right object %6.2f %%\n", 100 * all->right);
	if (all->peaks) {
		fprintf(out, "peak in box  %6.2f %%\n", 100 * all->in_box);
		fprintf(out, "peak in mask %6.2f %%\n", 100 * all->in_mask);
	}
	fprintf(out, "pairs        %6zu\nmissing      %6zu\nempty truth  %6zu\n", all->pairs, all->missing,
		all->empty_truth);
	if (s->how)
		text_units(out, s);
	if (s->is_compared)
		text_compared(out, &s->all);
	for (int i = 0; i < n; i++)
		text_section(out, s, &sections[i]);
}

/* JSON */

/* A figure that there is only where something was scored. */
static void put_figure(struct jsontext *to, const char *key, double x, const struct score_row *row)
{
	jsontext_number(to, key, row->score.pairs ? x : NAN);
}

static void put_precisions(struct jsontext *to, const struct score *s, const struct score_row *row)
{
	put_figure(to, "p25", s->precision[0], row);
	put_figure(to, "p50", s->precision[1], row);
	put_figure(to, "p75", s->precision[2], row);
	put_figure(to, "right", s->right, row);
}

/* A key for either end; null where there is no interval. */
static void put_interval(struct jsontext *to, const char *low, const char *high, const struct interval *i,
	const struct score_row *row)
{
	jsontext_number(to, low, row->unit ? i->low : NAN);
	jsontext_number(to, high, row->unit ? i->high : NAN);
}

static void put_intervals(struct jsontext *to, const struct interval *miou, const struct interval *oiou,
	const struct score_row *row, int is_full)
{
	put_interval(to, "miou_low", "miou_high", miou, row);
	if (is_full)
		put_interval(to, "oiou_low", "oiou_high", oiou, row);
}

static void put_units(struct jsontext *to, const struct score_row *row)
{
	if (!row->unit) {
		jsontext_raw(to, "resampled", "null");
		return;
	}
	jsontext_string(to, "resampled", score_unit_name[row->unit]);
	jsontext_number(to, "units", (double)row->units);
}

static void put_compared(struct jsontext *to, const struct scores *s, const struct score_row *row)
{
	const struct score_compared *c = &row->other;

	jsontext_open(to, "compare", '{');
	put_figure(to, "miou", c->score.miou, row);
	put_figure(to, "oiou", c->score.oiou, row);
	put_precisions(to, &c->score, row);
	jsontext_number(to, "missing", (double)c->score.missing);
	put_figure(to, "difference", c->difference, row);
	jsontext_number(to, "better", (double)c->better);
	jsontext_number(to, "worse", (double)c->worse);
	jsontext_number(to, "equal", (double)c->equal);
	if (s->how) {
		put_intervals(to, &c->miou, &c->oiou, row, 1);
		put_interval(to, "difference_low", "difference_high", &c->range, row);
		jsontext_number(to, "p", row->unit ? c->p : NAN);
	}
	jsontext_close(to, '}');
}

static void put_row(struct jsontext *to, const struct scores *s, const struct score_row *row, int is_full)
{
	jsontext_open(to, row->name, '{');
	jsontext_number(to, "pairs", (double)row->score.pairs);
	put_figure(to, "miou", row->score.miou, row);
	if (is_full) {
		put_figure(to, "oiou", row->score.oiou, row);
		put_precisions(to, &row->score, row);
		jsontext_number(to, "missing", (double)row->score.missing);
	}
	if (s->how) {
		put_intervals(to, &row->miou, &row->oiou, row, is_full);
		put_units(to, row);
	}
	if (s->is_compared)
		put_compared(to, s, row);
	jsontext_close(to, '}');
}

static void put_json(FILE *out, const void *scores)
{
	const struct scores *s = scores;
	const struct score *all = &s->all.score;
	struct jsontext j = {.out = out}, *to = &j;
	struct section sections[SECTIONS];
	const int n = sections_of(sections, s);

	jsontext_open(to, NULL, '{');
	jsontext_number(to, "miou", all->miou);
	jsontext_number(to, "oiou", all->oiou);
	put_precisions(to, all, &s->all);
	if (all->peaks) {
		jsontext_number(to, "peak_in_box", all->in_box);
		jsontext_number(to, "peak_in_mask", all->in_mask);
	}
	jsontext_number(to, "pairs", (double)all->pairs);
	jsontext_number(to, "empty_truth", (double)all->empty_truth);
	jsontext_number(to, "missing", (double)all->missing);
	if (s->how) {
		put_intervals(to, &s->all.miou, &s->all.oiou, &s->all, 1);
		put_units(to, &s->all);
		jsontext_number(to, "resamples", (double)s->how->resamples);
		jsontext_number(to, "confidence", s->how->confidence);
		jsontext_number(to, "seed", (double)s->how->seed);
	}
	if (s->is_compared)
		put_compared(to, s, &s->all);
	for (int i = 0; i < n; i++) {
		jsontext_open(to, sections[i].key, '{');
		for (size_t r = 0; r < sections[i].table->n; r++)
			put_row(to, s, &sections[i].table->rows[r], sections[i].is_full);
		jsontext_close(to, '}');
	}
	jsontext_close(to, '}');
	fputc('\n', out);
}

/* CSV */

/* In quotation marks where it needs them (RFC 4180, section 2). */
static void csv_text(FILE *out, const char *text)
{
	if (!strpbrk(text, ",\"\r\n")) {
		fputs(text, out);
		return;
	}
	fputc('"', out);
	for (; *text; text++) {
		if (*text == '"')
			fputc('"', out);
		fputc(*text, out);
	}
	fputc('"', out);
}

/* A comma and the number, or nothing after the comma. */
static void csv_number(FILE *out, double x, int is_there)
{
	char text[NUMBER_SIZE];

	fprintf(out, ",%s", is_there ? number_text(text, x) : "");
}

static void csv_row(FILE *out, const struct scores *s, const char *group, const struct score_row *row)
{
	const struct score *own = &row->score;
	const struct score_compared *c = &row->other;
	const int is_scored = own->pairs > 0, is_sure = row->unit != SCORE_UNIT_NONE;

	fprintf(out, "%s,", group);
	csv_text(out, row->name);
	fprintf(out, ",%zu", own->pairs);
	csv_number(out, own->miou, is_scored);
	csv_number(out, row->miou.low, is_sure);
	csv_number(out, row->miou.high, is_sure);
	csv_number(out, own->oiou, is_scored);
	for (int k = 0; k < 3; k++)
		csv_number(out, own->precision[k], is_scored);
	csv_number(out, own->right, is_scored);
	fprintf(out, ",%zu,%s", own->missing, score_unit_name[row->unit]);
	if (s->is_compared) {
		csv_number(out, c->score.miou, is_scored);
		csv_number(out, c->miou.low, is_sure);
		csv_number(out, c->miou.high, is_sure);
		fprintf(out, ",%zu", c->score.missing);
		csv_number(out, c->difference, is_scored);
		csv_number(out, c->range.low, is_sure);
		csv_number(out, c->range.high, is_sure);
		csv_number(out, c->p, is_sure);
		fprintf(out, ",%zu,%zu,%zu", c->better, c->worse, c->equal);
	}
	fputc('\n', out);
}

static void put_csv(FILE *out, const void *scores)
{
	const struct scores *s = scores;
	struct section sections[SECTIONS];
	const int n = sections_of(sections, s);

	fputs("group,name,pairs,miou,low,high,oiou,p25,p50,p75,right,missing,resampled", out);
	if (s->is_compared)
		fputs(",other,other_low,other_high,other_missing,difference,difference_low,difference_high,p,"
		      "better,worse,equal",
			out);
	fputc('\n', out);
	csv_row(out, s, "all", &s->all);
	for (int i = 0; i < n; i++)
		for (size_t r = 0; r < sections[i].table->n; r++)
			csv_row(out, s, sections[i].row, &sections[i].table->rows[r]);
}

int scores_write(const struct scores *s, const char *path, enum scores_form form, struct err *e)
{
	return file_out_put(path,
		form == SCORES_JSON  ? put_json
		: form == SCORES_CSV ? put_csv
				     : put_text,
		s, e);
}
