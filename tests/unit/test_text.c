#include "unit.h"

#include "base/mem.h"
#include "base/utf8.h"
#include "formats/arrays/metalist.h"
#include "formats/scene/text.h"

#include <unistd.h>

static char path[] = "/tmp/test_text.XXXXXX";

/* Through void, as floats are meant to be compared to the bit here. */
static int same_bytes(const void *a, const void *b, size_t n)
{
	return !memcmp(a, b, n);
}

static void utf8_known_cases(void)
{
	static const struct {
		const char *bytes;
		size_t first_bad;
	} cases[] = {{"plain", 5}, {"\xc3\xa9\xe2\x82\xac\xf0\x9f\x98\x80", 9}, {"a\xc0\x80", 1},
		{"\xe0\x80\xaf", 0}, {"\xed\xa0\x80", 0}, {"\xf4\x90\x80\x80", 0}, {"ab\xe2\x82", 2},
		{"\x80", 0}, {"\xf8\x88\x80\x80\x80", 0}};
	size_t at = 0;

	for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
		size_t bad = utf8_check(cases[i].bytes, strlen(cases[i].bytes));
		CHECK(bad == cases[i].first_bad, "case %zu: first bad byte %zu", i, bad);
	}
	CHECK(utf8_next("\xe2\x82", 2, &at) == 0xfffd && at == 1,
		"a cut character is U+FFFD, one byte, at %zu", at);
}

static void utf8_plain_forms(void)
{
	/* blanks: unbroken, thin, wide; nothing: of no width, a soft hyphen; a wide letter; e and an acute */
	char text[] = {"a\xc2\xa0"
		       "b\xe2\x80\x89"
		       "c\xe3\x80\x80"
		       "d\xe2\x80\x8b"
		       "e\xc2\xad"
		       "f\xef\xbd\x87"
		       "e\xcc\x81"};

	utf8_plain(text);
	CHECK(!strcmp(text, "a b c defg\xc3\xa9"), "plain text is '%s'", text);
}

static void utf8_round_trip(void)
{
	size_t wrong = 0;
	char bytes[4];

	for (uint32_t c = 0; c <= 0x10ffff; c++) {
		size_t at = 0, n = utf8_put(bytes, c);
		if ((c < 0xd800 || c > 0xdfff) && (utf8_next(bytes, n, &at) != c || at != n))
			wrong++;
	}
	CHECK(wrong == 0, "%zu characters change on the way through UTF-8", wrong);
}

/* The names in object_lists of a sentence; *has 0 where it has no such list. */
static char **object_list(const struct text *t, size_t sentence, size_t *n, int *has)
{
	char reason[METALIST_REASON];
	const char *list = t->object_lists ? t->object_lists[sentence] : "";

	*n = 0;
	*has = *list != 0;
	return metalist_parse(*has ? list : "[]", n, reason);
}

/* A list of one, an empty list, and none. */
static void check_object_lists(const struct text *t)
{
	static const struct {
		size_t n;
		int has;
	} expected[] = {{1, 1}, {0, 1}, {0, 0}};

	for (size_t i = 0; i < 3; i++) {
		size_t n;
		int has;
		char **names = object_list(t, i, &n, &has);
		CHECK(names && n == expected[i].n && has == expected[i].has, "list %zu: %zu, %d", i, n, has);
		CHECK(!n || !strcmp(names[0], "cup"), "a name of list %zu differs", i);
		mem_free_strings(names, n);
	}
}

/* Three sentences of 2, 0 and 1 words of width 3. */
static void text_round_trip(void)
{
	int64_t offsets[] = {0, 2, 2, 3};
	float words[] = {1, 2, 3, 3, 4, 5, -1, 0.5f, 0.25f}, middle[] = {9, 8, 7, 6, 5, 4, 3, 2, -0.125f},
	      means[] = {2, 3, 4, 0, 0, 0, -1, 0.5f, 0.25f};
	char *refs[] = {"r1", "r2", "r3"}, *objects[] = {"cup", "cup", "\xe7\x93\xb6"};
	char *texts[] = {"a \"red\" cup\n", "", "bottle"};
	char *pieces[] = {"a ##b", "", "bottle"};
	enum camera_split splits[] = {SPLIT_TRAIN, SPLIT_TEST, SPLIT_TRAIN};
	char *lists[] = {"[\"cup\"]", "[]", ""}, *views[] = {"", "v1", ""},
	     *kinds[] = {"plain", "absent", ""};
	struct text in = {.n = 3,
		.width = 3,
		.offsets = offsets,
		.words = words,
		.middle = middle,
		.sentences = means,
		.refs = refs,
		.objects = objects,
		.texts = texts,
		.pieces = pieces,
		.splits = splits,
		.object_lists = lists,
		.views = views,
		.kinds = kinds,
		.encoder = {"fedcba9876543210"}};
	struct text out;
	struct err e = {0};

	CHECK(!text_write(&in, path, "--model x", &e), "%s", e.message);
	if (!CHECK(!text_read(&out, path, &e), "%s", e.message))
		return;
	CHECK(!strcmp(out.encoder.hex, in.encoder.hex), "encoder %s", out.encoder.hex);
	CHECK(out.n == 3 && out.width == 3, "n %zu width %d", out.n, out.width);
	CHECK(same_bytes(out.offsets, offsets, sizeof offsets), "offsets differ");
	CHECK(same_bytes(out.words, words, sizeof words), "words differ");
	CHECK(same_bytes(out.middle, middle, sizeof middle) && text_middle(&out, 2) == out.middle + 6,
		"the middle layer's differ");
	CHECK(same_bytes(out.sentences, means, sizeof means), "sentences differ");
	CHECK(same_bytes(out.splits, splits, sizeof splits), "splits differ");
	for (int i = 0; i < 3; i++)
		CHECK(!strcmp(out.refs[i], refs[i]) && !strcmp(out.objects[i], objects[i]) &&
				!strcmp(out.texts[i], texts[i]) && !strcmp(out.pieces[i], pieces[i]) &&
				!strcmp(out.object_lists[i], lists[i]) && !strcmp(out.views[i], views[i]) &&
				!strcmp(out.kinds[i], kinds[i]),
			"names of sentence %d differ", i);
	check_object_lists(&out);
	char chosen[3] = {0};
	CHECK(!text_mark(&out, "r3,r1,r3", "--refs", chosen, &e) && chosen[0] && !chosen[1] && chosen[2],
		"text_mark");
	CHECK(text_mark(&out, "r1,r,r2", "--refs", chosen, &e) == -1 && e.code == ERR_USAGE &&
			!strcmp(e.message, "--refs: no sentence 'r'; there are 3: r1, r2, r3") && !chosen[1],
		"an unknown ref: %s", e.message);
	text_free(&out);
}

/* Writes a text that breaks one rule; the reader's message must end with `expected`. */
static void expect(const struct text *t, const char *expected)
{
	struct text out;
	struct err e = {0};

	CHECK(!text_write(t, path, "", &e), "%s", e.message);
	const int bad = text_read(&out, path, &e);
	text_free(&out);
	if (!CHECK(bad, "'%s' was accepted", expected))
		return;
	size_t have = strlen(e.message), want = strlen(expected);
	CHECK(e.code == ERR_FORMAT && have > want && !strcmp(e.message + have - want, expected), "%s",
		e.message);
}

static void text_broken_rules(void)
{
	int64_t falling[] = {0, 2, 1}, late[] = {1, 1, 1};
	float words[] = {1, 2}, infinite[] = {1, INFINITY}, means[] = {1, 2};
	char *refs[] = {"r1", "r2"}, *same[] = {"r1", "r1"}, *bad[] = {"r1", "\xff"};
	enum camera_split splits[] = {SPLIT_TRAIN, SPLIT_TRAIN};
	struct text t = {.n = 2,
		.width = 1,
		.offsets = (int64_t[]){0, 1, 2},
		.words = infinite,
		.sentences = means,
		.refs = refs,
		.objects = refs,
		.texts = refs,
		.splits = splits};

	expect(&t, ": tensor 'words': item 1 is not finite");
	t.words = words;
	t.refs = same;
	expect(&t, ": metadata 'refs': 'r1' appears twice");
	t.refs = refs;
	t.texts = bad;
	expect(&t, ": metadata 'texts': entry 1 is not a UTF-8 string");
	t.texts = refs;
	t.object_lists = (char *[]){"[]", "{}"};
	expect(&t, ": metadata 'object_lists': entry 1 is not a JSON list of names");
	t.object_lists = (char *[]){"[1]", ""};
	expect(&t, ": metadata 'object_lists': entry 0 is not a JSON list of names");
	t.object_lists = NULL;
	t.offsets = late;
	expect(&t, ": tensor 'offsets': begins with 1, expected 0");
	t.offsets = falling;
	expect(&t, ": tensor 'offsets': falls from 2 to 1 at entry 2");
}

int main(void)
{
	int fd = mkstemp(path);

	if (fd < 0)
		return 1;
	close(fd);
	utf8_known_cases();
	utf8_plain_forms();
	utf8_round_trip();
	text_round_trip();
	text_broken_rules();
	unlink(path);
	return unit_end();
}
