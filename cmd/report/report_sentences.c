#include "cmd/report/reporting.h"

#include "base/hash.h"
#include "base/mem.h"
#include "cmd/render/request.h"
#include "formats/records/json.h"
#include "mask/trace.h"

#include <math.h>

/* Sides are level and upright by turns, the last one up to where the line began. */
static char *path_of(const struct trace *t, struct err *e)
{
	char *text = NULL;
	size_t length;
	FILE *out = open_memstream(&text, &length);

	for (size_t i = 0; i < t->n && out; i++) {
		const struct trace_corner *c = &t->corners[i];
		if (c->is_first)
			fprintf(out, "%sM%d %d", i ? "z" : "", c->x, c->y);
		else if (c->y == c[-1].y)
			fprintf(out, "h%d", c->x - c[-1].x);
		else
			fprintf(out, "v%d", c->y - c[-1].y);
	}
	if (out && t->n)
		fputc('z', out);
	return mem_text_end(out, &text, 0, "outline", e);
}

static char *trace_path(const struct rle *mask, int height, int width, struct err *e)
{
	SCOPED_BY(rle_free) struct rle small = {0};
	SCOPED_BY(trace_free) struct trace t = {0};
	SCOPED uint8_t *pixels = mem_alloc((size_t)height, (size_t)width, "mask", e);
	char *path = NULL;

	if (pixels && !rle_resize(&small, mask, height, width, e)) {
		rle_decode(&small, pixels);
		path = trace_mask(&t, pixels, height, width, e) ? NULL : path_of(&t, e);
	}
	return path;
}

/* *index gets the place of the outline of a mask, brought to the size of a picture. */
static int report_outline(struct report_outlines *o, const struct rle *mask, int height, int width,
	size_t *index, struct err *e)
{
	char *path = trace_path(mask, height, width, e);

	if (!path)
		return -1;
	const uint64_t hash = hash64(path, strlen(path), 0);
	for (*index = 0; *index < o->n; ++*index)
		if (o->items[*index].hash == hash && !strcmp(o->items[*index].path, path)) {
			free(path);
			return 0;
		}
	if (mem_grow((void **)&o->items, &o->capacity, o->n + 1, sizeof *o->items, "outlines", e)) {
		free(path);
		return -1;
	}
	o->items[o->n++] = (struct report_outline){path, hash};
	return 0;
}

void report_outlines_free(struct report_outlines *o)
{
	for (size_t i = 0; i < o->n; i++)
		free(o->items[i].path);
	free(o->items);
	*o = (struct report_outlines){0};
}

struct card {
	const struct report_run *run;
	const struct report_set *set;
	struct report_outlines *outlines;
	const struct report_reason *reason; /* NULL: of a trained model */
	size_t sentence;
	const char *ref;
};

static int is_of(const struct card *c, const struct score_pair *p)
{
	const char *ref = p->ref || !p->truth ? p->ref : p->truth->ref;

	return ref && !strcmp(ref, c->ref) && !p->is_empty;
}

static const struct score_pair *find_pair(const struct card *c, const char *view)
{
	const struct score_pairs *p = &c->set->pairs;

	for (size_t i = 0; i < p->n; i++)
		if (is_of(c, &p->items[i]) && !strcmp(c->set->truth[p->items[i].truth_index].view, view))
			return &p->items[i];
	return NULL;
}

static const struct mask *find_mask(const struct card *c, const char *view)
{
	const struct score_masks *m = &c->set->masks;

	for (size_t i = 0; i < m->n; i++)
		if (m->set.items[i].ref && !strcmp(m->set.items[i].ref, c->ref) &&
			!strcmp(m->set.items[i].view, view))
			return &m->set.items[i];
	return NULL;
}

static int put_view(struct jsontext *to, const struct card *c, size_t v, struct err *e)
{
	const struct camera *view = &c->run->shown[v];
	const struct score_pair *pair = find_pair(c, view->name);
	const struct mask *mask = find_mask(c, view->name);
	size_t own = 0, truth = 0;

	if (!mask && !pair)
		return 0;
	if ((mask && report_outline(c->outlines, &mask->rle, view->height, view->width, &own, e)) ||
		(pair &&
			report_outline(c->outlines, &pair->truth->rle, view->height, view->width, &truth, e)))
		return -1;
	jsontext_open(to, NULL, '[');
	jsontext_number(to, NULL, (double)v);
	jsontext_number(to, NULL, mask ? (double)own : -1);
	jsontext_number(to, NULL, pair ? (double)truth : -1);
	jsontext_rounded(to, NULL, pair ? pair->iou : NAN);
	jsontext_close(to, ']');
	return 0;
}

/* A lifted answer is right where it names what the sentence means and nothing else; a trained one where its
 * masks show that thing more than any other. -1: not known. */
static int is_right(const struct card *c, const cJSON *meant, size_t pairs, size_t right)
{
	const struct report_reason *r = c->reason;
	const int is = r ? meant_is(meant, &c->run->lifted.lifted, r->things, r->count) : -1;

	return is >= 0 ? is : pairs ? right == pairs : -1;
}

static void put_scores(struct jsontext *to, const struct card *c, const cJSON *meant)
{
	const struct score_pairs *p = &c->set->pairs;
	const struct score_masks *m = &c->set->masks;
	double sum = 0, sure = NAN;
	size_t pairs = 0, right = 0;

	for (size_t i = 0; i < p->n; i++) {
		if (!is_of(c, &p->items[i]))
			continue;
		sum += p->items[i].iou;
		right += (size_t)p->items[i].is_right;
		pairs++;
	}
	for (size_t i = 0; i < m->n; i++)
		if (m->set.items[i].ref && !strcmp(m->set.items[i].ref, c->ref))
			sure = fmax(sure, m->set.items[i].score);
	const int is = is_right(c, meant, pairs, right);
	jsontext_rounded(to, "sure", sure);
	jsontext_rounded(to, "iou", pairs ? sum / (double)pairs : NAN);
	jsontext_number(to, "pairs", (double)pairs);
	jsontext_raw(to, "right", is < 0 ? "null" : is ? "true" : "false");
}

static void put_reason(struct jsontext *to, const struct report_reason *r, char *const *names)
{
	jsontext_open(to, "answer", '[');
	for (size_t k = 0; k < r->count; k++)
		jsontext_string(to, NULL, names[r->things[k]]);
	jsontext_close(to, ']');
	jsontext_rounded(to, "there", r->there);
	jsontext_string(to, "refusal", r->refusal);
	if (r->runner_up) {
		jsontext_string(to, "runner_up", r->runner_up);
		jsontext_rounded(to, "runner_up_chance", r->runner_up_chance);
	}
	if (r->explained)
		jsontext_raw(to, "explained", r->explained);
}

static int put_card(struct jsontext *to, const struct card *c, struct err *e)
{
	const struct text *t = &c->set->text;
	SCOPED_BY(json_release) cJSON *meant = meant_names(t, c->sentence);
	const cJSON *name;
	int bad = 0;

	jsontext_open(to, NULL, '{');
	jsontext_string(to, "ref", c->ref);
	jsontext_string(to, "text", t->texts[c->sentence]);
	put_scores(to, c, meant);
	if (c->reason)
		put_reason(to, c->reason, c->run->lifted.lifted.names);
	if (meant) {
		jsontext_open(to, "said", '[');
		cJSON_ArrayForEach(name, meant) jsontext_string(to, NULL, cJSON_GetStringValue(name));
		jsontext_close(to, ']');
	}
	jsontext_open(to, "views", '[');
	for (size_t v = 0; v < c->run->shown_count && !bad; v++)
		bad = put_view(to, c, v, e);
	jsontext_close(to, ']');
	jsontext_close(to, '}');
	return bad;
}

static int is_answered(const struct report_set *s, const char *ref)
{
	for (size_t i = 0; i < s->masks.n; i++)
		if (s->masks.set.items[i].ref && !strcmp(s->masks.set.items[i].ref, ref))
			return 1;
	return 0;
}

static int put_cards(struct jsontext *to, struct card *c, const struct report_reason *reasons, struct err *e)
{
	const struct text *t = &c->set->text;
	int bad = 0;

	jsontext_open(to, "sentences", '[');
	for (size_t i = 0; i < t->n && !bad; i++) {
		c->sentence = i;
		c->ref = t->refs[i];
		c->reason = reasons ? &reasons[i] : NULL;
		bad = is_answered(c->set, c->ref) && put_card(to, c, e);
	}
	jsontext_close(to, ']');
	return bad;
}

static void put_score(struct jsontext *to, const struct score *s)
{
	jsontext_open(to, "score", '{');
	jsontext_rounded(to, "miou", s->miou);
	jsontext_rounded(to, "right", s->right);
	jsontext_rounded(to, "p50", s->precision[1]);
	jsontext_number(to, "pairs", (double)s->pairs);
	jsontext_number(to, "missing", (double)s->missing);
	jsontext_close(to, '}');
}

static int put_set(struct jsontext *to, const struct report_run *r, const struct report_set *s,
	struct report_outlines *o, struct err *e)
{
	const int is_lifted = r->has_lifted && !strcmp(s->way, "lifted");
	SCOPED struct report_reason *reasons = mem_zalloc(s->text.n, sizeof *reasons, "sentences", e);
	struct card c = {.run = r, .set = s, .outlines = o};

	jsontext_open(to, NULL, '{');
	jsontext_string(to, "way", s->way);
	jsontext_string(to, "name", s->name);
	if (s->sum.pairs)
		put_score(to, &s->sum);
	const int bad = !reasons || (is_lifted && report_reasons(r, s, reasons, e)) ||
			put_cards(to, &c, is_lifted ? reasons : NULL, e);
	jsontext_close(to, '}');
	report_reasons_free(reasons, s->text.n);
	return bad;
}

int report_sentences(
	struct jsontext *to, const struct report_run *r, struct report_outlines *o, struct err *e)
{
	int bad = 0;

	jsontext_open(to, "sets", '[');
	for (size_t k = 0; k < r->set_count && !bad; k++)
		bad = put_set(to, r, &r->sets[k], o, e);
	jsontext_close(to, ']');
	return bad ? -1 : 0;
}
