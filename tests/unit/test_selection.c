/* refer.selection: what is written comes back, and becomes responses. */
#include "unit.h"

#include "answer/responses.h"
#include "formats/scene/selection.h"

#include <unistd.h>

static char path[] = "/tmp/test_selection.XXXXXX";

static void test_round_trip(void)
{
	char cup[] = "cup-1", none[] = "none", *refs[] = {cup, none};
	int64_t indptr[] = {0, 2, 2};
	int32_t index[] = {1, 3};
	const struct selection s = {4, 2, refs, indptr, index, {"0123456789abcdef"}};
	struct selection back;
	struct err e = {0};

	if (!CHECK(!selection_write(&s, path, "--rule cosine", &e) && !selection_read(&back, path, &e), "%s",
		    e.message))
		return;
	CHECK(back.gaussians == 4 && back.n == 2 && !memcmp(back.indptr, indptr, sizeof indptr) &&
			!memcmp(back.index, index, sizeof index) && !strcmp(back.refs[0], cup) &&
			!strcmp(back.refs[1], none) && !strcmp(back.scene.hex, s.scene.hex),
		"comes back");
	selection_free(&back);
}

static void test_responses(void)
{
	const int64_t indptr[] = {0, 2, 2, 3};
	const int32_t index[] = {1, 3, 0};
	const struct responses_selection s = {4, indptr, index};
	const size_t row[] = {2, 0};
	struct responses a;
	struct err e = {0};
	int32_t ids[4];
	float responses[4];

	if (!CHECK(!responses_selected(&a, &s, row, 2, &e), "%s", e.message))
		return;
	CHECK(a.answers == 2 && a.answer[1] == 1 && !a.sure && !a.begin, "answers");
	CHECK(responses_gaussians(&a, 4, 0, ids, responses) == 1 && ids[0] == 0, "row 2 has Gaussian 0");
	CHECK(responses_gaussians(&a, 4, 1, ids, responses) == 2 && ids[0] == 1 && ids[1] == 3 &&
			fabs((double)responses[0] - 0.5) < 1e-7,
		"row 0 has Gaussians 1 and 3");
	responses_free(&a);
}

int main(void)
{
	const int fd = mkstemp(path);

	if (fd < 0)
		return 1;
	close(fd);
	test_round_trip();
	test_responses();
	unlink(path);
	return unit_end();
}
