// All unit tests in one program: it runs the test that it is called by (build/unit/test_rle), or that its
// first argument names. tests.def is made by the Makefile, a line a test. Each test is the main of a file.
#include <stdio.h>
#include <string.h>

#include "unit.h"

#define TEST(name) int main_of_##name(void);
#include "tests.def"
#undef TEST

static const struct {
	const char *name;
	int (*run)(void);
} tests[] = {
#define TEST(name) {#name, main_of_##name},
#include "tests.def"
};

char **unit_arguments;

// The status of a test, with these arguments; -1: there is no test of this name.
static int run(const char *name, char **arguments)
{
	unit_arguments = arguments;
	for (size_t i = 0; i < sizeof tests / sizeof *tests; i++)
		if (!strcmp(tests[i].name, name))
			return tests[i].run();
	return -1;
}

int main(int argc, char **argv)
{
	if (argc < 1)
		return 2;
	const char *slash = strrchr(argv[0], '/');
	int status = run(slash ? slash + 1 : argv[0], argv + 1);
	if (status < 0 && argc > 1)
		status = run(argv[1], argv + 2);
	if (status < 0)
		fprintf(stderr, "usage: %s test_NAME\n", argv[0]);
	return status < 0 ? 2 : status;
}
