#include "cmd/score/scoring.h"

#include "base/compare.h"
#include "base/file.h"
#include "base/jsontext.h"
#include "base/mem.h"
#include "base/number.h"

#include <math.h>

static const char *const target_names[ANSWER_TARGETS] = {"all", "one", "several", "none"};
static const char *const no_kind = "(unknown)";

static int list_kinds(struct answer_scores *s, struct err *e)
{
	size_t n = 0;

	s->kinds = mem_alloc(s->answers.n, sizeof *s->kinds, "kinds", e);
	if (!s->kinds)
		return -1;
	for (size_t i = 0; i < s->answers.n; i++) {
		const char *kind = s->answers.items[i].sentence->kind;
		s->kinds[i] = kind ? kind : "";
	}
	qsort(s->kinds, s->answers.n, sizeof *s->kinds, compare_string);
	for (size_t i = 0; i < s->answers.n; i++)
		if (!n || strcmp(s->kinds[n - 1], s->kinds[i]))
			s->kinds[n++] = s->kinds[i];
	s->kind_count = n;
	return 0;
}

int answer_scores_make(struct answer_scores *s, const struct sentences *sentences,
	const struct score_masks *truth, const struct score_masks *predictions, struct err *e)
{
	*s = (struct answer_scores){
		.sentences = mem_alloc(sentences->n, sizeof *s->sentences, "sentences", e)};
	if (!s->sentences)
		return -1;
	for (size_t i = 0; i < sentences->n; i++) {
		struct sentence *one = &sentences->items[i];
		s->sentences[i] = (struct answer_sentence){.ref = one->ref,
			.kind = one->kind,
			.view = one->view,
			.object_count = one->has_objects ? one->object_count : 1,
			.objects = one->has_objects ? one->objects : &one->object,
			.view_count = one->view_count,
			.views = one->views,
			.when = one->has_when ? one->when : NULL};
	}
	int bad = answers_make(&s->answers, s->sentences, sentences->n, truth->set.items, truth->n,
		predictions->set.items, predictions->n, e);
	if (bad && e->code == ERR_FORMAT)
		err_prefix(e, file_name(truth->path));
	if (!bad && !s->answers.n)
		bad = err_set(e, ERR_FORMAT,
			"%s: shows nothing that a sentence means: there is nothing to score",
			file_name(truth->path));
	bad = bad || list_kinds(s, e);
	return bad ? -1 : 0;
}

void answer_scores_free(struct answer_scores *s)
{
	answers_free(&s->answers);
	mem_free_all(s->sentences, s->kinds);
	*s = (struct answer_scores){0};
}

enum { FIGURES = 6, TIMED = 3 };

/* Those of sentences that have a time come last. */
static void list_figures(const struct answer_score *s, double figures[FIGURES + TIMED])
{
	const double all[] = {
		s->right, s->miou, s->oiou, s->refused, s->f1[0], s->f1[1], s->accuracy, s->viou, s->tiou};

	memcpy(figures, all, sizeof all);
}

/* What is printed: those of a time only where a sentence has one. */
static size_t figure_count(const struct answer_scores *s)
{
	struct answer_score all;

	answer_score_sum(&all, &s->answers, ANSWER_ANY, NULL);
	return FIGURES + (all.timed ? TIMED : 0);
}

static void text_head(FILE *out, size_t n, const char *what)
{
	static const char *const names[] = {
		"right", "mIoU", "oIoU", "refused", "F1@0.25", "F1@0.5", "Acc", "vIoU", "tIoU"};

	fputs("pairs", out);
	for (size_t i = 0; i < n; i++)
		fprintf(out, " %9s", names[i]);
	fprintf(out, "  %s\n", what);
}

static void text_row(FILE *out, const struct answer_score *s, size_t n, const char *name)
{
	double figures[FIGURES + TIMED];

	list_figures(s, figures);
	fprintf(out, "%5zu", s->pairs);
	for (size_t i = 0; i < n; i++)
		if (i < FIGURES ? s->pairs : s->timed)
			fprintf(out, " %7.2f %%", 100 * figures[i]);
		else
			fprintf(out, " %9s", "-");
	fprintf(out, "  %s\n", name);
}

static void text_accuracy(FILE *out, const char *name, double x)
{
	if (isnan(x))
		fprintf(out, "%-12s %6s\n", name, "-");
	else
		fprintf(out, "%-12s %6.2f %%\n", name, 100 * x);
}

static void put_text(FILE *out, const void *scores)
{
	const struct answer_scores *s = scores;
	const size_t n = figure_count(s);
	struct answer_score row;
	double none, some;

	answer_target_accuracy(&none, &some, &s->answers);
	text_head(out, n, "means");
	for (int i = 0; i < ANSWER_TARGETS; i++) {
		answer_score_sum(&row, &s->answers, (enum answer_targets)i, NULL);
		text_row(out, &row, n, target_names[i]);
	}
	fputc('\n', out);
	text_head(out, n, "kind");
	for (size_t i = 0; i < s->kind_count; i++) {
		answer_score_sum(&row, &s->answers, ANSWER_ANY, s->kinds[i]);
		text_row(out, &row, n, *s->kinds[i] ? s->kinds[i] : no_kind);
	}
	answer_score_sum(&row, &s->answers, ANSWER_ANY, NULL);
	fputc('\n', out);
	text_accuracy(out, "N-acc", none);
	text_accuracy(out, "T-acc", some);
	fprintf(out, "missing      %6zu\nout of sight %6zu\n", row.missing, s->answers.out_of_sight);
}

/* The fewest digits that read back as the same number. */
static void put_number(struct jsontext *to, const char *key, double x, int is_there)
{
	char text[NUMBER_SIZE];

	jsontext_raw(to, key, is_there ? number_text(text, x) : "null");
}

static void put_row(struct jsontext *to, const struct answer_score *s, size_t n, const char *name)
{
	static const char *const keys[] = {
		"right", "miou", "oiou", "refused", "f1_25", "f1_50", "accuracy", "viou", "tiou"};
	double figures[FIGURES + TIMED];

	list_figures(s, figures);
	jsontext_open(to, name, '{');
	jsontext_number(to, "pairs", (double)s->pairs);
	for (size_t i = 0; i < n; i++)
		put_number(to, keys[i], figures[i], (i < FIGURES ? s->pairs : s->timed) > 0);
	if (n > FIGURES)
		jsontext_number(to, "timed", (double)s->timed);
	jsontext_number(to, "missing", (double)s->missing);
	jsontext_close(to, '}');
}

static void put_json(FILE *out, const void *scores)
{
	const struct answer_scores *s = scores;
	struct jsontext to = {.out = out};
	const size_t n = figure_count(s);
	struct answer_score row;
	double none, some;

	jsontext_open(&to, NULL, '{');
	for (int i = 0; i < ANSWER_TARGETS; i++) {
		answer_score_sum(&row, &s->answers, (enum answer_targets)i, NULL);
		put_row(&to, &row, n, target_names[i]);
	}
	answer_target_accuracy(&none, &some, &s->answers);
	put_number(&to, "n_acc", none, !isnan(none));
	put_number(&to, "t_acc", some, !isnan(some));
	jsontext_number(&to, "out_of_sight", (double)s->answers.out_of_sight);
	jsontext_open(&to, "kinds", '{');
	for (size_t i = 0; i < s->kind_count; i++) {
		answer_score_sum(&row, &s->answers, ANSWER_ANY, s->kinds[i]);
		put_row(&to, &row, n, *s->kinds[i] ? s->kinds[i] : no_kind);
	}
	fputs("}}\n", out);
}

int answer_scores_write(const struct answer_scores *s, const char *path, int is_json, struct err *e)
{
	return file_out_put(path, is_json ? put_json : put_text, s, e);
}
