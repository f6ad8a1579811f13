/* Byte pairs: words are cut as the pattern of CLIP's tokenizer says, and merged as the published algorithm
 * does, which looks for the best pair anew after each merge. Run from the repository's root. */
#include "unit.h"

#include "formats/encoders/merges.h"
#include "nn/bpe.h"

#define GOLDEN "tests/golden/clip"

/* The published algorithm on the symbols of one word; the number that is left. */
static size_t twin(const struct bpe *b, int32_t *symbols, size_t n)
{
	for (;;) {
		const struct bpe_merge *best = NULL;
		size_t kept = 0;
		for (size_t i = 0; i + 1 < n; i++) {
			const struct bpe_merge *m = bpe_find(b, symbols[i], symbols[i + 1]);
			if (m && (!best || m->rank < best->rank))
				best = m;
		}
		if (!best)
			return n;
		for (size_t i = 0; i < n; i++) {
			const int is_both =
				i + 1 < n && symbols[i] == best->left && symbols[i + 1] == best->right;
			symbols[kept++] = is_both ? best->id : symbols[i];
			i += (size_t)is_both;
		}
		n = kept;
	}
}

/* Random words of few letters, long and short, are merged as by the twin. */
static void as_published(const struct bpe *b)
{
	static const char few[] = "theacupndsrlo";
	uint32_t state = 1;
	size_t merged = 0;

	for (int round = 0; round < 3000; round++) {
		char word[128];
		int32_t symbols[128];
		struct wordpieces out = {0};
		struct err e = {0};
		const size_t n = 1 + (state >> 20) % (round % 10 ? 12 : 120);
		for (size_t i = 0; i < n; i++) {
			state = state * 1664525 + 1013904223;
			word[i] = few[(state >> 16) % (sizeof few - 1)];
			symbols[i] = b->bytes[i + 1 == n][(unsigned char)word[i]];
		}
		word[n] = 0;
		CHECK(!bpe_encode(b, word, &out, &e), "%s", e.message);
		const size_t left = twin(b, symbols, n);
		merged += n - left;
		CHECK(out.n == left && !memcmp(out.ids, symbols, left * sizeof *symbols), "'%s'", word);
		free(out.ids);
	}
	CHECK(merged > 3000, "only %zu merges", merged);
}

/* Texts, and how their tokens read: a piece that begins a word has no "##". */
static void known_texts(const struct bpe *b)
{
	static const struct {
		const char *text, *expected;
	} cases[] = {{"", ""}, {" \t\r\n", ""}, {"cup", "cup"}, {"CUP  cup", "cup cup"}, {"Q7q", "q 7 q"},
		{"12", "1 2"}, {"'s", "'s"}, {"'q", "' q"}, {"''s", "'' s"}, {"q's", "q 's"}, {"'sq", "'s q"},
		{"'LL", "'ll"}, {"?!q", "?! q"}, {"q?!", "q ?!"}, {"q\302\240q", "q q"},
		{"<|endoftext|>q", "<|endoftext|> q"}, {"q<|STARTofTEXT|>", "q <|startoftext|>"},
		{"?<|endoftext|>", "? <|endoftext|>"}, {"<|endoftext", "<| endoftext"},
		{"q\xff\xfeq", "q ##q"}, {"\xed\xa0\x80", ""}, {"Q\xcc\x88", "q \xc3\x8c ##\xc4\xaa"}};

	for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
		struct wordpieces out = {0};
		struct err e = {0};
		CHECK(!bpe_encode(b, cases[i].text, &out, &e), "%s", e.message);
		char *got = merges_print(b, out.ids, out.n, &e);
		/* letters that the golden merges leave apart may be apart */
		char joined[256] = "";
		for (const char *p = got; p && *p; p++)
			if (!strncmp(p, " ##", 3) && !strstr(cases[i].expected, "##"))
				p += 2;
			else
				strncat(joined, p, 1);
		CHECK(!strcmp(joined, cases[i].expected), "'%s' gave '%s'", cases[i].text, got);
		free(got);
		free(out.ids);
	}
}

/* All bytes have letters of their own, which read as the bytes where these show. */
static void letters(void)
{
	char seen[BPE_BYTES] = {0}, letter[BPE_LETTER_MAX];
	unsigned char byte;

	for (size_t i = 0; i < BPE_BYTES; i++) {
		bpe_letter(i, &byte, letter);
		CHECK(!seen[byte]++, "byte %d twice", byte);
		if (byte == 'a' || byte == ' ' || byte == 0 || byte == 0xad || byte == 0xff)
			CHECK(!strcmp(letter, byte == 'a'    ? "a"
					      : byte == ' '  ? "\xc4\xa0"
					      : byte == 0    ? "\xc4\x80"
					      : byte == 0xad ? "\xc5\x83"
							     : "\xc3\xbf"),
				"byte %d is '%s'", byte, letter);
	}
}

/* No bytes, however malformed, make it fail, and every id is one of the vocabulary. */
static void any_bytes(const struct bpe *b)
{
	uint32_t state = 7;
	size_t wrong = 0;

	for (int round = 0; round < 2000; round++) {
		struct wordpieces out = {0};
		struct err e = {0};
		char text[65] = {0};
		for (int i = 0; i < 64; i++) {
			state = state * 1664525 + 1013904223;
			text[i] = (char)(state >> 24);
		}
		CHECK(!bpe_encode(b, text, &out, &e), "%s", e.message);
		for (size_t k = 0; k < out.n; k++)
			wrong += out.ids[k] < 0 || out.ids[k] >= (int32_t)b->vocab.n;
		char *read = merges_print(b, out.ids, out.n, &e);
		CHECK(read && (!out.n || *read), "%s", e.message);
		free(read);
		free(out.ids);
	}
	CHECK(wrong == 0, "%zu ids are not of the vocabulary", wrong);
}

/* A word of a million letters takes no more than a word's time for each: seconds where it were quadratic. */
static void long_word(const struct bpe *b)
{
	enum { LONG = 1000000 };
	char *text = malloc(LONG + 1);
	struct wordpieces out = {0};
	struct err e = {0};

	for (size_t i = 0; i < LONG; i++)
		text[i] = "the"[i % 3];
	text[LONG] = 0;
	CHECK(!bpe_encode(b, text, &out, &e), "%s", e.message);
	CHECK(out.n > 0 && out.n < LONG, "%zu tokens", out.n);
	free(out.ids);
	free(text);
}

int main(void)
{
	struct bpe b;
	struct err e = {0};

	if (!CHECK(!merges_read(&b, GOLDEN, 634, &e), "%s", e.message))
		return unit_end();
	as_published(&b);
	known_texts(&b);
	letters();
	any_bytes(&b);
	long_word(&b);
	bpe_free(&b);
	return unit_end();
}
