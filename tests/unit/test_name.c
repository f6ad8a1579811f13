/* What may be a name, and that names become file names which differ where the names do. */
#include "unit.h"

#include "base/mem.h"
#include "base/name.h"
#include "base/utf8.h"

static void fault(const char *name, enum name_kind kind, const char *expected)
{
	char room[NAME_FAULT];
	const char *got = name_fault(name, kind, room);

	CHECK(expected ? got && !strcmp(got, expected) : !got, "'%s': %s, expected %s", name,
		got ? got : "a name", expected ? expected : "a name");
}

static void faults(void)
{
	static const char *const fine[] = {"a", "view 1", "...", ".hidden", "-", "%2F", "a\\b", "\xc3\x9f",
		"\xe6\x9d\xaf", "\xd0\xb2\xd0\xb8\xd0\xb4", "\xf0\x9f\x98\x80"};

	for (size_t i = 0; i < sizeof fine / sizeof *fine; i++) {
		fault(fine[i], NAME_VIEW, NULL);
		fault(fine[i], NAME_DATA, NULL);
	}
	for (int kind = NAME_DATA; kind <= NAME_VIEW; kind++) {
		fault("", (enum name_kind)kind, "is empty");
		fault("ab\n", (enum name_kind)kind, "has a control character at byte 3");
		fault("\177", (enum name_kind)kind, "has a control character at byte 1");
		fault("\xe6\x9d\xaf\xc2\x85", (enum name_kind)kind, "has a control character at byte 4");
		fault("a\xff", (enum name_kind)kind, "is not UTF-8 at byte 2");
		fault("\xed\xa0\x80", (enum name_kind)kind, "is not UTF-8 at byte 1");
	}
	fault("a/b", NAME_DATA, NULL);
	fault("..", NAME_DATA, NULL);
	fault("a/b", NAME_VIEW, "has a slash");
	fault("..", NAME_VIEW, "is '.' or '..'");
	fault(".", NAME_VIEW, "is '.' or '..'");
}

/* Every text of up to three of these bytes, and what it becomes. */
static const char bytes[] = {'.', '/', '%', '2', 'F', 'E', ',', '\n', (char)0xc3, (char)0xa9, (char)0xff};
enum { BYTES = sizeof bytes, TEXTS = 1 + BYTES + BYTES * BYTES + BYTES * BYTES * BYTES };

static void nth_text(int n, char text[4])
{
	int length = 0;

	while (n--) { /* counting with digits that are 1 to BYTES: each text once */
		text[length++] = bytes[n % BYTES];
		n /= BYTES;
	}
	text[length] = 0;
}

static int by_text(const void *a, const void *b)
{
	return strcmp(*(char *const *)a, *(char *const *)b);
}

static void escapes(void)
{
	static char *made[TEXTS];
	char text[8], room[NAME_FAULT];
	struct err e = {0};

	for (int i = 0; i < TEXTS; i++) {
		nth_text(i, text);
		made[i] = name_to_file(text, &e);
		char *view = name_to_view(text, &e), *back = name_from_file(made[i], &e);
		CHECK(back && !strcmp(back, text), "'%s' comes back as '%s'", text, back ? back : e.message);
		free(back);
		CHECK(made[i] && view, "%s", e.message);
		CHECK(!i || !name_fault(made[i], NAME_VIEW, room), "'%s' as a file name is '%s'", text,
			made[i]);
		CHECK(!i || !name_fault(view, NAME_VIEW, room), "'%s' as a view's name is '%s'", text, view);
		CHECK(!strchr(view, ','), "'%s' can be in a list of names", view);
		free(view);
	}
	qsort(made, TEXTS, sizeof *made, by_text);
	int same = 0;
	for (int i = 1; i < TEXTS; i++)
		same += !strcmp(made[i - 1], made[i]);
	CHECK(!same, "%d of %d texts have the file name of another", same, TEXTS);
	for (int i = 0; i < TEXTS; i++)
		free(made[i]);
}

static void becomes(char *(*make)(const char *, struct err *), const char *text, const char *expected)
{
	struct err e = {0};
	char *name = make(text, &e);

	CHECK(name && !strcmp(name, expected), "'%s' becomes '%s'", text, name ? name : e.message);
	free(name);
}

static void known_answers(void)
{
	becomes(name_to_file, "a/b", "a%2Fb");
	becomes(name_to_file, "a%2Fb", "a%252Fb");
	becomes(name_to_file, "the cup, \xe6\x9d\xaf", "the cup, \xe6\x9d\xaf");
	becomes(name_to_file, "..", "%2E%2E");
	becomes(name_to_file, "../x", "..%2Fx");
	becomes(name_to_file, "caf\xe9", "caf%E9");
	becomes(name_from_file, "a%252Fb%2f%", "a%2Fb%2f%");
	becomes(name_from_file, "50%00%4", "50%00%4");
	becomes(name_to_view, "cam1/0001", "cam1_0001");
	becomes(name_to_view, "50%", "50%");
	becomes(name_to_view, "a,b\t", "a%2Cb%09");
	becomes(name_to_view, "..", "%2E%2E");
	becomes(name_to_view, "e\xcc\x81", "\xc3\xa9");
	becomes(name_copy, "e\xcc\x81\xff", "e\xcc\x81\xff");
	becomes(name_decomposed, "\xc3\xa9", "e\xcc\x81");
}

int main(void)
{
	faults();
	escapes();
	known_answers();
	return unit_end();
}
