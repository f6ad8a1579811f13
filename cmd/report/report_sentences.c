#include "cmd/report/reporting.h"

#include "base/mem.h"
#include "cmd/render/request.h"

#include <math.h>
#include <string.h>

struct card {
	const struct report_run *run;
	const struct report_set *set;
	struct report_outlines *outlines;
	const struct report_reason *reason; /* NULL: of a trained model */
	size_t sentence;
	const char *ref;
};

/* To four digits: more are noise, and longer. */
static cJSON *number(double x)
{
	return isfinite(x) ? cJSON_CreateNumber(round(x * 1e4) / 1e4) : cJSON_CreateNull();
}

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

static int add_view(cJSON *list, const struct card *c, size_t v, struct err *e)
{
	const struct camera *view = &c->run->shown[v];
	const struct score_pair *pair = find_pair(c, view->name);
	const struct mask *mask = find_mask(c, view->name);
	cJSON *one = cJSON_CreateArray();
	size_t own = 0, truth = 0;

	if (!mask && !pair) {
		cJSON_Delete(one);
		return 0;
	}
	if ((mask && report_outline(c->outlines, &mask->rle, view->height, view->width, &own, e)) ||
		(pair && report_outline(
				 c->outlines, &pair->truth->rle, view->height, view->width, &truth, e))) {
		cJSON_Delete(one);
		return -1;
	}
	if (cJSON_AddItemToArray(one, cJSON_CreateNumber((double)v)) &&
		cJSON_AddItemToArray(one, cJSON_CreateNumber(mask ? (double)own : -1)) &&
		cJSON_AddItemToArray(one, cJSON_CreateNumber(pair ? (double)truth : -1)) &&
		cJSON_AddItemToArray(one, number(pair ? pair->iou : NAN)) && cJSON_AddItemToArray(list, one))
		return 0;
	return err_set(e, ERR_SYSTEM, "page: out of memory");
}

/* A lifted answer is right where it names what the sentence means and nothing else; a trained one where its
 * masks show that thing more than any other. -1: not known. */
static int is_right(const struct card *c, const cJSON *meant, size_t pairs, size_t right)
{
	const int is = c->reason ? meant_is(meant, &c->run->lifted.lifted, c->reason->answer) : -1;

	return is >= 0 ? is : pairs ? right == pairs : -1;
}

static int add_scores(cJSON *to, const struct card *c, const cJSON *meant)
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
	return report_add(to, "sure", number(sure)) &&
	       report_add(to, "iou", number(pairs ? sum / (double)pairs : NAN)) &&
	       report_add(to, "pairs", cJSON_CreateNumber((double)pairs)) &&
	       report_add(to, "right", is < 0 ? cJSON_CreateNull() : cJSON_CreateBool(is));
}

static int add_reason(cJSON *to, const struct report_reason *r)
{
	return report_add(to, "answer", cJSON_Duplicate(r->answer, 1)) &&
	       report_add(to, "there", number(r->there)) &&
	       report_add(to, "refusal", cJSON_CreateString(r->refusal)) &&
	       (!r->runner_up || (report_add(to, "runner_up", cJSON_CreateString(r->runner_up)) &&
					 report_add(to, "runner_up_chance", number(r->runner_up_chance)))) &&
	       (!r->explained || report_add(to, "explained", cJSON_Duplicate(r->explained, 1)));
}

static int add_card(cJSON *list, const struct card *c, struct err *e)
{
	const struct text *t = &c->set->text;
	cJSON *one = cJSON_CreateObject(), *meant = meant_names(t, c->sentence), *views = cJSON_CreateArray();
	int bad = 0;

	for (size_t v = 0; v < c->run->shown_count && !bad; v++)
		bad = add_view(views, c, v, e);
	if (!bad && !(report_add(one, "ref", cJSON_CreateString(c->ref)) &&
			    report_add(one, "text", cJSON_CreateString(t->texts[c->sentence])) &&
			    add_scores(one, c, meant) && (!c->reason || add_reason(one, c->reason)) &&
			    (!meant || report_add(one, "said", cJSON_Duplicate(meant, 1)))))
		bad = err_set(e, ERR_SYSTEM, "page: out of memory");
	cJSON_Delete(meant);
	if (bad)
		cJSON_Delete(views);
	else if (report_add(one, "views", views) && cJSON_AddItemToArray(list, one))
		return 0;
	cJSON_Delete(one);
	return bad ? -1 : err_set(e, ERR_SYSTEM, "page: out of memory");
}

static int is_answered(const struct report_set *s, const char *ref)
{
	for (size_t i = 0; i < s->masks.n; i++)
		if (s->masks.set.items[i].ref && !strcmp(s->masks.set.items[i].ref, ref))
			return 1;
	return 0;
}

static int add_cards(cJSON *list, struct card *c, const struct report_reason *reasons, struct err *e)
{
	const struct text *t = &c->set->text;

	for (size_t i = 0; i < t->n; i++) {
		c->sentence = i;
		c->ref = t->refs[i];
		c->reason = reasons ? &reasons[i] : NULL;
		if (is_answered(c->set, c->ref) && add_card(list, c, e))
			return -1;
	}
	return 0;
}

static int add_score(cJSON *to, const struct score *s)
{
	cJSON *one = cJSON_AddObjectToObject(to, "score");

	return report_add(one, "miou", number(s->miou)) && report_add(one, "right", number(s->right)) &&
	       report_add(one, "p50", number(s->precision[1])) &&
	       report_add(one, "pairs", cJSON_CreateNumber((double)s->pairs)) &&
	       report_add(one, "missing", cJSON_CreateNumber((double)s->missing));
}

static cJSON *set_of(
	const struct report_run *r, const struct report_set *s, struct report_outlines *o, struct err *e)
{
	const int is_lifted = r->has_lifted && !strcmp(s->way, "lifted");
	SCOPED struct report_reason *reasons = mem_zalloc(s->text.n, sizeof *reasons, "sentences", e);
	struct card c = {.run = r, .set = s, .outlines = o};
	cJSON *one = cJSON_CreateObject(), *list = cJSON_CreateArray();
	int bad = !reasons || (is_lifted && report_reasons(r, s, reasons, e)) ||
		  add_cards(list, &c, is_lifted ? reasons : NULL, e);

	if (!bad && !(report_add(one, "way", cJSON_CreateString(s->way)) &&
			    report_add(one, "name", cJSON_CreateString(s->name)) &&
			    (!s->sum.pairs || add_score(one, &s->sum))))
		bad = err_set(e, ERR_SYSTEM, "page: out of memory");
	report_reasons_free(reasons, s->text.n);
	if (bad)
		cJSON_Delete(list);
	else if (report_add(one, "sentences", list))
		return one;
	cJSON_Delete(one);
	return NULL;
}

cJSON *report_sentences(const struct report_run *r, struct report_outlines *o, struct err *e)
{
	cJSON *list = cJSON_CreateArray();

	for (size_t k = 0; k < r->set_count; k++) {
		cJSON *one = set_of(r, &r->sets[k], o, e);
		if (!one || !cJSON_AddItemToArray(list, one)) {
			cJSON_Delete(list);
			return NULL;
		}
	}
	return list;
}
