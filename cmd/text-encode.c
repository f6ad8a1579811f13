/* Sentences to word vectors, by a BERT encoder. */
#include "base/mem.h"
#include "base/path.h"
#include "cli/cli.h"
#include "formats/bert_model.h"
#include "formats/sentences.h"
#include "formats/text.h"
#include "formats/vocab.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Tokens in one forward pass: enough to keep the products busy, little memory. */
enum { ROWS_AT_ONCE = 1024 };

/* In the order of the choices of --words. */
enum words { CONTEXTUAL, STATIC };

/* All sentences as token ids, [CLS] and [SEP] included. */
struct tokens {
	struct wordpieces pieces;
	size_t *starts; /* (n+1) */
};

static void tokens_free(struct tokens *t)
{
	free(t->pieces.ids);
	free(t->starts);
}

static int add_special(struct tokens *t, const struct vocab *v, enum wordpiece_special which, struct err *e)
{
	struct wordpieces *p = &t->pieces;

	if (mem_grow((void **)&p->ids, &p->capacity, p->n + 1, sizeof *p->ids, "word pieces", e))
		return -1;
	p->ids[p->n++] = v->special[which];
	return 0;
}

static int tokenise(const struct cli *c, struct tokens *t, const struct sentences *s, const struct vocab *v,
	size_t positions, struct err *e)
{
	t->starts = mem_alloc(s->n + 1, sizeof *t->starts, "sentences", e);
	if (!t->starts)
		return -1;
	for (size_t i = 0; i < s->n; i++) {
		t->starts[i] = t->pieces.n;
		if (add_special(t, v, WORDPIECE_CLS, e) ||
			wordpiece_encode(v, s->items[i].text, &t->pieces, e))
			return -1;
		size_t words = t->pieces.n - t->starts[i] - 1;
		if (words > positions - 2) {
			cli_warn(c, "ref '%s': %zu word pieces, cut to the %zu that the encoder takes",
				s->items[i].ref, words, positions - 2);
			t->pieces.n = t->starts[i] + positions - 1;
		}
		if (add_special(t, v, WORDPIECE_SEP, e))
			return -1;
	}
	t->starts[s->n] = t->pieces.n;
	return 0;
}

/* Ids index the embedding, so none may lie past it. */
static int check_vocab(const struct vocab *v, const struct bert *b, const char *dir, struct err *e)
{
	for (size_t i = 0; i < v->n; i++)
		if (v->entries[i].id >= b->words)
			return err_set(e, ERR_FORMAT, "%s: token '%s' has id %d, but vocab_size is %d", dir,
				v->entries[i].token, v->entries[i].id, b->words);
	return 0;
}

/* Room for everything but the sentences' names, which are borrowed. */
static int alloc_text(
	struct text *out, const struct sentences *s, const struct tokens *t, int width, struct err *e)
{
	size_t n = s->n;

	*out = (struct text){.n = n, .width = width};
	out->offsets = mem_alloc(n + 1, sizeof *out->offsets, "offsets", e);
	out->refs = mem_alloc(n, sizeof *out->refs, "refs", e);
	out->objects = mem_alloc(n, sizeof *out->objects, "objects", e);
	out->texts = mem_alloc(n, sizeof *out->texts, "texts", e);
	out->splits = mem_alloc(n, sizeof *out->splits, "splits", e);
	if (!out->offsets || !out->refs || !out->objects || !out->texts || !out->splits)
		return -1;
	for (size_t i = 0; i <= n; i++)
		out->offsets[i] = (int64_t)(t->starts[i] - 2 * i);
	for (size_t i = 0; i < n; i++) {
		out->refs[i] = s->items[i].ref;
		out->objects[i] = s->items[i].object;
		out->texts[i] = s->items[i].text;
		out->splits[i] = s->items[i].split;
	}
	out->words = mem_alloc((size_t)out->offsets[n], sizeof *out->words * (size_t)width, "words", e);
	out->sentences = mem_zalloc(n, sizeof *out->sentences * (size_t)width, "sentence vectors", e);
	return out->words && out->sentences ? 0 : -1;
}

static int keep_pieces(struct text *out, const struct tokens *t, const struct vocab *v, struct err *e)
{
	out->pieces = mem_zalloc(out->n, sizeof *out->pieces, "pieces", e);
	if (!out->pieces)
		return -1;
	for (size_t i = 0; i < out->n; i++) {
		out->pieces[i] = vocab_print(
			v, t->pieces.ids + t->starts[i] + 1, t->starts[i + 1] - t->starts[i] - 2, e);
		if (!out->pieces[i])
			return -1;
	}
	return 0;
}

static void free_text(struct text *out)
{
	for (size_t i = 0; out->pieces && i < out->n; i++)
		free(out->pieces[i]);
	text_free_more(out);
	free(out->pieces);
	free(out->offsets);
	free(out->refs);
	free(out->objects);
	free(out->texts);
	free(out->splits);
	free(out->words);
	free(out->sentences);
}

/* The sentences from `first` on that one pass takes: at least one, at most ROWS_AT_ONCE tokens if there are
 * more. */
static size_t pass_end(const size_t *starts, size_t first, size_t n)
{
	size_t end = first + 1;

	while (end < n && starts[end + 1] - starts[first] <= ROWS_AT_ONCE)
		end++;
	return end;
}

/* Leaves [CLS] and [SEP] out. */
static void keep_words(struct text *out, size_t sentence, const float *rows)
{
	size_t width = (size_t)out->width, first = (size_t)out->offsets[sentence];

	memcpy(out->words + first * width, rows + width,
		((size_t)out->offsets[sentence + 1] - first) * width * sizeof *rows);
}

static int encode(const struct cli *c, struct text *out, const struct bert *b, const struct tokens *t,
	enum words words, struct err *e)
{
	size_t width = (size_t)b->width, most = 0, longest = 0, floats, rows;
	float *scratch = NULL, *vectors = NULL;
	struct cli_progress progress;
	int bad = 0;

	for (size_t first = 0, end; first < out->n; first = end) {
		end = pass_end(t->starts, first, out->n);
		rows = t->starts[end] - t->starts[first];
		most = rows > most ? rows : most;
	}
	for (size_t i = 0; i < out->n; i++)
		longest =
			t->starts[i + 1] - t->starts[i] > longest ? t->starts[i + 1] - t->starts[i] : longest;
	if (bert_scratch(b, most, longest, &floats))
		return err_set(e, ERR_SYSTEM, "encoder: its scratch does not fit in memory");
	scratch = mem_alloc(floats, sizeof *scratch, "encoder's scratch", e);
	vectors = mem_alloc(most, sizeof *vectors * width, "encoder's output", e);
	bad = !scratch || !vectors;
	cli_progress_start(&progress, c, "sentences", (double)out->n);
	for (size_t first = 0, end; first < out->n && !bad; first = end) {
		end = pass_end(t->starts, first, out->n);
		rows = t->starts[end] - t->starts[first];
		if (words == STATIC)
			bert_static(b, t->pieces.ids + t->starts[first], rows, vectors);
		else
			bert_forward(b, t->pieces.ids, t->starts + first, end - first, vectors, scratch);
		for (size_t i = first; i < end; i++)
			keep_words(out, i, vectors + (t->starts[i] - t->starts[first]) * width);
		cli_progress_step(&progress, (double)end, NULL);
	}
	cli_progress_end(&progress);
	free(scratch);
	free(vectors);
	return bad || text_take_means(out, e) ? -1 : 0;
}

static int run(const struct cli *c, const char *dir, enum words words, struct err *e)
{
	struct sentences s = {0};
	struct vocab v = {0};
	struct bert b = {0};
	struct tokens t = {0};
	struct text out = {0};
	char options[512];
	int bad, length;
	const char *name = path_last(dir, &length); /* so that bytes do not depend on where a model is */

	snprintf(options, sizeof options, "--model %.*s%s", length, name,
		words == STATIC ? " --words static" : "");
	bad = vocab_read(&v, dir, e) || sentences_read(&s, c->operand_count ? c->operands[0] : "-", e) ||
	      bert_model_read(&b, dir, e) || check_vocab(&v, &b, dir, e) ||
	      tokenise(c, &t, &s, &v, (size_t)b.positions, e) || alloc_text(&out, &s, &t, b.width, e) ||
	      keep_pieces(&out, &t, &v, e) || text_take_more(&out, &s, e) ||
	      encode(c, &out, &b, &t, words, e);
	if (!bad) {
		out.encoder = fingerprint_encoder(&b, &v, words == STATIC);
		cli_note(c, 1, "%zu sentences, %lld words of width %d", out.n, (long long)out.offsets[out.n],
			out.width);
		bad = text_write(&out, c->output, options, e);
	}
	free_text(&out);
	tokens_free(&t);
	bert_free(&b);
	vocab_free(&v);
	sentences_free(&s);
	return bad ? -1 : 0;
}

int main(int argc, char **argv)
{
	const char *model = NULL;
	int words = CONTEXTUAL;
	const struct cli_option options[] = {
		{"model", 0, CLI_STRING, &model, "DIR",
			"the encoder's folder: config.json, a tokenizer and *.safetensors (required)", 0, 0},
		{"words", 0, CLI_CHOICE, &words, "contextual|static",
			"as the sentence makes them or the vocabulary has them (default contextual)", 0, 0},
		{0}};
	const struct cli_tool tool = {.name = "text-encode",
		.operands = "[SENTENCES]",
		.summary =
			"Turn sentences (JSON Lines; stdin by default) into word vectors (text.safetensors).",
		.options = options,
		.common = CLI_VERBOSE | CLI_QUIET | CLI_THREADS | CLI_OUTPUT,
		.max_operands = 1};
	struct err e = {0};
	struct cli c;

	cli_parse(&c, &tool, argc, argv);
	if (!model)
		cli_usage(&c, "--model DIR is required");
	cli_refuse_terminal(&c);
	cli_refuse_overwrite(&c, "SENTENCES model:" BERT_MODEL_PARTS, "output", NULL);
	if (run(&c, model, (enum words)words, &e))
		return cli_fail(&c, &e);
	return cli_done(&c);
}
