/* The encoder on a tiny random BERT, against float64 (tests/peers/bert.py), and on all-MiniLM-L6-v2 where the
 * environment's REFER_BERT names its folder. Run from the repository's root. */
#include "encoder_files.h"
#include "unit.h"

#include "formats/encoders/bert_model.h"
#include "formats/arrays/safetensors.h"
#include "formats/records/sentences.h"
#include "formats/encoders/vocab.h"

#include <omp.h>
#include <unistd.h>

#define GOLDEN "tests/golden/bert"

static char work[] = "/tmp/test_bert.XXXXXX";

/* All vectors of the sentence, those of [CLS] and [SEP] too: (*n, width). free() them. */
static float *encode(const struct text_tower *b, const struct vocab *v, const char *text,
	struct wordpieces *ids, size_t *n)
{
	struct wordpieces words = {0};
	struct err e = {0};
	size_t most = (size_t)b->positions - 2, floats;

	CHECK(!wordpiece_encode(v, text, &words, &e), "%s", e.message);
	size_t keep = words.n < most ? words.n : most;
	ids->ids = malloc((keep + 2) * sizeof *ids->ids);
	ids->ids[0] = v->special[WORDPIECE_CLS];
	if (keep)
		memcpy(ids->ids + 1, words.ids, keep * sizeof *words.ids);
	ids->ids[keep + 1] = v->special[WORDPIECE_SEP];
	ids->n = *n = keep + 2;
	free(words.ids);
	CHECK(!text_tower_scratch(b, *n, *n, &floats), "scratch");
	float *scratch = malloc(floats * sizeof *scratch),
	      *out = malloc(*n * (size_t)b->body.width * sizeof *out);
	text_tower_forward(b, ids->ids, (size_t[]){0, *n}, 1, out, NULL, scratch);
	free(scratch);
	return out;
}

static void golden_sentences(const struct text_tower *b, const struct vocab *v)
{
	struct sentences s;
	struct safetensors expected;
	struct err e = {0};
	size_t width = (size_t)b->body.width;
	double worst = 0;

	if (!CHECK(!sentences_read(&s, GOLDEN "/sentences.jsonl", &e), "%s", e.message) ||
		!CHECK(!safetensors_open(&expected, GOLDEN "-expected.safetensors", &e), "%s", e.message))
		return;
	const struct st_tensor *words = safetensors_find(&expected, "words"),
			       *ids = safetensors_find(&expected, "ids");
	const struct st_tensor *offsets = safetensors_find(&expected, "offsets");
	CHECK(s.n >= 30 && (size_t)offsets->shape[0] == s.n + 1, "%zu sentences", s.n);
	for (size_t i = 0; i < s.n; i++) {
		struct wordpieces have;
		int64_t range[2];
		size_t n, wrong = 0;
		float *x = encode(b, v, s.items[i].text, &have, &n);
		memcpy(range, (const char *)offsets->data + i * 8, 16);
		if (!CHECK(n - 2 == (size_t)(range[1] - range[0]), "sentence %zu has %zu words", i, n - 2))
			n = 2;
		for (size_t k = 0; k < n - 2; k++) {
			int32_t id;
			memcpy(&id, (const char *)ids->data + ((size_t)range[0] + k) * 4, 4);
			wrong += id != have.ids[k + 1];
		}
		CHECK(wrong == 0, "sentence %zu: %zu ids differ", i, wrong);
		for (size_t k = 0; k < (n - 2) * width; k++) {
			float y;
			memcpy(&y, (const char *)words->data + ((size_t)range[0] * width + k) * 4, 4);
			worst = fmax(worst, fabs((double)y - x[width + k]));
		}
		free(x);
		free(have.ids);
	}
	CHECK(worst < 1e-5, "words differ by %g", worst);
	safetensors_close(&expected);
	sentences_free(&s);
}

/* Sequences side by side, from any place on, give the bytes that each gives alone; and so do all thread
 * counts. */
static void side_by_side(const struct text_tower *b)
{
	enum { N = 4, TOKENS = 60 };
	int32_t ids[TOKENS];
	size_t starts[N + 1] = {5, 7, 20, 20, TOKENS}, width = (size_t)b->body.width, floats;
	float *all = malloc(TOKENS * width * sizeof *all), *one = malloc(TOKENS * width * sizeof *one);
	float *middle = malloc(TOKENS * width * sizeof *middle),
	      *half = malloc(TOKENS * width * sizeof *half);
	struct text_tower first = *b; /* the first half of the layers alone */
	int threads = omp_get_max_threads();

	for (int i = 0; i < TOKENS; i++)
		ids[i] = (i * 37 + 11) % b->words;
	text_tower_scratch(b, TOKENS, TOKENS, &floats);
	float *scratch = malloc(floats * sizeof *scratch);
	omp_set_num_threads(3);
	text_tower_forward(b, ids, starts, N, all, middle, scratch);
	omp_set_num_threads(1);
	for (int s = 0; s < N; s++) {
		size_t n = starts[s + 1] - starts[s];
		size_t at = (starts[s] - starts[0]) * width;
		text_tower_forward(b, ids, starts + s, 1, one, half, scratch);
		CHECK(same_bytes(one, all + at, n * width * sizeof *one), "sequence %d", s);
		CHECK(same_bytes(half, middle + at, n * width * sizeof *one), "sequence %d, middle", s);
		text_tower_forward(b, ids, starts + s, 1, one, NULL, scratch);
		CHECK(same_bytes(one, all + at, n * width * sizeof *one), "sequence %d without its middle",
			s);
	}
	first.body.layer_count = transformer_middle(&b->body);
	CHECK(first.body.layer_count > 0, "no layers before the middle");
	text_tower_forward(&first, ids, starts, N, one, NULL, scratch);
	CHECK(same_bytes(one, middle, (starts[N] - starts[0]) * width * sizeof *one), "half of the layers");
	omp_set_num_threads(threads);
	free(all);
	free(one);
	free(middle);
	free(half);
	free(scratch);
}

/* GELU against float64. */
static void gelu(void)
{
	enum { N = 40001 };
	static float x[N], y[N];
	double worst = 0;

	for (int i = 0; i < N; i++)
		x[i] = y[i] = (float)(i - N / 2) / 2000;
	transformer_gelu(y, N);
	for (int i = 0; i < N; i++)
		worst = fmax(
			worst, fabs(y[i] - .5 * x[i] * erfc(-x[i] * sqrt(.5))) / (1 + fabs((double)x[i])));
	CHECK(worst < 6e-8, "GELU is off by %g", worst);
	printf("GELU: %g (1 + |x|)\n", worst);
	x[0] = -1e30f;
	x[1] = 1e30f;
	x[2] = NAN;
	transformer_gelu(x, 3);
	CHECK(fabsf(x[0]) == 0 && x[1] == 1e30f && isnan(x[2]), "far out: %g %g %g", x[0], x[1], x[2]);
}

static char *in_work(const char *name)
{
	static char path[256];

	snprintf(path, sizeof path, "%s/%s", work, name);
	return path;
}

/* The golden weights written as another type and under other names. `leave_out` and `bend` break one tensor.
 */
static void write_variant(
	enum st_dtype dtype, const char *prefix, int is_old, const char *leave_out, const char *bend)
{
	static char names[64][128];
	static _Alignas(8) char data[64][32768];
	struct st_tensor tensors[64];
	struct safetensors st;
	struct err e = {0};
	size_t n = 0;

	if (!CHECK(!safetensors_open(&st, GOLDEN "/model.safetensors", &e), "%s", e.message))
		return;
	for (size_t i = 0; i < st.n; i++) {
		struct st_tensor t = st.tensors[i];
		char *norm = strstr(t.name, "LayerNorm.");
		if (leave_out && !strcmp(leave_out, t.name))
			continue;
		snprintf(names[n], sizeof names[n], "%s%s", prefix, t.name);
		if (is_old && norm)
			snprintf(names[n], sizeof names[n], "%s%.*s%s", prefix, (int)(norm + 10 - t.name),
				t.name, strstr(norm, "weight") ? "gamma" : "beta");
		CHECK(!store_as(&t, dtype, data[n]), "%s", st.path);
		if (bend && !strcmp(bend, t.name))
			t.shape[t.dims - 1] -= 1;
		t.name = names[n];
		tensors[n++] = t;
	}
	CHECK(!safetensors_write(in_work("weights.safetensors"), tensors, n, NULL, 0, &e), "%s", e.message);
	safetensors_close(&st);
}

/* The same numbers as any float type, with and without "bert.", with gamma and beta. */
static void stored_otherwise(const struct text_tower *golden, const struct vocab *v)
{
	static const struct {
		enum st_dtype dtype;
		const char *prefix;
		int is_old;
	} variants[] = {{ST_F32, "", 0}, {ST_BF16, "", 0}, {ST_F16, "bert.", 0}, {ST_F32, "bert.", 1},
		{ST_BF16, "", 1}};

	for (size_t i = 0; i < sizeof variants / sizeof *variants; i++) {
		struct err e = {0};
		struct text_tower b;
		write_variant(variants[i].dtype, variants[i].prefix, variants[i].is_old, NULL, NULL);
		if (!CHECK(!bert_model_read(&b, work, &e), "variant %zu: %s", i, e.message))
			continue;
		CHECK(text_tower_hash(&b, 1) == text_tower_hash(golden, 1), "variant %zu", i);
		CHECK(!b.word.floats == (variants[i].dtype == ST_F16), "variant %zu is in another place", i);
		struct wordpieces ids;
		size_t n;
		float *x = encode(&b, v, "a red cup", &ids, &n), *y;
		free(ids.ids);
		y = encode(golden, v, "a red cup", &ids, &n);
		CHECK(same_bytes(x, y, n * (size_t)b.body.width * sizeof *x), "variant %zu: vectors", i);
		free(x);
		free(y);
		free(ids.ids);
		text_tower_free(&b);
	}
}

static void refused(const char *leave_out, const char *bend, const char *expected)
{
	struct err e = {0};
	struct text_tower b;
	char message[512];

	write_variant(ST_F16, "", 0, leave_out, bend);
	snprintf(message, sizeof message, "%s/weights.safetensors: %s", work, expected);
	CHECK(bert_model_read(&b, work, &e) && e.code == ERR_FORMAT && !strcmp(e.message, message), "%s",
		e.message);
	text_tower_free(&b);
}

static void vocab_txt(const struct vocab *json)
{
	struct vocab list;
	struct err e = {0};
	size_t wrong = 0;

	CHECK(!copy_file(GOLDEN "/vocab.txt", in_work("vocab.txt")), "copy");
	if (!CHECK(!vocab_read(&list, work, &e), "%s", e.message))
		return;
	for (size_t i = 0; i < json->n; i++)
		wrong += vocab_find(&list, json->entries[i].token, strlen(json->entries[i].token)) !=
			 json->entries[i].id;
	CHECK(list.n == json->n && wrong == 0, "%zu of %zu tokens differ", wrong, list.n);
	vocab_free(&list);
}

/* The model card's sentence pooled as it is there: mean over all tokens, [CLS] and [SEP] too, L2-normalised.
 */
static void published_figures(void)
{
	static const double published[3] = {0.0676569, 0.0634959, 0.0487131};
	const char *dir = getenv("REFER_BERT");
	struct text_tower b;
	struct vocab v;
	struct err e = {0};
	double pooled[384] = {0}, square = 0;

	if (!dir) {
		printf("skipped: REFER_BERT does not name the folder of all-MiniLM-L6-v2\n");
		return;
	}
	if (!CHECK(!bert_model_read(&b, dir, &e), "%s", e.message) ||
		!CHECK(!vocab_read(&v, dir, &e), "%s", e.message))
		return;
	if (CHECK(b.body.width == 384, "width %d", b.body.width)) {
		struct wordpieces ids;
		size_t n;
		float *x = encode(&b, &v, "This is an example sentence", &ids, &n);
		for (size_t k = 0; k < n * 384; k++)
			pooled[k % 384] += x[k] / (double)n;
		for (int i = 0; i < 384; i++)
			square += pooled[i] * pooled[i];
		for (int i = 0; i < 3; i++) {
			double have = pooled[i] / sqrt(square);
			printf("pooled[%d] %.7f, published %.7f\n", i, have, published[i]);
			CHECK(fabs(have - published[i]) < 1e-4, "element %d", i);
		}
		free(x);
		free(ids.ids);
	}
	text_tower_free(&b);
	vocab_free(&v);
}

int main(void)
{
	struct text_tower b;
	struct vocab v;
	struct err e = {0};

	if (!CHECK(mkdtemp(work), "%s", work) || !CHECK(!bert_model_read(&b, GOLDEN, &e), "%s", e.message) ||
		!CHECK(!vocab_read(&v, GOLDEN, &e), "%s", e.message))
		return unit_end();
	golden_sentences(&b, &v);
	gelu();
	side_by_side(&b);
	CHECK(!copy_file(GOLDEN "/config.json", in_work("config.json")), "copy");
	stored_otherwise(&b, &v);
	refused("encoder.layer.1.output.dense.weight", NULL,
		"tensor 'encoder.layer.1.output.dense.weight' is missing");
	refused(NULL, "encoder.layer.0.intermediate.dense.weight",
		"tensor 'encoder.layer.0.intermediate.dense.weight': is F16[40,23], expected F16[40,24]");
	vocab_txt(&v);
	published_figures();
	unlink(in_work("config.json"));
	unlink(in_work("weights.safetensors"));
	unlink(in_work("vocab.txt"));
	rmdir(work);
	text_tower_free(&b);
	vocab_free(&v);
	return unit_end();
}
