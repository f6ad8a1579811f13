/* CLIP's text tower on a tiny random one, in both layouts, against float64 (tests/peers/clip.py). Run from
 * the repository's root. */
#include "encoder_files.h"
#include "unit.h"

#include "formats/encoders/clip_model.h"
#include "formats/encoders/merges.h"
#include "formats/records/sentences.h"

#include <omp.h>
#include <unistd.h>

#define GOLDEN "tests/golden/clip"
#define OTHER "tests/golden/open-clip"

static char work[] = "/tmp/test_clip.XXXXXX";

static char *in_work(const char *name)
{
	static char path[256];

	snprintf(path, sizeof path, "%s/%s", work, name);
	return path;
}

/* All vectors of n ids: (n, text_tower_width). free() them. */
static float *forward(const struct text_tower *c, const int32_t *ids, size_t n)
{
	size_t floats = 0;

	CHECK(!text_tower_scratch(c, n, n, &floats), "scratch");
	float *scratch = malloc(floats * sizeof *scratch),
	      *out = malloc(n * (size_t)text_tower_width(c) * sizeof *out);
	text_tower_forward(c, ids, (size_t[]){0, n}, 1, out, NULL, scratch);
	free(scratch);
	return out;
}

/* The tokens of a text between start and end, cut to what the tower takes. */
static void cut(const struct text_tower *c, const struct bpe *b, const char *text, struct wordpieces *ids)
{
	struct err e = {0};
	struct wordpieces words = {0};

	CHECK(!bpe_encode(b, text, &words, &e), "%s", e.message);
	size_t keep = words.n < (size_t)c->positions - 2 ? words.n : (size_t)c->positions - 2;
	ids->ids = malloc((keep + 2) * sizeof *ids->ids);
	ids->ids[0] = b->start;
	if (keep)
		memcpy(ids->ids + 1, words.ids, keep * sizeof *words.ids);
	ids->ids[keep + 1] = b->end;
	ids->n = keep + 2;
	free(words.ids);
}

struct expected {
	struct safetensors st;
	const struct st_tensor *offsets, *ids, *words, *sentences;
};

static double worst_word, worst_sentence;

static void one_sentence(
	const struct text_tower *c, const struct bpe *b, const char *text, const struct expected *x, size_t i)
{
	const size_t width = (size_t)text_tower_width(c), first = (size_t)number_at(x->offsets, i),
		     n = (size_t)number_at(x->offsets, i + 1) - first;
	struct wordpieces ids;
	size_t wrong = 0, last = 0;

	cut(c, b, text, &ids);
	if (CHECK(ids.n == n + 2, "sentence %zu has %zu words, not %zu", i, ids.n - 2, n)) {
		float *y = forward(c, ids.ids, ids.n);
		for (size_t k = 0; k < n; k++)
			wrong += ids.ids[k + 1] != (int32_t)number_at(x->ids, first + k);
		for (size_t k = 0; k < n * width; k++)
			worst_word =
				fmax(worst_word, fabs(y[width + k] - number_at(x->words, first * width + k)));
		while (ids.ids[last] != b->end)
			last++;
		for (size_t k = 0; k < width; k++)
			worst_sentence = fmax(worst_sentence,
				fabs(y[last * width + k] - number_at(x->sentences, i * width + k)));
		CHECK(wrong == 0, "sentence %zu: %zu ids differ", i, wrong);
		free(y);
	}
	free(ids.ids);
}

static void golden_sentences(const struct text_tower *c, const struct bpe *b)
{
	struct sentences s;
	struct expected x;
	struct err e = {0};

	if (!CHECK(!sentences_read(&s, GOLDEN "/sentences.jsonl", &e), "%s", e.message) ||
		!CHECK(!safetensors_open(&x.st, GOLDEN "-expected.safetensors", &e), "%s", e.message))
		return;
	x.offsets = safetensors_find(&x.st, "offsets");
	x.ids = safetensors_find(&x.st, "ids");
	x.words = safetensors_find(&x.st, "words");
	x.sentences = safetensors_find(&x.st, "sentences");
	CHECK(s.n >= 30 && (size_t)x.offsets->shape[0] == s.n + 1, "%zu sentences", s.n);
	for (size_t i = 0; i < s.n; i++)
		one_sentence(c, b, s.items[i].text, &x, i);
	CHECK(worst_word > 0 && worst_word < 1e-5, "words differ by %g", worst_word);
	CHECK(worst_sentence > 0 && worst_sentence < 1e-5, "sentences differ by %g", worst_sentence);
	safetensors_close(&x.st);
	sentences_free(&s);
}

/* Sequences side by side give the bytes that each gives alone, with any threads; and a token does not see
 * those after it. */
static void side_by_side(const struct text_tower *c)
{
	enum { N = 4, TOKENS = 60 };
	int32_t ids[TOKENS];
	size_t starts[N + 1] = {5, 7, 20, 20, TOKENS}, width = (size_t)text_tower_width(c), floats;
	float *all = malloc(TOKENS * width * sizeof *all);
	int threads = omp_get_max_threads();

	for (int i = 0; i < TOKENS; i++)
		ids[i] = (i * 37 + 11) % c->words;
	CHECK(!text_tower_scratch(c, TOKENS, TOKENS, &floats), "scratch");
	float *scratch = malloc(floats * sizeof *scratch);
	omp_set_num_threads(3);
	text_tower_forward(c, ids, starts, N, all, NULL, scratch);
	omp_set_num_threads(1);
	for (int s = 0; s < N; s++) {
		size_t n = starts[s + 1] - starts[s];
		float *one = n ? forward(c, ids + starts[s], n) : NULL;
		CHECK(!n || same_bytes(one, all + (starts[s] - starts[0]) * width, n * width * sizeof *one),
			"sequence %d", s);
		free(one);
	}
	float *first = forward(c, ids + 20, 9);
	const float *whole = all + 15 * width;
	for (size_t k = 0; k < 9 * width; k++)
		CHECK(fabsf(first[k] - whole[k]) < 1e-5F, "column %zu sees later tokens", k);
	omp_set_num_threads(threads);
	free(all);
	free(first);
	free(scratch);
}

static int same_tower(const struct text_tower *a, const struct text_tower *b)
{
	return a->words == b->words && a->positions == b->positions && a->projected == b->projected &&
	       a->body.width == b->body.width && a->body.inner == b->body.inner &&
	       a->body.heads == b->body.heads && a->body.activation == b->body.activation &&
	       same_bytes(&a->body.eps, &b->body.eps, sizeof a->body.eps) &&
	       text_tower_hash(a, 1) == text_tower_hash(b, 1);
}

/* The layouts have the same numbers and the same tokens. */
static void other_layout(const struct text_tower *c, const struct bpe *b)
{
	struct text_tower same;
	struct bpe list;
	struct err e = {0};

	if (!CHECK(!clip_model_read(&same, OTHER, &e), "%s", e.message) ||
		!CHECK(!merges_read(&list, OTHER, same.words, &e), "%s", e.message))
		return;
	CHECK(same_tower(c, &same), "weights or sizes differ");
	CHECK(list.vocab.n == b->vocab.n && list.n == b->n, "%zu tokens, %zu merges", list.vocab.n, list.n);
	for (size_t i = 0; i < b->vocab.n && i < list.vocab.n; i++)
		CHECK(!strcmp(vocab_token(&b->vocab, (int32_t)i), vocab_token(&list.vocab, (int32_t)i)),
			"token %zu", i);
	text_tower_free(&same);
	bpe_free(&list);
}

/* The weights of a folder with other names: `from` at their beginning becomes `to`. */
static void write_variant(const char *file, enum st_dtype dtype, const char *from, const char *to)
{
	static char names[64][128];
	struct st_tensor tensors[64];
	struct safetensors st;
	struct err e = {0};
	size_t n = 0;

	if (!CHECK(!safetensors_open(&st, file, &e), "%s", e.message))
		return;
	char *data = malloc(64 * 65536);
	for (; n < st.n; n++) {
		const int is_renamed = !strncmp(st.tensors[n].name, from, strlen(from));
		tensors[n] = st.tensors[n];
		CHECK(!store_as(&tensors[n], dtype, data + 65536 * n), "%s", st.path);
		snprintf(names[n], sizeof names[n], "%s%s", is_renamed ? to : "",
			st.tensors[n].name + (is_renamed ? strlen(from) : 0));
		tensors[n].name = names[n];
	}
	CHECK(!safetensors_write(in_work("weights.safetensors"), tensors, n, NULL, 0, &e), "%s", e.message);
	safetensors_close(&st);
	free(data);
}

/* The same numbers as any float type, and with other prefixes. */
static void stored_otherwise(const struct text_tower *golden)
{
	static const struct {
		const char *file, *from, *to;
		enum st_dtype dtype;
	} variants[] = {{GOLDEN "/model.safetensors", "text_model.", "text_model.", ST_F32},
		{GOLDEN "/model.safetensors", "text_model.", "", ST_BF16},
		{OTHER "/open_clip_model.safetensors", "", "", ST_BF16},
		{OTHER "/open_clip_model.safetensors", "", "text.", ST_F32}};

	CHECK(!copy_file(GOLDEN "/config.json", in_work("config.json")), "copy");
	for (size_t i = 0; i < sizeof variants / sizeof *variants; i++) {
		struct err e = {0};
		struct text_tower c;
		write_variant(variants[i].file, variants[i].dtype, variants[i].from, variants[i].to);
		if (!CHECK(!clip_model_read(&c, work, &e), "variant %zu: %s", i, e.message))
			continue;
		CHECK(same_tower(golden, &c), "variant %zu", i);
		text_tower_free(&c);
	}
}

int main(void)
{
	struct text_tower c;
	struct bpe b;
	struct err e = {0};

	if (!CHECK(mkdtemp(work), "%s", work) || !CHECK(clip_model_is(GOLDEN), "it is a CLIP") ||
		!CHECK(!clip_model_is("tests/golden/bert"), "a BERT is not") ||
		!CHECK(!clip_model_read(&c, GOLDEN, &e), "%s", e.message) ||
		!CHECK(!merges_read(&b, GOLDEN, c.words, &e), "%s", e.message))
		return unit_end();
	golden_sentences(&c, &b);
	side_by_side(&c);
	other_layout(&c, &b);
	stored_otherwise(&c);
	unlink(in_work("config.json"));
	unlink(in_work("weights.safetensors"));
	rmdir(work);
	text_tower_free(&c);
	bpe_free(&b);
	return unit_end();
}
