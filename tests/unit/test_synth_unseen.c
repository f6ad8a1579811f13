/* The unseen split: what its parses mean by an evaluator of its own, without margins, and what must not
 * matter. */
#include "unit.h"

#include "base/mem.h"
#include "synth/presets.h"
#include "synth/cameras.h"
#include "synth/unseen.h"

#include <inttypes.h>

enum { SEEDS = UNIT_DRAWS(6, 2) };

/* A scene with its sentences. */
struct world {
	int n;
	struct synth_object objects[SYNTH_MAX_OBJECTS];
	struct synth_table table;
	struct cameras cameras;
	struct synth_sentences list;
};

static int world_make(struct world *w, int number, uint64_t seed)
{
	const struct synth_preset *p = synth_preset(number);
	struct synth_options o = {p, seed, p->objects, p->views, 64, 48, 1000, 0, 0};
	struct err e = {0};

	w->n = p->objects;
	synth_arrange(w->objects, w->n, &w->table, p, seed);
	return CHECK(!synth_cameras_make(&w->cameras, &o, &w->table, &e), "%s", e.message) &&
	       CHECK(!synth_unseen_make(&w->list, w->objects, w->n, &w->table, &w->cameras, seed, &e), "%s",
		       e.message);
}

static void world_free(struct world *w)
{
	synth_sentences_free(&w->list);
	cameras_free(&w->cameras);
}

/* Naive: positions along two directions, one threshold for each relation, no third value. */
struct naive {
	const struct world *w;
	const struct synth_sentence *x;
	double right[2], away[2];
	double slack; /* in [0,1]: from the laxest to the strictest threshold that anybody would have */
};

static double along(const double d[2], const struct synth_object *o)
{
	return d[0] * o->x + d[1] * o->y;
}

static uint64_t naive_phrase(const struct naive *v, int phrase);

static double distance(const struct synth_object *a, const struct synth_object *b)
{
	return hypot(a->x - b->x, a->y - b->y);
}

static double bulk(const struct synth_object *o)
{
	return o->radius * o->radius * o->height;
}

/* How much of what the relation names an object has. */
static double amount(const struct naive *v, enum parse_relation r, const struct synth_object *o,
	const struct synth_object *anchor)
{
	double nearness = anchor ? -distance(o, anchor) : -along(v->away, o);

	switch (r) {
	case PARSE_LEFT:
		return -along(v->right, o);
	case PARSE_RIGHT:
		return along(v->right, o);
	case PARSE_FRONT:
		return -along(v->away, o);
	case PARSE_BEHIND:
		return along(v->away, o);
	case PARSE_NEAR:
		return nearness;
	case PARSE_FAR:
		return -nearness;
	case PARSE_LARGER:
		return bulk(o);
	case PARSE_SMALLER:
		return -bulk(o);
	case PARSE_TALLER:
		return o->height;
	default:
		return -o->height;
	}
}

static int is_between(const struct naive *v, const struct synth_object *o, const struct synth_object *a,
	const struct synth_object *b)
{
	double dx = b->x - a->x, dy = b->y - a->y, length = dx * dx + dy * dy;
	double t = ((o->x - a->x) * dx + (o->y - a->y) * dy) / length;
	double off = fabs((o->x - a->x) * dy - (o->y - a->y) * dx) / length;

	return t > 0.05 + 0.18 * v->slack && t < 0.95 - 0.18 * v->slack && off < 0.45 - 0.25 * v->slack;
}

static int naive_place(const struct naive *v, enum parse_relation r, int i, const int *anchors)
{
	const struct synth_object *o = &v->w->objects[i], *a = &v->w->objects[anchors[0]];
	int sideways = r == PARSE_LEFT || r == PARSE_RIGHT;
	double ahead = amount(v, r, o, NULL) - amount(v, r, a, NULL);
	const double *across = sideways ? v->away : v->right;
	double aside = fabs(along(across, o) - along(across, a));

	switch (r) {
	case PARSE_NEAR:
		return distance(o, a) - o->radius - a->radius < 0.8 - 0.4 * v->slack;
	case PARSE_BETWEEN:
		return is_between(v, o, a, &v->w->objects[anchors[1]]);
	case PARSE_ON:
		return o->on == anchors[0];
	case PARSE_BELOW:
	case PARSE_SUPPORTS:
		return a->on == i;
	default:
		return ahead > 0.1 + 0.15 * v->slack && ahead > aside * (0.3 + 0.6 * v->slack);
	}
}

static int naive_side(const struct naive *v, enum parse_relation r, int i)
{
	const struct world *w = v->w;
	double half_u = fabs(v->right[0]) * w->table.half_width + fabs(v->right[1]) * w->table.half_depth;
	double half_v = fabs(v->away[0]) * w->table.half_width + fabs(v->away[1]) * w->table.half_depth;
	double x = along(v->right, &w->objects[i]) / half_u, y = along(v->away, &w->objects[i]) / half_v;

	if (r == PARSE_MIDDLE)
		return hypot(x, y) < 0.55 - 0.2 * v->slack;
	return (r == PARSE_LEFT		  ? -x
		       : r == PARSE_RIGHT ? x
		       : r == PARSE_FRONT ? -y
					  : y) > 0.1 + 0.2 * v->slack;
}

/* Whether the clause ranks what is left when all others have been looked at. */
static int is_rank(const struct synth_phrase *p, const struct synth_clause *c)
{
	return p->group ||
	       (c->is.degree != PARSE_PLAIN &&
		       !(c->is.relation >= PARSE_LARGER && c->is.relation <= PARSE_WIDER && c->anchor_count));
}

static int find_anchors(const struct naive *v, const struct synth_clause *c, int found[2])
{
	int n = 0;

	for (int k = 0; k < c->anchor_count; k++) {
		uint64_t set = v->x->phrases[c->anchors[k]].viewer ? 0 : naive_phrase(v, c->anchors[k]);
		for (int i = 0; i < v->w->n && n < 2; i++)
			if (set >> i & 1)
				found[n++] = i;
	}
	return n;
}

static int naive_clause(const struct naive *v, const struct synth_clause *c, int i)
{
	const struct synth_object *o = v->w->objects;
	int found[2] = {-1, -1}, n, is_true = 0;

	if (c->is.relation == PARSE_OTHER)
		return c->said->surely >> o[i].shape & 1;
	if (c->anchor_count && v->x->phrases[c->anchors[0]].is_anything) {
		for (int k = 0; k < v->w->n; k++)
			is_true |= o[k].on == i;
		return is_true != c->negated;
	}
	n = find_anchors(v, c, found);
	if (i == found[0] || i == found[1])
		return 0;
	if (n && c->is.degree == PARSE_MORE)
		is_true = amount(v, c->is.relation, &o[i], NULL) >
			  amount(v, c->is.relation, &o[found[0]], NULL);
	else
		is_true = n ? naive_place(v, c->is.relation, i, found) : naive_side(v, c->is.relation, i);
	return is_true != c->negated;
}

static uint64_t naive_rank(const struct naive *v, const struct synth_clause *c, uint64_t set)
{
	const struct synth_object *o = v->w->objects;
	int found[2] = {-1, -1}, best = -1, others[3], n = 0;

	find_anchors(v, c, found);
	for (int i = 0; i < v->w->n; i++) {
		if (!(set >> i & 1) || i == found[0])
			continue;
		const struct synth_object *a = found[0] < 0 ? NULL : &o[found[0]];
		if (best < 0 || amount(v, c->is.relation, &o[i], a) > amount(v, c->is.relation, &o[best], a))
			best = i;
		if (n < 3)
			others[n++] = i;
	}
	for (int k = 0; c->is.relation == PARSE_MIDDLE && k < n; k++)
		if (is_between(v, &o[others[k]], &o[others[(k + 1) % 3]], &o[others[(k + 2) % 3]]))
			best = others[k];
	return best < 0 ? 0 : (uint64_t)1 << best;
}

static uint64_t naive_ordinal(const struct naive *v, const struct synth_phrase *p, uint64_t set)
{
	for (int i = 0; i < v->w->n; i++) {
		int before = 0;
		for (int k = 0; k < v->w->n; k++)
			before += (set >> k & 1) && amount(v, p->from, &v->w->objects[k], NULL) >
							    amount(v, p->from, &v->w->objects[i], NULL);
		if ((set >> i & 1) && before == p->ordinal - 1)
			return (uint64_t)1 << i;
	}
	return 0;
}

static uint64_t naive_phrase(const struct naive *v, int phrase)
{
	const struct synth_phrase *p = &v->x->phrases[phrase];
	uint64_t set = 0;

	for (int i = 0; i < v->w->n; i++) {
		const struct synth_object *o = &v->w->objects[i];
		int fits = synth_sense_judge(&p->sense, o) > 0;
		for (int k = 0; k < p->clause_count && fits; k++)
			if (!is_rank(p, &v->x->clauses[p->clauses[k]]))
				fits = naive_clause(v, &v->x->clauses[p->clauses[k]], i);
		set |= (uint64_t)fits << i;
	}
	for (int k = 0; k < p->except_count; k++)
		set &= ~naive_phrase(v, p->except[k]);
	if (p->ordinal)
		set = naive_ordinal(v, p, set);
	uint64_t ranked = set;
	for (int k = 0; k < p->clause_count; k++)
		if (is_rank(p, &v->x->clauses[p->clauses[k]]))
			ranked &= naive_rank(v, &v->x->clauses[p->clauses[k]], set);
	for (int k = 0; k < p->also_count; k++)
		ranked |= naive_phrase(v, p->also[k]);
	return ranked;
}

static void camera_directions(const struct camera *c, double right[2], double away[2])
{
	double length = hypot(c->world_to_camera[2][0], c->world_to_camera[2][1]);

	away[0] = c->world_to_camera[2][0] / length;
	away[1] = c->world_to_camera[2][1] / length;
	right[0] = away[1];
	right[1] = -away[0];
}

static int size_of(uint64_t set)
{
	int n = 0;

	for (; set; set &= set - 1)
		n++;
	return n;
}

/* With the laxest and with the strictest thresholds each sentence means the same objects. */
static void means_the_same_to_everybody(const struct world *w)
{
	for (size_t i = 0; i < w->list.n; i++) {
		const struct synth_sentence *x = &w->list.items[i];
		for (int k = 0; k <= 4; k++) {
			struct naive v = {.w = w, .x = x, .slack = k / 4.0};
			if (x->view < 0)
				synth_cameras_reference(&w->cameras, (double[3]){0}, v.right, v.away);
			else
				camera_directions(&w->cameras.views[x->view], v.right, v.away);
			uint64_t set = naive_phrase(&v, 0);
			CHECK(set == x->objects, "'%s' at %g: %" PRIx64 ", not %" PRIx64, x->text, v.slack,
				set, x->objects);
		}
	}
}

/* Things that stand a little otherwise do not change what a sentence means: superlatives have a margin too.
 */
static void little_moves_do_not_matter(const struct world *w)
{
	struct world moved = *w;
	struct rng r;

	rng_seed(&r, 9, 9);
	for (int i = 0; i < w->n; i++) {
		moved.objects[i].x += rng_range(&r, -0.02, 0.02);
		moved.objects[i].y += rng_range(&r, -0.02, 0.02);
	}
	for (size_t i = 0; i < w->list.n; i++) {
		const struct synth_sentence *x = &w->list.items[i];
		struct naive v = {.w = &moved, .x = x, .slack = 0.5};
		if (x->view < 0)
			synth_cameras_reference(&w->cameras, (double[3]){0}, v.right, v.away);
		else
			camera_directions(&w->cameras.views[x->view], v.right, v.away);
		uint64_t set = naive_phrase(&v, 0);
		CHECK(set == x->objects, "'%s' of things that moved: %" PRIx64 ", not %" PRIx64, x->text, set,
			x->objects);
	}
}

static void kinds_are_what_they_say(const struct world *w)
{
	for (size_t i = 0; i < w->list.n; i++) {
		const struct synth_sentence *x = &w->list.items[i];
		int n = size_of(x->objects);
		CHECK(x->kind == SYNTH_UNSEEN_ABSENT	  ? n == 0
			: x->kind == SYNTH_UNSEEN_SEVERAL ? n > 1
							  : n == 1,
			"'%s' of kind %s means %d", x->text, synth_unseen_kind_name(x->kind), n);
		CHECK((x->kind == SYNTH_UNSEEN_VIEW) == (x->view >= 0), "'%s': view %d", x->text, x->view);
		CHECK(!strpbrk(x->text, "\"\\%") && !strstr(x->text, "  ") && strlen(x->text) > 2, "'%s'",
			x->text);
		if (x->kind == SYNTH_UNSEEN_VIEW && i + 1 < w->list.n && !strcmp(x->text, x[1].text))
			CHECK(x->objects != x[1].objects && x->view != x[1].view, "'%s' twice alike",
				x->text);
		for (size_t k = 0; k < i; k++)
			CHECK(strcmp(x->text, w->list.items[k].text) || x->view != w->list.items[k].view,
				"'%s' twice", x->text);
	}
}

/* Another order of the objects changes their numbers and nothing else. */
static void order_does_not_matter(const struct world *w)
{
	struct world other = *w;
	struct synth_viewpoint stand;
	double right[2], away[2], centre[3];

	for (int i = 0; i < w->n; i++) {
		other.objects[w->n - 1 - i] = w->objects[i];
		if (w->objects[i].on >= 0)
			other.objects[w->n - 1 - i].on = w->n - 1 - w->objects[i].on;
	}
	synth_cameras_reference(&w->cameras, centre, right, away);
	for (size_t i = 0; i < w->list.n; i++) {
		const struct synth_sentence *x = &w->list.items[i];
		uint64_t one, two, turned = 0;
		synth_viewpoint_make(&stand, w->objects, w->n, &w->table, centre, right, away, 1);
		int bad = synth_resolve(&stand, x, 0, 1, &one);
		synth_viewpoint_make(&stand, other.objects, w->n, &w->table, centre, right, away, 1);
		CHECK(bad == synth_resolve(&stand, x, 0, 1, &two), "'%s'", x->text);
		for (int k = 0; k < w->n; k++)
			turned |= (one >> k & 1) << (w->n - 1 - k);
		CHECK(bad || turned == two, "'%s': %" PRIx64 ", %" PRIx64, x->text, turned, two);
	}
}

/* In the mirror left is right: a sentence of left and right alone means the same with the words exchanged. */
static void mirror_exchanges_left_and_right(const struct world *w)
{
	struct world other = *w;
	struct synth_viewpoint stand, mirrored;
	const double right[2] = {1, 0}, away[2] = {0, 1}, centre[3] = {0, -9, 4};

	for (int i = 0; i < w->n; i++)
		other.objects[i].x = -w->objects[i].x;
	synth_viewpoint_make(&stand, w->objects, w->n, &w->table, centre, right, away, 1);
	synth_viewpoint_make(&mirrored, other.objects, w->n, &w->table, centre, right, away, 1);
	for (size_t i = 0; i < w->list.n; i++) {
		struct synth_sentence x = w->list.items[i];
		uint64_t one, two;
		int bad = synth_resolve(&stand, &x, 0, 1, &one);
		for (int k = 0; k < x.clause_count; k++)
			if (x.clauses[k].is.relation <= PARSE_RIGHT)
				x.clauses[k].is.relation =
					PARSE_LEFT + PARSE_RIGHT - x.clauses[k].is.relation;
		for (int k = 0; k < x.phrase_count; k++)
			if (x.phrases[k].ordinal && x.phrases[k].from <= PARSE_RIGHT)
				x.phrases[k].from = PARSE_LEFT + PARSE_RIGHT - x.phrases[k].from;
		CHECK(bad == synth_resolve(&mirrored, &x, 0, 1, &two) && (bad || one == two),
			"'%s': %" PRIx64 ", %" PRIx64, x.text, one, two);
	}
}

static void same_seed_says_the_same(const struct world *w, int number, uint64_t seed)
{
	struct world again;

	if (!world_make(&again, number, seed))
		return;
	CHECK(again.list.n == w->list.n, "%zu, %zu sentences", again.list.n, w->list.n);
	for (size_t i = 0; i < w->list.n && i < again.list.n; i++)
		CHECK(!strcmp(w->list.items[i].text, again.list.items[i].text), "'%s'",
			w->list.items[i].text);
	world_free(&again);
}

int main(void)
{
	int counts[SYNTH_UNSEEN_KINDS] = {0};

	for (int number = 0; number < SYNTH_PRESETS; number++)
		for (uint64_t seed = 1; seed <= SEEDS; seed++) {
			struct world w;
			if (!world_make(&w, number, seed))
				continue;
			means_the_same_to_everybody(&w);
			little_moves_do_not_matter(&w);
			kinds_are_what_they_say(&w);
			order_does_not_matter(&w);
			mirror_exchanges_left_and_right(&w);
			if (seed == 1)
				same_seed_says_the_same(&w, number, seed);
			for (size_t i = 0; i < w.list.n; i++)
				counts[w.list.items[i].kind]++;
			world_free(&w);
		}
	for (int k = 0; k < SYNTH_UNSEEN_KINDS; k++)
		CHECK(counts[k] > 10 * SEEDS, "%s: %d", synth_unseen_kind_name(k), counts[k]);
	return unit_end();
}
