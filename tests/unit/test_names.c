#include "unit.h"

#include "base/names.h"

#include <stddef.h>

struct item {
	int before;
	char *name;
};

static void places_are_those_of_a_search(void)
{
	static char b[] = "b", a[] = "a", ab[] = "ab", none[] = "", e_acute[] = "\xc3\xa9";
	const struct item items[] = {
		{1, b}, {1, a}, {1, NULL}, {1, ab}, {1, e_acute}, {1, b}, {1, none}, {1, a}};
	const size_t n = sizeof items / sizeof *items;
	struct names names;
	struct err e = {0};
	size_t earlier = 99;

	CHECK(!names_make(&names, items, sizeof *items, offsetof(struct item, name), n, &e), "%s", e.message);
	CHECK(names.n == 7 && names_count(&names) == 5, "%zu %zu", names.n, names_count(&names));
	for (size_t i = 0; i < n; i++) {
		size_t expected = 0;
		if (!items[i].name)
			continue;
		while (!items[expected].name || strcmp(items[expected].name, items[i].name) != 0)
			expected++;
		CHECK(names_find(&names, items[i].name) == expected, "'%s'", items[i].name);
	}
	CHECK(names_find(&names, "abc") == NAMES_NONE && names_find(&names, "c") == NAMES_NONE, "not there");
	CHECK(names_find_part(&names, &(struct list_name){"abc", 2}) == 3, "the part of a text");
	CHECK(names_twice(&names, &earlier) == 5 && earlier == 0, "%zu %zu", names_twice(&names, &earlier),
		earlier);
	names_free(&names);
	CHECK(!names_make(&names, items, sizeof *items, offsetof(struct item, name), 5, &e) &&
			names_twice(&names, &earlier) == NAMES_NONE,
		"all differ");
	names_free(&names);
}

static void lists_mark_places(void)
{
	const char *const texts[] = {"r1", "r2", "r", "r2"};
	char chosen[4] = {0};
	struct err e = {0};

	CHECK(!names_mark(texts, sizeof *texts, 0, 4, "r2,r", "--refs", "sentence", chosen, &e) &&
			!memcmp(chosen, "\0\1\1\0", 4),
		"marked");
	CHECK(!names_mark(texts, sizeof *texts, 0, 4, NULL, "--refs", "sentence", chosen, &e), "no list");
	CHECK(names_mark(texts, sizeof *texts, 0, 4, "r1,r22,r2", "--refs", "sentence", chosen, &e) == -1 &&
			e.code == ERR_USAGE &&
			!strcmp(e.message, "--refs: no sentence 'r22'; there are 4: r, r1, r2, r2") &&
			chosen[0],
		"an unknown name: %s", e.message);
}

static void nothing_has_no_names(void)
{
	struct names names;
	struct err e = {0};
	size_t earlier;

	CHECK(!names_make(&names, NULL, sizeof(char *), 0, 0, &e), "%s", e.message);
	CHECK(names_find(&names, "") == NAMES_NONE && !names_count(&names) &&
			names_twice(&names, &earlier) == NAMES_NONE,
		"none");
	names_free(&names);
}

int main(void)
{
	places_are_those_of_a_search();
	lists_mark_places();
	nothing_has_no_names();
	return unit_end();
}
