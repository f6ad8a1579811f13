/* refer.features and its numbers: what is written comes back, to the bit. */
#include "unit.h"

#include "formats/scene/features.h"

#include <unistd.h>

static char path[] = "/tmp/test_features.XXXXXX";
static const float reliability[2] = {0.75f, 0}, weight[2] = {12.5f, 0};

static int round_trip(const struct features *f, struct features *back)
{
	struct err e = {0};

	return CHECK(!features_write(f, path, "--prune 0", &e) && !features_open(back, path, &e), "%s",
		       e.message) &&
	       CHECK(back->gaussians == 2 && back->channels == f->channels &&
			       !memcmp(back->reliability, reliability, sizeof reliability) &&
			       !memcmp(back->weight, weight, sizeof weight) &&
			       !strcmp(back->scene.hex, f->scene.hex),
		       "comes back");
}

static void test_round_trips(void)
{
	const uint16_t half[4] = {0x3800, 0xb800, 0, 0};
	const float single[4] = {0.5f, -0.5f, 0, 0};
	const int32_t labels[2] = {7, -1};
	struct features f = {.gaussians = 2,
		.channels = 2,
		.values = half,
		.is_half = 1,
		.reliability = reliability,
		.weight = weight,
		.scene = {"0123456789abcdef"}};
	struct features back;
	float floats[4];

	if (round_trip(&f, &back)) {
		features_floats(&back, 0, 2, floats);
		CHECK(back.is_half && !memcmp(floats, single, sizeof single), "halves: %g",
			(double)floats[0]);
		features_floats(&back, 1, 1, floats);
		CHECK(floats[0] <= 0 && floats[1] <= 0, "the second row: %g", (double)floats[0]);
	}
	features_close(&back);
	f.values = single;
	f.is_half = 0;
	if (round_trip(&f, &back)) {
		features_floats(&back, 0, 2, floats);
		CHECK(!back.is_half && !memcmp(floats, single, sizeof single), "floats: %g",
			(double)floats[0]);
	}
	features_close(&back);
	f.channels = 0;
	f.labels = labels;
	if (round_trip(&f, &back))
		CHECK(back.labels && !memcmp(back.labels, labels, sizeof labels), "labels");
	features_close(&back);
	f.labels = NULL;
	f.channels = 2;
	f.values = half;
	f.is_half = 1;
	round_trip(&f, &back);
	features_close(&back);
}

int main(void)
{
	const int fd = mkstemp(path);

	if (fd < 0)
		return 1;
	close(fd);
	test_round_trips();
	unlink(path);
	return unit_end();
}
