#include "cmd/text/encode.h"

#include "base/mem.h"
#include "formats/arrays/metalist.h"
#include "formats/records/masks.h"

#include <math.h>

/* Tokens in one forward pass: enough to keep the products busy, little memory. */
enum { ROWS_AT_ONCE = 1024 };

/* sentences from words. */
static void take_means(struct text *t)
{
	const size_t width = (size_t)t->width;

	for (size_t r = 0; r < t->n; r++) {
		const size_t first = (size_t)t->offsets[r], end = (size_t)t->offsets[r + 1];
		for (size_t i = 0; i < width && end > first; i++) {
			double sum = 0;
			for (size_t w = first; w < end; w++)
				sum += t->words[w * width + i];
			t->sentences[r * width + i] = (float)(sum / (double)(end - first));
		}
	}
}

/* Sets (*list)[i], in a list that the first such entry makes. */
static int set_entry(char ***list, size_t n, size_t i, const char *value, struct err *e)
{
	if (!*list) {
		*list = mem_zalloc(n, sizeof **list, "sentences", e);
		for (size_t k = 0; *list && k < n; k++)
			if (!((*list)[k] = mem_strdup("", e)))
				return -1;
	}
	char *copy = *list ? mem_strdup(value, e) : NULL;
	if (!copy)
		return -1;
	free((*list)[i]);
	(*list)[i] = copy;
	return 0;
}

/* object_lists, views and kinds of the sentences; what none says stays NULL. */
static int take_more(struct text *t, const struct sentences *s, struct err *e)
{
	int bad = 0;

	for (size_t i = 0; i < s->n && !bad; i++) {
		const struct sentence *one = &s->items[i];
		SCOPED char *list = one->has_objects ? metalist_print(one->objects, one->object_count) : NULL;
		if (one->has_objects && !list)
			bad = err_set(e, ERR_SYSTEM, "objects: out of memory");
		bad = bad || (list && set_entry(&t->object_lists, s->n, i, list, e)) ||
		      (one->view && set_entry(&t->views, s->n, i, one->view, e)) ||
		      (one->kind && set_entry(&t->kinds, s->n, i, one->kind, e));
	}
	return bad ? -1 : 0;
}

static int tokenise(const struct report *to, struct encoding_tokens *t, const struct sentences *s,
	const struct encoder *with, struct err *e)
{
	const size_t positions = encoder_positions(with);

	t->starts = mem_alloc(s->n + 1, sizeof *t->starts, "sentences", e);
	if (!t->starts)
		return -1;
	for (size_t i = 0; i < s->n; i++) {
		t->starts[i] = t->pieces.n;
		if (wordpieces_push(&t->pieces, encoder_first(with), e) ||
			encoder_cut(with, s->items[i].text, &t->pieces, e))
			return -1;
		size_t words = t->pieces.n - t->starts[i] - 1;
		if (words > positions - 2) {
			report_warn(to, "ref '%s': %zu word pieces, cut to the %zu that the encoder takes",
				s->items[i].ref, words, positions - 2);
			t->pieces.n = t->starts[i] + positions - 1;
		}
		if (wordpieces_push(&t->pieces, encoder_last(with), e))
			return -1;
	}
	t->starts[s->n] = t->pieces.n;
	return 0;
}

static int alloc_text(
	struct text *out, const struct sentences *s, const struct encoding_tokens *t, struct err *e)
{
	const size_t n = out->n = s->n;

	out->offsets = mem_alloc(n + 1, sizeof *out->offsets, "offsets", e);
	out->refs = mem_zalloc(n, sizeof *out->refs, "refs", e);
	out->objects = mem_zalloc(n, sizeof *out->objects, "objects", e);
	out->texts = mem_zalloc(n, sizeof *out->texts, "texts", e);
	out->splits = mem_alloc(n, sizeof *out->splits, "splits", e);
	if (!out->offsets || !out->refs || !out->objects || !out->texts || !out->splits)
		return -1;
	for (size_t i = 0; i <= n; i++)
		out->offsets[i] = (int64_t)(t->starts[i] - 2 * i);
	for (size_t i = 0; i < n; i++) {
		const struct sentence *one = &s->items[i];
		if (!(out->refs[i] = mem_strdup(one->ref, e)) ||
			!(out->objects[i] = mem_strdup(one->object, e)) ||
			!(out->texts[i] = mem_strdup(one->text, e)))
			return -1;
		out->splits[i] = one->split;
	}
	return 0;
}

static int alloc_vectors(struct text *out, const struct encoder *with, struct err *e)
{
	const size_t words = (size_t)out->offsets[out->n],
		     row = sizeof *out->words * (size_t)encoder_width(with);

	out->width = encoder_width(with);
	out->words = mem_alloc(words, row, "words", e);
	out->sentences = mem_zalloc(out->n, row, "sentence vectors", e);
	if (encoder_has_middle(with) && !(out->middle = mem_alloc(words, row, "words", e)))
		return -1;
	return out->words && out->sentences ? 0 : -1;
}

static int keep_pieces(
	struct text *out, const struct encoding_tokens *t, const struct encoder *with, struct err *e)
{
	out->pieces = mem_zalloc(out->n, sizeof *out->pieces, "pieces", e);
	if (!out->pieces)
		return -1;
	for (size_t i = 0; i < out->n; i++) {
		out->pieces[i] = encoder_print(
			with, t->pieces.ids + t->starts[i] + 1, t->starts[i + 1] - t->starts[i] - 2, e);
		if (!out->pieces[i])
			return -1;
	}
	return 0;
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

/* Leaves the tokens that begin and end the sentence out of its words. rows and middle: its first ones. */
static void keep_sentence(struct text *out, const struct encoder *with, const struct encoding_tokens *t,
	size_t sentence, const float *rows, const float *middle)
{
	const size_t width = (size_t)out->width, first = (size_t)out->offsets[sentence],
		     floats = ((size_t)out->offsets[sentence + 1] - first) * width;
	const int32_t *ids = t->pieces.ids + t->starts[sentence];
	size_t last = 0;

	memcpy(out->words + first * width, rows + width, floats * sizeof *rows);
	if (middle)
		memcpy(out->middle + first * width, middle + width, floats * sizeof *middle);
	if (!encoder_pools(with))
		return;
	while (ids[last] != encoder_last(with))
		last++;
	memcpy(out->sentences + sentence * width, rows + last * width, width * sizeof *rows);
}

static int check_finite(const struct text *t, struct err *e)
{
	const size_t width = (size_t)t->width;

	for (size_t r = 0; r < t->n; r++) {
		int bad = 0;
		for (size_t i = (size_t)t->offsets[r] * width; i < (size_t)t->offsets[r + 1] * width; i++)
			bad |= !isfinite(t->words[i]);
		for (size_t i = r * width; i < (r + 1) * width; i++)
			bad |= !isfinite(t->sentences[i]);
		if (bad)
			return err_set(
				e, ERR_FORMAT, "ref '%s': the encoder's output is not finite", t->refs[r]);
	}
	return 0;
}

/* The most tokens of a pass, and the longest sentence's. */
static void find_sizes(const struct encoding_tokens *t, size_t n, size_t *most, size_t *longest)
{
	size_t rows;

	*most = *longest = 0;
	for (size_t first = 0, end; first < n; first = end) {
		end = pass_end(t->starts, first, n);
		rows = t->starts[end] - t->starts[first];
		*most = rows > *most ? rows : *most;
	}
	for (size_t i = 0; i < n; i++) {
		rows = t->starts[i + 1] - t->starts[i];
		*longest = rows > *longest ? rows : *longest;
	}
}

static int make_words(struct text *out, const struct encoder *with, const struct encoding_tokens *t,
	const struct report *to, struct err *e)
{
	size_t width = (size_t)out->width, most, longest, floats;
	SCOPED float *scratch = NULL, *vectors = NULL, *middle = NULL;
	int bad = 0;

	find_sizes(t, out->n, &most, &longest);
	if (text_tower_scratch(&with->tower, most, longest, &floats))
		return err_set(e, ERR_SYSTEM, "encoder: its scratch does not fit in memory");
	scratch = mem_alloc(floats, sizeof *scratch, "encoder's scratch", e);
	vectors = mem_alloc(most, sizeof *vectors * width, "encoder's output", e);
	if (out->middle)
		middle = mem_alloc(most, sizeof *middle * width, "encoder's output", e);
	bad = !scratch || !vectors || (out->middle && !middle);
	report_start(to, "sentences", (double)out->n);
	for (size_t first = 0, end; first < out->n && !bad; first = end) {
		end = pass_end(t->starts, first, out->n);
		encoder_forward(
			with, t->pieces.ids, t->starts + first, end - first, vectors, middle, scratch);
		for (size_t i = first; i < end; i++) {
			const size_t at = (t->starts[i] - t->starts[first]) * width;
			keep_sentence(out, with, t, i, vectors + at, middle ? middle + at : NULL);
		}
		report_step(to, (double)end, NULL);
	}
	report_end(to);
	if (bad)
		return -1;
	if (!encoder_pools(with))
		take_means(out);
	return check_finite(out, e);
}

static int has_sentence(const struct sentences *s, const char *ref)
{
	size_t i = 0;

	while (i < s->n && strcmp(s->items[i].ref, ref))
		i++;
	return i < s->n;
}

/* The names of objects in mask records. */
static int read_names(struct sentences *s, const char *path, struct err *e)
{
	struct mask one;
	SCOPED_BY(jsonl_close) struct jsonl j = {0};
	int got;

	if (jsonl_open(&j, path, e))
		return -1;
	while ((got = masks_next(&j, &one, e)) > 0) {
		const char *name = one.object;
		const int bad = name && !has_sentence(s, name) && sentences_add(s, name, name, name, e);
		mask_free(&one);
		if (bad) {
			got = -1;
			break;
		}
	}
	if (!got && !s->n)
		got = err_set(e, ERR_FORMAT, "%s: names no objects", j.path);
	return got;
}

int encoding_read(struct encoding *x, const char *path, int is_of_masks, struct err *e)
{
	return is_of_masks ? read_names(&x->sentences, path, e) : sentences_read_any(&x->sentences, path, e);
}

int encode(struct encoding *x, const struct encoder *with, const struct report *to, struct err *e)
{
	struct text *out = &x->text;

	if (tokenise(to, &x->tokens, &x->sentences, with, e) ||
		alloc_text(out, &x->sentences, &x->tokens, e) || alloc_vectors(out, with, e) ||
		keep_pieces(out, &x->tokens, with, e) || take_more(out, &x->sentences, e) ||
		make_words(out, with, &x->tokens, to, e))
		return -1;
	out->encoder = with->fingerprint;
	return 0;
}

void encoding_free(struct encoding *x)
{
	text_free(&x->text);
	sentences_free(&x->sentences);
	mem_free_all(x->tokens.pieces.ids, x->tokens.starts);
}
