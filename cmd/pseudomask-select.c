/* pseudomask-select: of the candidate masks of an object in a view, the one that its sentences agree on. */
#include "base/err.h"
#include "base/file.h"
#include "base/mem.h"
#include "cli/cli.h"
#include "formats/masks.h"
#include "mask/select.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* A candidate's place: sorted, those of one view and object lie side by side, in the order of the file. */
struct place {
	const char *view, *name;
	int is_ref; /* a candidate without an object has only its own sentence's to be pooled with */
	size_t index;
};

struct group {
	size_t first;	 /* index of its first candidate in the file */
	size_t begin, n; /* among the places */
	long winner;	 /* relative to begin; -1: none */
};

struct work {
	struct mask_set set;
	long *lines;		      /* (set.n) of the file */
	struct place *places;	      /* (set.n) */
	struct candidate *candidates; /* (set.n) as places */
	double *votes;		      /* (set.n) as places */
	struct group *groups;	      /* (group_count) in the order of their first candidates */
	size_t group_count;
};

static void work_free(struct work *w)
{
	masks_free(&w->set);
	free(w->lines);
	free(w->places);
	free(w->candidates);
	free(w->votes);
	free(w->groups);
}

static int order_places(const void *a, const void *b)
{
	const struct place *p = a, *q = b;
	int order = strcmp(p->view, q->view);

	if (!order)
		order = p->is_ref - q->is_ref;
	if (!order)
		order = strcmp(p->name, q->name);
	return order ? order : (p->index > q->index) - (p->index < q->index);
}

static int order_groups(const void *a, const void *b)
{
	const struct group *p = a, *q = b;

	return (p->first > q->first) - (p->first < q->first);
}

/* Masks of one view are compared pixel by pixel: all must have the size of the view's first. */
static int check_sizes(const struct work *w, const char *path, struct err *e)
{
	size_t first = 0, bad = w->set.n, bad_first = 0;

	for (size_t begin = 0, end; begin < w->set.n; begin = end) {
		first = w->places[begin].index;
		for (end = begin; end < w->set.n && !strcmp(w->places[end].view, w->places[begin].view);
			end++)
			if (w->places[end].index < first)
				first = w->places[end].index;
		const struct rle *m = &w->set.records[first].mask;
		for (size_t i = begin; i < end; i++) {
			const struct rle *other = &w->set.records[w->places[i].index].mask;
			if ((other->height != m->height || other->width != m->width) &&
				w->places[i].index < bad) {
				bad = w->places[i].index;
				bad_first = first;
			}
		}
	}
	if (bad == w->set.n)
		return 0;
	const struct mask_record *a = &w->set.records[bad], *b = &w->set.records[bad_first];
	return err_set(e, ERR_FORMAT, "%s:%ld: a mask of %dx%d, but view '%s' has %dx%d on line %ld",
		file_name(path), w->lines[bad], a->mask.width, a->mask.height, a->view, b->mask.width,
		b->mask.height, w->lines[bad_first]);
}

static int make_groups(struct work *w, const char *path, struct err *e)
{
	size_t n = w->set.n;

	w->places = mem_alloc(n, sizeof *w->places, path, e);
	w->candidates = mem_alloc(n, sizeof *w->candidates, path, e);
	w->votes = mem_alloc(n, sizeof *w->votes, path, e);
	w->groups = mem_alloc(n, sizeof *w->groups, path, e);
	if (!w->places || !w->candidates || !w->votes || !w->groups)
		return -1;
	for (size_t i = 0; i < n; i++) {
		const struct mask_record *r = &w->set.records[i];
		w->places[i] = (struct place){r->view, r->object ? r->object : r->ref, !r->object, i};
	}
	if (n)
		qsort(w->places, n, sizeof *w->places, order_places);
	if (check_sizes(w, path, e))
		return -1;
	for (size_t i = 0; i < n; i++) {
		const struct place *p = &w->places[i];
		const struct mask_record *r = &w->set.records[p->index];
		w->candidates[i] =
			(struct candidate){&r->mask, rle_area(&r->mask), isnan(r->score) ? 1 : r->score};
		if (!i || strcmp(p->view, p[-1].view) || p->is_ref != p[-1].is_ref ||
			strcmp(p->name, p[-1].name))
			w->groups[w->group_count++] = (struct group){.first = p->index, .begin = i};
		w->groups[w->group_count - 1].n++;
	}
	if (w->group_count)
		qsort(w->groups, w->group_count, sizeof *w->groups, order_groups);
	return 0;
}

static int put_winners(const struct work *w, FILE *out, struct err *e)
{
	for (size_t i = 0; i < w->group_count; i++) {
		const struct group *g = &w->groups[i];
		if (g->winner < 0)
			continue;
		struct mask_record r = w->set.records[w->places[g->begin + (size_t)g->winner].index];
		/* a mask without a sentence serves all of its object's */
		if (r.object)
			r.ref = NULL;
		r.score = w->votes[g->begin + (size_t)g->winner];
		if (masks_put(out, &r, e))
			return -1;
	}
	return 0;
}

static int run(
	struct work *w, const struct cli *c, enum select_method method, double min_score, struct err *e)
{
	const char *path = c->operand_count ? c->operands[0] : "-";
	size_t kept = 0, without = 0;
	struct file_out out;

	if (masks_read_lines(&w->set, &w->lines, path, e) || make_groups(w, path, e))
		return -1;
	if (!w->set.n)
		cli_warn(c, "%s: no candidates", file_name(path));
#pragma omp parallel for schedule(dynamic)
	for (size_t i = 0; i < w->group_count; i++) {
		struct group *g = &w->groups[i];
		g->winner =
			select_winner(w->candidates + g->begin, g->n, method, min_score, w->votes + g->begin);
	}
	for (size_t i = 0; i < w->set.n; i++)
		kept += w->candidates[i].score > min_score;
	for (size_t i = 0; i < w->group_count; i++)
		without += w->groups[i].winner < 0;
	cli_note(c, 1, "%zu candidates, %zu of them not above %g", w->set.n, w->set.n - kept, min_score);
	cli_note(c, 1, "%zu masks; %zu views of an object without one", w->group_count - without, without);
	if (file_out_open(&out, c->output, e))
		return -1;
	if (put_winners(w, out.stream, e)) {
		file_out_abort(&out);
		return -1;
	}
	return file_out_commit(&out, e);
}

int main(int argc, char **argv)
{
	int method = SELECT_CIOU;
	double min_score = 0.3;
	const struct cli_option options[] = {
		{"method", 0, CLI_CHOICE, &method, "ciou|iou|top1",
			"confidence-weighted IoU votes (default), IoU votes, or the most confident", 0, 0},
		{"min-score", 0, CLI_REAL, &min_score, "G",
			"leave out candidates with no more confidence (default 0.3)", 0, 1},
		{0},
	};
	const struct cli_tool tool = {
		.name = "pseudomask-select",
		.operands = "[CANDIDATES]",
		.summary =
			"Pick, of an object's candidate masks in each view, the one its sentences agree on.",
		.options = options,
		.common = CLI_OUTPUT | CLI_THREADS | CLI_VERBOSE | CLI_QUIET,
		.max_operands = 1,
	};
	struct cli c;
	struct work w = {0};
	struct err e;

	cli_parse(&c, &tool, argc, argv);
	int bad = run(&w, &c, (enum select_method)method, min_score, &e);
	work_free(&w);
	return bad ? cli_fail(&c, &e) : cli_done(&c);
}
