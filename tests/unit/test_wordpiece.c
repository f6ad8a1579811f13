#include "unit.h"

#include "nn/unicode.h"
#include "nn/wordpiece.h"

#include <zlib.h>

/* Whole blocks of Unicode against Python's unicodedata: tests/peers/unicode_checksum.py. */
static void unicode_matches_its_source(void)
{
	static const uint32_t blocks[][2] = {{0, 0x52f}, {0x600, 0x6ff}, {0x900, 0x97f}, {0x1e00, 0x23ff},
		{0x3000, 0x30ff}, {0x4e00, 0x9fff}, {0xac00, 0xd7a3}, {0xe000, 0xfaff}, {0xfe30, 0xffff},
		{0x1d100, 0x1d1ff}, {0x1d400, 0x1d7ff}, {0x2f800, 0x2fa1f}, {0x10ff00, 0x10ffff}};
	uLong crc = crc32(0, NULL, 0);
	char line[128];

	for (size_t b = 0; b < sizeof blocks / sizeof *blocks; b++)
		for (uint32_t c = blocks[b][0]; c <= blocks[b][1]; c++) {
			uint32_t folded[UNICODE_FOLD_MAX];
			size_t n = unicode_fold(c, folded);
			int used = snprintf(line, sizeof line, "%x %d%d%d ", c, unicode_is_dropped(c),
				unicode_is_space(c), unicode_is_punctuation(c));
			for (size_t i = 0; i < n; i++)
				used += snprintf(
					line + used, sizeof line - (size_t)used, i ? " %x" : "%x", folded[i]);
			line[used++] = '\n';
			crc = crc32(crc, (unsigned char *)line, (uInt)used);
		}
	CHECK(crc == 0x864d946b, "crc32 is %08lx", crc);
}

static const char *const tokens[] = {"[PAD]", "[UNK]", "[CLS]", "[SEP]", "cup", "##s", "c", "##up", "cu", "e",
	"cafe", "!", "杯", "$", "##!", "##[", "[", "]", "sep", "a", "##a", "i"};

static int32_t id_of(const char *token)
{
	for (size_t i = 0; i < sizeof tokens / sizeof *tokens; i++)
		if (!strcmp(tokens[i], token))
			return (int32_t)i;
	return -1;
}

static void make_vocab(struct vocab *v)
{
	struct err e = {0};

	*v = (struct vocab){0};
	for (size_t i = 0; i < sizeof tokens / sizeof *tokens; i++)
		CHECK(vocab_add(v, tokens[i], (int32_t)i, &e) == 0, "adding %s", tokens[i]);
	CHECK(vocab_add(v, "cup", 99, &e) == 1, "a token that is there already is told");
	CHECK(!vocab_finish(v), "special tokens");
	CHECK(vocab_find(v, "cup", 3) == 4 && vocab_find(v, "cup", 2) == 8 && vocab_find(v, "cups", 4) == -1,
		"finding");
}

static void known_sentences(void)
{
	static const struct {
		const char *text, *expected; /* pieces separated by one space */
	} cases[] = {{"", ""}, {" \t\r\n", ""}, {"cup", "cup"}, {"CUPS", "cup ##s"}, {"cuup", "cu ##up"},
		{"cupx", "[UNK]"}, {"Café", "cafe"}, {"cafe\xcc\x81", "cafe"}, {"\xcc\x81", ""},
		{"cup!cup", "cup ! cup"}, {"!!", "! !"}, {"c杯up", "c 杯 [UNK]"}, {"c\xc2\xadup", "cup"},
		{"c\xe2\x80\x8bup", "cup"}, {"c\302\240cup", "c cup"}, {"c\xc2\x85up", "cup"},
		{"cup\x07s", "cup ##s"}, {"a$a", "a $ a"}, {"[SEP]", "[SEP]"},
		{"cup[SEP]s", "cup [SEP] [UNK]"}, {"[sep]", "[ sep ]"}, {"[MASK]", "[ [UNK] ]"},
		{"\xc4\xb0", "i"}, {"cup \xff\xfe cup", "cup cup"}, {"\xed\xa0\x80", ""}};
	struct vocab v;
	struct err e = {0};

	make_vocab(&v);
	for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
		struct wordpieces out = {0};
		char got[256] = "";
		CHECK(!wordpiece_encode(&v, cases[i].text, &out, &e), "%s", e.message);
		for (size_t k = 0, used = 0; k < out.n; k++)
			used += (size_t)snprintf(
				got + used, sizeof got - used, "%s%s", k ? " " : "", tokens[out.ids[k]]);
		CHECK(!strcmp(got, cases[i].expected), "'%s' gave '%s'", cases[i].text, got);
		free(out.ids);
	}
	vocab_free(&v);
}

/* 100 characters are cut up, 101 are [UNK]; accents do not count. */
static void longest_word(void)
{
	struct vocab v;
	struct err e = {0};

	make_vocab(&v);
	for (int n = 99; n <= 102; n++) {
		struct wordpieces out = {0};
		char text[512];
		memset(text, 'a', (size_t)n);
		snprintf(text + n, sizeof text - (size_t)n, "\xcc\x81\xcc\x81 cup");
		CHECK(!wordpiece_encode(&v, text, &out, &e), "%s", e.message);
		size_t want = n <= 100 ? (size_t)n + 1 : 2;
		CHECK(out.n == want, "%d characters gave %zu pieces", n, out.n);
		CHECK(out.ids[0] == id_of(n <= 100 ? "a" : "[UNK]") && out.ids[out.n - 1] == id_of("cup"),
			"%d", n);
		free(out.ids);
	}
	vocab_free(&v);
}

/* No bytes, however malformed, make it fail, and every id is one of the vocabulary. */
static void any_bytes(void)
{
	struct vocab v;
	struct err e = {0};
	uint32_t state = 1;
	size_t wrong = 0;

	make_vocab(&v);
	for (int round = 0; round < 2000; round++) {
		struct wordpieces out = {0};
		char text[65] = {0};
		for (int i = 0; i < 64; i++) {
			state = state * 1664525 + 1013904223;
			text[i] = (char)(state >> 24);
		}
		CHECK(!wordpiece_encode(&v, text, &out, &e), "%s", e.message);
		for (size_t k = 0; k < out.n; k++)
			wrong += out.ids[k] < 0 || out.ids[k] >= (int32_t)(sizeof tokens / sizeof *tokens);
		free(out.ids);
	}
	CHECK(wrong == 0, "%zu ids are not of the vocabulary", wrong);
	vocab_free(&v);
}

int main(void)
{
	unicode_matches_its_source();
	known_sentences();
	longest_word();
	any_bytes();
	return unit_end();
}
