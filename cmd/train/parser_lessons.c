#include "cmd/train/parser_lessons.h"

#include "base/file.h"
#include "base/mem.h"
#include "base/rng.h"
#include "formats/records/jsonl.h"
#include "formats/records/parses.h"
#include "formats/scene/text.h"
#include "lang/examples.h"
#include "lang/marked.h"

#include <stdio.h>
#include <string.h>

/* A sentence to encode. */
static int put_record(
	FILE *out, char kind, long long number, const char *text, const char *split, struct err *e)
{
	fprintf(out, "{\"ref\":\"%c%lld\",\"object\":\"example\"", kind, number);
	int bad = jsonl_put_string(out, ",\"text\":", text, e);
	fprintf(out, ",\"split\":\"%s\"}\n", split);
	return bad;
}

int parser_examples_write(const char *path, long long n, int is_test, long long seed, struct err *e)
{
	struct file_out out = {0};
	struct rng r;
	int bad = file_out_open(&out, path, e);
	static struct example x;

	rng_seed(&r, (uint64_t)seed, (uint64_t)is_test);
	for (long long i = 0; i < n && !bad; i++) {
		example_make(&x, is_test ? EXAMPLES_TEST : EXAMPLES_TRAIN, NULL, &r);
		bad = put_record(out.stream, 'e', i, x.text, is_test ? "test" : "train", e);
	}
	return file_out_end(&out, bad, e);
}

const float *lesson_vectors(const struct text *t, size_t r, int *count)
{
	*count = (int)(t->offsets[r + 1] - t->offsets[r]);
	return text_middle(t, r);
}

/* The sentence at this place was encoded from that text. */
static int is_sentence(const struct text *t, size_t i, const char *sentence)
{
	return i < t->n && t->pieces && !strcmp(t->texts[i], sentence);
}

int parser_examples_take(
	struct parser_school *c, const struct text *text, const char *path, long long seed, struct err *e)
{
	static struct example x;
	struct rng r;

	rng_seed(&r, (uint64_t)seed, 0);
	c->examples = mem_zalloc(text->n, sizeof *c->examples, "samples", e);
	if (!c->examples)
		return -1;
	c->example_count = text->n;
	for (size_t i = 0; i < text->n; i++) {
		int count;
		const float *v = lesson_vectors(text, i, &count);
		example_make(&x, EXAMPLES_TRAIN, text->pieces ? text->pieces[i] : NULL, &r);
		if (!is_sentence(text, i, x.text))
			return err_set(e, ERR_FORMAT,
				"%s: ref '%s': not what parse-train --write makes with --seed %lld", path,
				text->refs[i], seed);
		if (parser_sample_make(&c->examples[i], &x.tokens, &x.analysis, v, count, text->width, e))
			return -1;
	}
	return 0;
}

/* Does something with each marked sentence of a file, its analysis and its number; 0 or -1 with *e. */
static int each_marked(const char *path, const struct text *text,
	int (*with)(void *context, const struct marked *m, const struct tokens *t, const struct analysis *a,
		size_t i, struct err *e),
	void *context, struct err *e)
{
	static struct marked m;
	static struct tokens t;
	static struct analysis a;
	struct jsonl j;
	int got, bad = 0;

	if (jsonl_open(&j, path, e))
		return -1;
	for (size_t i = 0; !bad && (got = jsonl_text(&j, e)) > 0;) {
		struct err why = {0};
		if (j.line[strspn(j.line, " \t")] == '#')
			continue;
		bad = marked_take(&m, j.line, &why);
		if (!bad && text && !is_sentence(text, i, m.text))
			bad = err_set(&why, ERR_FORMAT, "not the sentence that was encoded at its place");
		if (!bad) {
			tokens_take(&t, m.text, text ? text->pieces[i] : NULL, NULL, 0);
			bad = marked_analyse(&m, &t, &a, &why);
		}
		if (bad)
			jsonl_err(&j, e, "%s", why.message);
		else
			bad = with(context, &m, &t, &a, i++, e);
	}
	jsonl_close(&j);
	return bad || got < 0 ? -1 : 0;
}

static int put_sentence(void *out, const struct marked *m, const struct tokens *t, const struct analysis *a,
	size_t i, struct err *e)
{
	(void)t, (void)a;
	return put_record(out, 'm', (long long)i, m->text, "train", e);
}

static int put_parse(void *out, const struct marked *m, const struct tokens *t, const struct analysis *a,
	size_t i, struct err *e)
{
	struct parse p = {0};
	char ref[32];

	snprintf(ref, sizeof ref, "m%zu", i);
	int bad = parse_build(&p, a, t, e) || parses_put(out, ref, m->text, &p, e);
	parse_free(&p);
	return bad ? -1 : 0;
}

int parser_marked_write(
	const char *path, const char *encoded, int is_parses, const char *output, struct err *e)
{
	struct text text = {0};
	struct file_out out = {0};
	int bad = (encoded && text_read(&text, encoded, e)) || file_out_open(&out, output, e);

	bad = bad ||
	      each_marked(path, encoded ? &text : NULL, is_parses ? put_parse : put_sentence, out.stream, e);
	text_free(&text);
	return file_out_end(&out, bad, e);
}

struct taking {
	struct parser_school *school;
	const struct text *text;
};

static int take(void *context, const struct marked *m, const struct tokens *t, const struct analysis *a,
	size_t i, struct err *e)
{
	const struct taking *to = context;
	int count;
	const float *v = lesson_vectors(to->text, i, &count);

	(void)m;
	to->school->marked_count = i + 1;
	return parser_sample_make(&to->school->marked[i], t, a, v, count, to->text->width, e);
}

int parser_marked_take(struct parser_school *c, const char *path, const struct text *text,
	const char *encoded, struct err *e)
{
	struct taking to = {c, text};

	c->marked = mem_zalloc(text->n, sizeof *c->marked, "samples", e);
	if (!c->marked || each_marked(path, text, take, &to, e))
		return -1;
	if (c->marked_count < text->n)
		return err_set(e, ERR_FORMAT, "%s: ref '%s': not in %s", encoded, text->refs[c->marked_count],
			file_name(path));
	return 0;
}
