#include "cmd/train/parser_training.h"

#include "base/file.h"
#include "base/mem.h"
#include "formats/encoders/parser_weights.h"
#include "formats/records/jsonl.h"
#include "formats/records/parses.h"
#include "formats/scene/text.h"
#include "lang/marked.h"
#include "lang/parser_learn.h"

#include <stdio.h>

/* A marked sentence, with what its marks say of its words. */
struct marked_sentence {
	size_t number;
	struct marked marked;
	struct tokens tokens;
	struct analysis analysis;
};

/* Does something with each marked sentence of a file; 0 or -1 with *e. text: the same sentences, or NULL. */
static int each_marked(const char *path, const struct text *text,
	int (*with)(void *context, const struct marked_sentence *s, struct err *e), void *context,
	struct err *e)
{
	static struct marked_sentence s;
	SCOPED_BY(jsonl_close) struct jsonl j = {0};
	int got, bad = 0;

	if (jsonl_open(&j, path, e))
		return -1;
	for (s.number = 0; !bad && (got = jsonl_text(&j, e)) > 0;) {
		const size_t i = s.number;
		struct err why = {0};
		if (j.line[strspn(j.line, " \t")] == '#')
			continue;
		bad = marked_take(&s.marked, j.line, &why);
		if (!bad && text && (i >= text->n || !text->pieces || strcmp(text->texts[i], s.marked.text)))
			bad = err_set(&why, ERR_FORMAT, "not the sentence that was encoded at its place");
		if (!bad) {
			tokens_take(&s.tokens, s.marked.text, text ? text->pieces[i] : NULL, NULL, 0);
			bad = marked_analyse(&s.marked, &s.tokens, &s.analysis, &why);
		}
		if (bad)
			jsonl_err(&j, e, "%s", why.message);
		else
			bad = with(context, &s, e);
		s.number++;
	}
	return bad || got < 0 ? -1 : 0;
}

static int put_sentence(void *out, const struct marked_sentence *s, struct err *e)
{
	(void)e;
	fprintf(out, "{\"ref\":\"m%zu\",\"object\":\"example\"", s->number);
	jsonl_put_string(out, ",\"text\":", s->marked.text);
	fprintf(out, ",\"split\":\"train\"}\n");
	return 0;
}

static int put_parse(void *out, const struct marked_sentence *s, struct err *e)
{
	SCOPED_BY(parse_free) struct parse p = {0};
	char ref[32];

	snprintf(ref, sizeof ref, "m%zu", s->number);
	return parse_build(&p, &s->analysis, &s->tokens, 0, e) || parses_put(out, ref, s->marked.text, &p, e);
}

int parser_marked_write(
	const char *marked, const char *encoded, int is_parses, const char *output, struct err *e)
{
	SCOPED_BY(text_free) struct text text = {0};
	struct file_out out = {0};
	int bad = (encoded && text_read(&text, encoded, e)) || file_out_open(&out, output, e);

	bad = bad || each_marked(marked, encoded ? &text : NULL, is_parses ? put_parse : put_sentence,
			     out.stream, e);
	return file_out_end(&out, bad, e);
}

struct taking {
	struct text text;
	struct parser_sample *samples; /* (text.n) */
	size_t count;
};

static void taking_free(struct taking *t)
{
	for (size_t i = 0; i < t->count; i++)
		parser_sample_free(&t->samples[i]);
	free(t->samples);
	text_free(&t->text);
}

static int take(void *context, const struct marked_sentence *s, struct err *e)
{
	struct taking *to = context;
	const int64_t *at = &to->text.offsets[s->number];

	to->count = s->number + 1;
	return parser_sample_make(&to->samples[s->number], &s->tokens, &s->analysis,
		text_middle(&to->text, s->number), (int)(at[1] - at[0]), to->text.width, e);
}

static int take_samples(struct taking *to, const struct parser_training_options *o, struct err *e)
{
	if (text_read(&to->text, o->text, e))
		return -1;
	if (!to->text.middle)
		return err_set(e, ERR_FORMAT, "%s: tensor 'middle' is missing", o->text);
	to->samples = mem_zalloc(to->text.n, sizeof *to->samples, "samples", e);
	if (!to->samples || each_marked(o->marked, &to->text, take, to, e))
		return -1;
	if (to->count < to->text.n)
		return err_set(e, ERR_FORMAT, "%s: ref '%s': not in %s", o->text, to->text.refs[to->count],
			file_name(o->marked));
	return 0;
}

static void say(void *context, int member, int epoch, double loss)
{
#pragma omp critical
	report_note(context, 1, "network %d, epoch %d: loss %.4f", member + 1, epoch + 1, loss);
}

/* Networks of zeros, as many as are asked for, and that of grammar alone. */
static int make_members(struct parser_weights *w, int width, long long members, struct err *e)
{
	int bad = parser_weights_make(w, width, e) || parser_weights_add(&w->grammar, 0, e);

	for (long long k = 1; k < members && !bad; k++, w = w->next)
		bad = parser_weights_add(&w->next, width, e);
	return bad;
}

int parser_train(const struct parser_training_options *o, const struct report *to, struct err *e)
{
	SCOPED_BY(taking_free) struct taking t = {0};
	SCOPED_BY(parser_weights_free) struct parser_weights w = {0};

	if (take_samples(&t, o, e) || make_members(&w, t.text.width, o->members, e))
		return -1;
	const struct parser_learning learning = {.samples = t.samples,
		.sample_count = t.count,
		.epochs = (int)o->epochs,
		.seed = (unsigned long long)o->seed,
		.progress = say,
		.context = (void *)to};
	if (parser_learn(&learning, &w, e))
		return -1;
	memcpy(w.encoder, t.text.encoder.hex, sizeof w.encoder);
	return parser_weights_write(&w, o->output, o->seed, o->source, e);
}
