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
		offsets, words, middle, cut, NULL};
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

/* To a copy of the example from a file: an object of the name of its third, and one that it has not. */
static void another_model_is_added(void)
{
	static int64_t more_indptr[] = {0, 1, 3}, more_offsets[] = {0, 1, 2};
	static int32_t more_index[] = {6, 2, 3}, more_object[] = {1, 0};
	static float more_share[] = {0.5f, 1, 1}, more_sure[] = {1, 1}, more_words[] = {4, 5, 6, 7};
	static char *more_names[] = {"\xe7\x93\xb6", "lid"}, *more_texts[] = {"lid", "the bottle"};
	const struct lifted in = example(), more = {7, 2, more_names, more_sure, more_indptr, more_index,
						    more_share, 2, 2, more_object, more_texts, more_texts,
						    more_offsets, more_words, more_words, NULL, NULL};
	struct lifted l;
	struct origin of;
	struct err e = {0};

	CHECK(!lifted_write(&in, &(struct origin){0}, path, "", &e) && !lifted_read(&l, &of, path, &e), "%s",
		e.message);
	if (!CHECK(!lifted_add(&l, &more, &e), "%s", e.message))
		return;
	CHECK(l.objects == 4 && !strcmp(l.names[0], "red cup") && !strcmp(l.names[2], names[2]) &&
			!strcmp(l.names[3], "lid"),
		"%zu objects", l.objects);
	CHECK(l.indptr[1] == 2 && l.indptr[2] == 2 && l.indptr[3] == 3 && l.indptr[4] == 5 &&
			l.index[2] == 6 && l.index[4] == 3,
		"Gaussians");
	CHECK(l.cut[0] == cut[0] && l.cut[3] == LIFTED_CUT && l.share[2] == 0.5f, "cuts and shares");
	/* the sentences of the third object of before are gone with it */
	CHECK(l.sentences == 3 && l.object[0] == 0 && l.object[1] == 3 && l.object[2] == 2 &&
			!strcmp(l.texts[2], "the bottle"),
		"%zu sentences", l.sentences);
	CHECK(l.offsets[1] == 0 && l.offsets[2] == 1 && l.offsets[3] == 2 && l.words[2] == 6 &&
			lifted_middle(&l, 1)[1] == 5,
		"words");
	lifted_free(&l);
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
	another_model_is_added();
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
