#include "unit.h"

#include "formats/scene/lifted.h"

#include <unistd.h>

static char path[] = "/tmp/test_lifted.XXXXXX";

static int64_t indptr[] = {0, 2, 2, 5}, offsets[] = {0, 2, 2, 3};
static int32_t index_of[] = {1, 4, 0, 1, 6}, object[] = {2, 0, 2};
static float share[] = {1, 0.4f, 0.001f, 51.f / 255, 1.f / 255}, confidence[] = {0.75f, 0, 1},
	     cut[] = {0.45f, 0.2f, 0.3f};
static float words[] = {1, 2, 3, 0.1f, -65504, 0}, middle[] = {-1, 0.25f, 7, 0.5f, 8, 9};
static char *names[] = {"red cup", "\"pan\"", "\xe7\x93\xb6"};
static char *texts[] = {"a bottle", "", "bottle"}, *pieces[] = {"a bottle", "", "bottle"};

/* Three objects on seven Gaussians, the second on none; three sentences of 2, 0 and 1 words of width 2. */
static struct lifted example(void)
{
	return (struct lifted){7, 3, names, confidence, indptr, index_of, share, 3, 2, object, texts, pieces,
		offsets, words, middle, cut};
}

static void round_trip(void)
{
	const struct lifted in = example();
	const struct origin origin = {{"0123456789abcdef"}, {""}};
	struct lifted out;
	struct origin of;
	struct err e = {0};

	CHECK(!lifted_write(&in, &origin, path, "", &e), "%s", e.message);
	if (!CHECK(!lifted_read(&out, &of, path, &e), "%s", e.message))
		return;
	CHECK(!strcmp(of.scene.hex, origin.scene.hex) && !*of.encoder.hex, "of %s", of.scene.hex);
	CHECK(out.gaussians == 7 && out.objects == 3 && out.sentences == 3 && out.width == 2, "counts");
	CHECK(!memcmp(out.indptr, indptr, sizeof indptr) && !memcmp(out.offsets, offsets, sizeof offsets),
		"offsets");
	CHECK(!memcmp(out.index, index_of, sizeof index_of) && !memcmp(out.object, object, sizeof object),
		"indices");
	for (int k = 0; k < 3; k++)
		CHECK(out.confidence[k] == confidence[k] && out.cut[k] == cut[k] &&
				!strcmp(out.names[k], names[k]) && !strcmp(out.texts[k], texts[k]) &&
				!strcmp(out.pieces[k], pieces[k]),
			"object or sentence %d", k);
	/* the third share is below half a step, and does not become 0 */
	const float steps[] = {255, 102, 1, 51, 1};
	for (int k = 0; k < 5; k++)
		CHECK(out.share[k] == steps[k] / 255, "share %d is %g", k, (double)out.share[k]);
	for (int k = 0; k < 6; k++)
		CHECK(fabsf(out.words[k] - words[k]) <= 0x1p-11f * fabsf(words[k]), "word %d is %g", k,
			(double)out.words[k]);
	CHECK(!memcmp(out.middle, middle, sizeof middle) && lifted_middle(&out, 2) == out.middle + 4,
		"the middle layer's differ");
	lifted_free(&out);
}

/* A model of sentences that another program encoded may have no middle layer, an early one no cuts. */
static void without_middle_and_cuts(void)
{
	struct lifted in = example(), out;
	struct origin of;
	struct err e = {0};

	in.middle = in.cut = NULL;
	CHECK(!lifted_write(&in, &(struct origin){0}, path, "", &e) && !lifted_read(&out, &of, path, &e),
		"%s", e.message);
	CHECK(!out.middle && !lifted_middle(&out, 2), "a middle layer out of nothing");
	CHECK(!out.cut && lifted_cut_of(&out, 1) == LIFTED_CUT, "cuts out of nothing");
	lifted_free(&out);
}

static void responses_are_shares_above_the_cut(void)
{
	const struct lifted l = example();
	float got[7];

	lifted_responses(&l, 0, got);
	for (int i = 0; i < 7; i++)
		CHECK(got[i] == (i == 1		 ? 1
					: i == 4 ? 0.4f
						 : 0) -
					LIFTED_CUT,
			"Gaussian %d: %g", i, (double)got[i]);
	lifted_responses(&l, 1, got);
	for (int i = 0; i < 7; i++)
		CHECK(got[i] == -cut[1], "no Gaussian, %d: %g", i, (double)got[i]);
}

static void refuses_to_write(float *number, float value, const char *expected)
{
	const struct lifted l = example();
	struct err e = {0};
	const float before = *number;

	*number = value;
	CHECK(lifted_write(&l, &(struct origin){0}, path, "", &e) == -1 && e.code == ERR_CHECK &&
			strlen(e.message) > strlen(path) && !strcmp(e.message + strlen(path), expected),
		"expected '%s', got '%s'", expected, e.message);
	*number = before;
}

int main(void)
{
	const int file = mkstemp(path);

	if (!CHECK(file >= 0, "no temporary file"))
		return unit_end();
	close(file);
	round_trip();
	without_middle_and_cuts();
	responses_are_shares_above_the_cut();
	refuses_to_write(&words[3], NAN, ": tensor 'words': item 3 is not finite");
	refuses_to_write(&middle[1], NAN, ": tensor 'middle': item 1 is not finite");
	refuses_to_write(&words[3], 70000, ": tensor 'words': item 3 is 70000, too large for this precision");
	refuses_to_write(&share[1], 0, ": tensor 'share': item 1 is 0");
	refuses_to_write(&share[1], 1.5f, ": tensor 'share': item 1 is 1.5");
	refuses_to_write(&confidence[2], NAN, ": tensor 'confidence': item 2 is nan");
	refuses_to_write(&confidence[2], -0.5f, ": tensor 'confidence': item 2 is -0.5");
	refuses_to_write(&cut[1], 0, ": tensor 'cut': item 1 is 0");
	unlink(path);
	return unit_end();
}
