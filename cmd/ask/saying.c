/* The lifted choice is asked twice: first of which things each relation holds, so that most of what is put
 * together is true, and then what each sentence means, which decides. */
#include "cmd/ask/saying.h"

#include "base/file.h"
#include "base/jsontext.h"
#include "base/mem.h"
#include "cmd/ask/saying_parts.h"
#include "synth/wordings.h"

#include <math.h>
#include <stdio.h>

/* TRIES: drafts for a sentence that is kept. */
enum { LENGTH = 256, AT_ONCE = 64, TRIES = 20, FACT_TRIES = 60, STREAM_SAY = 7 };

/* A relation surely holds, may hold, and surely does not. */
static const double sure = 0.5, likely = 0.4, unlikely = 0.1;

/* A relation to other objects. */
struct fact {
	const struct synth_row *kind;
	size_t anchors[2]; /* the number of objects: none */
};

struct saying {
	struct asking *asking;
	const struct saying_options *options;
	size_t objects;
	struct saying_parts parts;
	struct synth_wordings wordings;
	struct fact *facts; /* (fact_count) */
	double *holds;	    /* (fact_count, objects) */
	size_t fact_count, fact_room, holds_room;
	struct rng rng;
	size_t *kept, *tried; /* (objects) */
	struct said {	      /* those that were kept */
		size_t n, capacity;
		char (*items)[LENGTH];
	} done;
};

static void saying_free(struct saying *s)
{
	saying_parts_free(&s->parts);
	synth_wordings_free(&s->wordings);
	mem_free_all(s->facts, s->holds, s->kept, s->tried, s->done.items);
}

static int is_likely(struct saying *s, uint32_t in_hundred)
{
	return rng_below(&s->rng, 100) < in_hundred;
}

/* A sentence in the making. */
struct draft {
	char text[LENGTH];
	size_t n;
};

static void put(struct draft *d, const char *text)
{
	const int more = snprintf(d->text + d->n, LENGTH - d->n, "%s%s", d->n ? " " : "", text);

	d->n = d->n + (size_t)more < LENGTH ? d->n + (size_t)more : LENGTH - 1;
}

static const char *draw_part(struct saying *s, size_t object, enum saying_part kind)
{
	return saying_parts_draw(&s->parts, object, kind, &s->rng);
}

/* "small red mug": what it is called, with one look in `looks` of a hundred, and more seldom two. */
static void put_name(struct saying *s, struct draft *d, size_t object, uint32_t looks)
{
	const char *known = is_likely(s, 30) ? draw_part(s, object, SAYING_SYNONYM) : NULL,
		   *noun = known ? known : draw_part(s, object, SAYING_NOUN), *first = NULL;

	for (int i = 0; i < 2 && is_likely(s, looks); i++) {
		const char *look = draw_part(s, object, SAYING_LOOK);
		if (look && look != first)
			put(d, first = look);
	}
	put(d, noun ? noun : s->asking->model.lifted.names[object]);
}

static const struct fact *draw_fact(struct saying *s, size_t object, int is_true);

/* "left of the plate", in any wording, with names of the anchors in place of %A and %B; depth: what is true
 * of an anchor is said too. */
static void put_fact(struct saying *s, struct draft *d, const struct fact *f, int depth)
{
	const struct synth_query q = {.list = SYNTH_SAID, .like = f->kind};
	const char *t = synth_draw(&s->wordings, &q, &s->rng)->text;
	char part[LENGTH];

	for (const char *slot; (slot = strchr(t, '%')); t = slot + 2) {
		const size_t anchor = f->anchors[slot[1] == 'B'];
		t += *t == ' ';
		snprintf(part, sizeof part, "%.*s", slot > t ? (int)(slot - t - 1) : 0, t);
		if (*part)
			put(d, part);
		put(d, "the");
		put_name(s, d, anchor, 30);
		const struct fact *own = depth ? draw_fact(s, anchor, 1) : NULL;
		if (own) {
			put(d, "that is");
			put_fact(s, d, own, 0);
		}
	}
	if (*t)
		put(d, t + (*t == ' '));
}

/* A random relation that holds of an object, or plainly does not; NULL where none was met. */
static const struct fact *draw_fact(struct saying *s, size_t object, int is_true)
{
	for (int i = 0; i < FACT_TRIES && s->fact_count; i++) {
		const struct fact *f = &s->facts[rng_below(&s->rng, (uint32_t)s->fact_count)];
		const double holds = s->holds[(size_t)(f - s->facts) * s->objects + object];
		if (object != f->anchors[0] && object != f->anchors[1] &&
			(is_true ? holds > sure : holds < unlikely))
			return f;
	}
	return NULL;
}

/* Of relations of a kind: to each object, to as many pairs, or to none. */
static int learn_kind(struct saying *s, const struct synth_row *kind, struct err *e)
{
	const size_t n = kind->anchors < 1 ? 1
			 : s->objects > 1  ? s->objects
					   : 0,
		     before = s->fact_count, none = s->objects;
	SCOPED struct draft *drafts = mem_zalloc(n, sizeof *drafts, "sentences", e);
	SCOPED const char **texts = mem_alloc(n, sizeof *texts, "sentences", e);
	int bad = !drafts || !texts ||
		  mem_grow((void **)&s->facts, &s->fact_room, before + n, sizeof *s->facts, "relations", e) ||
		  mem_grow((void **)&s->holds, &s->holds_room, (before + n) * s->objects, sizeof *s->holds,
			  "relations", e);

	for (size_t k = 0; k < n && !bad; k++) {
		const size_t other = n > 1 ? (k + 1 + rng_below(&s->rng, (uint32_t)n - 1)) % n : none;
		s->facts[before + k] =
			(struct fact){kind, {kind->anchors > 0 ? k : none, kind->anchors > 1 ? other : none}};
		put(&drafts[k], "the thing");
		put_fact(s, &drafts[k], &s->facts[before + k], 0);
		texts[k] = drafts[k].text;
	}
	if (!bad)
		asking_expect(s->asking, texts, n);
	for (size_t k = 0; k < n && !bad; k++) {
		SCOPED_BY(asking_answer_free) struct asking_answer answer = {0};
		bad = asking_ask(s->asking, texts[k], 0, &answer, &report_silent, e);
		if (!bad)
			memcpy(s->holds + (before + k) * s->objects, answer.holds,
				s->objects * sizeof *s->holds);
	}
	s->fact_count = before + n;
	return bad;
}

static int saying_make(struct saying *s, struct err *e)
{
	s->objects = s->asking->model.lifted.objects;
	s->kept = mem_zalloc(s->objects, sizeof *s->kept, "sentences", e);
	s->tried = mem_zalloc(s->objects, sizeof *s->tried, "sentences", e);
	int bad = !s->kept || !s->tried || saying_parts_read(&s->parts, s->asking, e) ||
		  synth_wordings_load(&s->wordings, 0, e);
	rng_seed(&s->rng, s->options->seed, STREAM_SAY);
	for (int i = 0; i < s->wordings.n && !bad; i++)
		if (s->wordings.rows[i].list == SYNTH_RELATIONS && s->wordings.rows[i].form == 'R')
			bad = learn_kind(s, &s->wordings.rows[i], e);
	return bad;
}

/* "leftmost" */
static void put_ranking(struct saying *s, struct draft *d)
{
	const struct synth_query q = {.list = SYNTH_SAID, .forms = "c"};
	const struct synth_row *row = synth_draw(&s->wordings, &q, &s->rng);

	put(d, row->text);
}

/* Whether relations together hold of that object alone. */
static int tell(const struct saying *s, const struct fact *const *facts, int n, size_t object)
{
	for (size_t o = 0; o < s->objects; o++) {
		double least = 1;
		for (int k = 0; k < n; k++)
			least = fmin(
				least, o == facts[k]->anchors[0] || o == facts[k]->anchors[1]
					       ? 0
					       : s->holds[(size_t)(facts[k] - s->facts) * s->objects + o]);
		if (o != object && least > likely)
			return 0;
	}
	return 1;
}

/* "the thing left of the plate and behind the mug": -1 where a few tries find nothing that tells it. */
static int put_relations(struct saying *s, struct draft *d, size_t object)
{
	static const char *const things[] = {"the thing", "the object", "the item"};
	const struct fact *facts[2];
	int n = 1 + is_likely(s, 50);

	for (int i = 0; i < FACT_TRIES; i++) {
		for (int k = 0; k < n; k++)
			if (!(facts[k] = draw_fact(s, object, 1)))
				return -1;
		if (!tell(s, facts, n, object))
			continue;
		put(d, things[rng_below(&s->rng, 3)]);
		for (int k = 0; k < n; k++) {
			if (k)
				put(d, "and");
			put_fact(s, d, facts[k], is_likely(s, 10));
		}
		return 0;
	}
	return -1;
}

/* A random sentence, which names the object or tells where it is. */
static void make_draft(struct saying *s, struct draft *d, size_t object)
{
	static const char *const copulas[] = {"", "", "that is", "which is", "standing", "lying"};
	const struct fact *f;

	*d = (struct draft){0};
	if (is_likely(s, 45) && !put_relations(s, d, object))
		return;
	put(d, "the");
	if (is_likely(s, 10))
		put_ranking(s, d);
	put_name(s, d, object, 60);
	const char *has = is_likely(s, 20) ? draw_part(s, object, SAYING_HAVING) : NULL;
	if (has)
		put(d, has);
	const int is_denied = is_likely(s, 8);
	if (is_likely(s, 65) && (f = draw_fact(s, object, !is_denied))) {
		const char *copula = is_denied ? "that is not" : copulas[rng_below(&s->rng, 6)];
		if (*copula)
			put(d, copula);
		put_fact(s, d, f, is_likely(s, 12));
	}
}

static int is_new(const struct saying *s, const char *text)
{
	for (size_t i = 0; i < s->done.n; i++)
		if (!strcmp(s->done.items[i], text))
			return 0;
	return 1;
}

/* Keeps a sentence that surely means the object, of which there are too few so far. */
static int keep(struct saying *s, FILE *out, const struct draft *d, size_t object, struct err *e)
{
	SCOPED_BY(asking_answer_free) struct asking_answer answer = {0};
	const struct lifted *l = &s->asking->model.lifted;
	char ref[32];

	if (asking_ask(s->asking, d->text, 0, &answer, &report_silent, e))
		return -1;
	if (answer.count != 1 || answer.things[0] != object ||
		answer.probability[object] < s->options->least || answer.holds[object] < sure ||
		(long long)s->kept[object] >= s->options->each || !is_new(s, d->text))
		return 0;
	if (mem_grow((void **)&s->done.items, &s->done.capacity, s->done.n + 1, sizeof *s->done.items,
		    "sentences", e))
		return -1;
	memcpy(s->done.items[s->done.n++], d->text, LENGTH);
	s->kept[object]++;
	snprintf(ref, sizeof ref, "said-%zu", s->done.n);
	struct jsontext json = {.out = out};
	jsontext_open(&json, NULL, '{');
	jsontext_string(&json, "ref", ref);
	jsontext_string(&json, "object", l->names[object]);
	jsontext_string(&json, "text", d->text);
	jsontext_string(&json, "split", "train");
	jsontext_close(&json, '}');
	fputc('\n', out);
	return 0;
}

/* An object that has too few sentences, and may get more; the objects take turns. */
static size_t find_next(const struct saying *s, size_t last)
{
	for (size_t k = 1; k <= s->objects; k++) {
		const size_t o = (last + k) % s->objects, each = (size_t)s->options->each;
		if (s->kept[o] < each && s->tried[o] < TRIES * each)
			return o;
	}
	return s->objects;
}

/* As many drafts as are encoded at once. */
static int say_some(struct saying *s, FILE *out, size_t *next, struct err *e)
{
	struct draft drafts[AT_ONCE];
	const char *texts[AT_ONCE];
	size_t of[AT_ONCE], n = 0;

	for (; n < AT_ONCE && *next < s->objects; *next = find_next(s, *next)) {
		of[n] = *next;
		s->tried[*next]++;
		make_draft(s, &drafts[n], *next);
		texts[n] = drafts[n].text;
		n++;
	}
	asking_expect(s->asking, texts, n);
	for (size_t i = 0; i < n; i++)
		if (keep(s, out, &drafts[i], of[i], e))
			return -1;
	*next = *next < s->objects ? find_next(s, *next) : *next;
	return 0;
}

static int say_all(struct saying *s, FILE *out, const struct report *to, size_t *short_of, struct err *e)
{
	const size_t wanted = s->objects * (size_t)s->options->each;
	size_t next = 0, tried = 0;
	int bad = 0;

	report_start(to, "sentences", (double)wanted);
	while (next < s->objects && !bad) {
		bad = say_some(s, out, &next, e);
		report_step(to, (double)s->done.n, NULL);
	}
	report_end(to);
	for (size_t o = 0; o < s->objects; o++)
		tried += s->tried[o];
	report_note(to, 1, "%zu of %zu sentences that were tried are kept", s->done.n, tried);
	*short_of = wanted - s->done.n;
	return bad;
}

int say(struct asking *a, const struct saying_options *o, const struct report *to, size_t *short_of,
	struct err *e)
{
	SCOPED_BY(saying_free) struct saying s = {.asking = a, .options = o};
	struct file_out out;

	if (!a->model.lifted.objects)
		return err_set(e, ERR_FORMAT, "%s: has no objects to say anything of", a->files.model);
	if (saying_make(&s, e) || file_out_open(&out, o->output, e))
		return -1;
	return file_out_end(&out, say_all(&s, out.stream, to, short_of, e), e);
}
