/* The lifted choice is asked twice: first of which things each relation holds (saying_drafts.c), so that most
 * of what is put together is true, and then what each sentence means, which decides. */
#include "cmd/ask/saying.h"

#include "base/file.h"
#include "base/jsontext.h"
#include "base/mem.h"
#include "cmd/ask/saying_drafts.h"

#include <stdio.h>

/* TRIES: drafts for a sentence that is kept. */
enum { AT_ONCE = 64, TRIES = 20 };
#define NONE ((size_t)-1)

/* What is said of a thing surely holds of it. */
static const double sure = 0.5;

struct saying {
	struct asking *asking;
	const struct saying_options *options;
	struct drafter drafter;
	size_t objects, *kept, *tried; /* (objects + 1), the last of what is not here */
	struct said {		       /* those that were kept */
		size_t n, capacity;
		char (*items)[SAYING_LENGTH];
	} done;
};

static void saying_free(struct saying *s)
{
	drafter_free(&s->drafter);
	mem_free_all(s->kept, s->tried, s->done.items);
}

static int saying_make(struct saying *s, struct err *e)
{
	s->objects = s->asking->model.lifted.objects;
	s->kept = mem_zalloc(s->objects + 1, sizeof *s->kept, "sentences", e);
	s->tried = mem_zalloc(s->objects + 1, sizeof *s->tried, "sentences", e);
	return -(!s->kept || !s->tried || drafter_make(&s->drafter, s->asking, s->options->seed, e));
}

static int is_new(const struct saying *s, const char *text)
{
	for (size_t i = 0; i < s->done.n; i++)
		if (!strcmp(s->done.items[i], text))
			return 0;
	return 1;
}

/* How many sentences an object gets. */
static size_t count_wanted(const struct saying *s, size_t object)
{
	return (size_t)(object == s->objects ? s->options->absent : s->options->each);
}

/* Whether an answer surely is the object, or surely nothing. */
static int is_sure(const struct saying *s, const struct asking_answer *answer, size_t object)
{
	if (object == s->objects)
		return 1 - answer->there >= s->options->least;
	return answer->count == 1 && answer->things[0] == object &&
	       answer->probability[object] >= s->options->least && answer->holds[object] >= sure;
}

/* Keeps a sentence that surely means the object, of which there are too few so far. */
static int keep(struct saying *s, FILE *out, const struct draft *d, size_t object, struct err *e)
{
	SCOPED_BY(asking_answer_free) struct asking_answer answer = {0};
	const struct lifted *l = &s->asking->model.lifted;
	char ref[32];

	if (s->kept[object] >= count_wanted(s, object) || !is_new(s, d->text))
		return 0;
	if (asking_ask(s->asking, d->text, 0, &answer, &report_silent, e))
		return -1;
	if (!is_sure(s, &answer, object))
		return 0;
	if (mem_grow((void **)&s->done.items, &s->done.capacity, s->done.n + 1, sizeof *s->done.items,
		    "sentences", e))
		return -1;
	memcpy(s->done.items[s->done.n++], d->text, SAYING_LENGTH);
	s->kept[object]++;
	snprintf(ref, sizeof ref, "said-%zu", s->done.n);
	struct jsontext json = {.out = out};
	jsontext_open(&json, NULL, '{');
	jsontext_string(&json, "ref", ref);
	if (object < s->objects)
		jsontext_string(&json, "object", l->names[object]);
	else
		jsontext_raw(&json, "objects", "[]");
	jsontext_string(&json, "text", d->text);
	jsontext_string(&json, "split", "train");
	jsontext_close(&json, '}');
	fputc('\n', out);
	return 0;
}

/* An object that has too few sentences, and may get more; the objects take turns. */
static size_t find_next(const struct saying *s, size_t last)
{
	for (size_t k = 1; k <= s->objects + 1; k++) {
		const size_t o = (last + k) % (s->objects + 1), wanted = count_wanted(s, o);
		if (s->kept[o] < wanted && s->tried[o] < TRIES * wanted)
			return o;
	}
	return NONE;
}

/* As many drafts as are encoded at once. */
static int say_some(struct saying *s, FILE *out, size_t *next, struct err *e)
{
	struct draft drafts[AT_ONCE];
	const char *texts[AT_ONCE];
	size_t of[AT_ONCE], n = 0;

	for (; n < AT_ONCE && *next != NONE; *next = find_next(s, *next)) {
		of[n] = *next;
		s->tried[*next]++;
		drafter_draw(&s->drafter, *next, &drafts[n]);
		texts[n] = drafts[n].text;
		n++;
	}
	asking_expect(s->asking, texts, n);
	for (size_t i = 0; i < n; i++)
		if (keep(s, out, &drafts[i], of[i], e))
			return -1;
	*next = *next != NONE ? find_next(s, *next) : *next;
	return 0;
}

static int say_all(struct saying *s, FILE *out, const struct report *to, size_t *short_of, struct err *e)
{
	const size_t wanted = s->objects * count_wanted(s, 0) + count_wanted(s, s->objects);
	size_t next = find_next(s, s->objects), tried = 0;
	int bad = 0;

	report_start(to, "sentences", (double)wanted);
	while (next != NONE && !bad) {
		bad = say_some(s, out, &next, e);
		report_step(to, (double)s->done.n, NULL);
	}
	report_end(to);
	for (size_t o = 0; o <= s->objects; o++)
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
