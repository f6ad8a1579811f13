/* The choice of an object by a sentence, and of Gaussians for an object: each part by itself
 * (choose_scene.h). */
#include "ask/disambiguate.h"
#include "ask/vocabulary.h"
#include "choose_scene.h"
#include "lang/wordnet.h"
#include "rules_help.h"

/* The objects chosen, as bits. */
static unsigned set_of(const char *text)
{
	unsigned set = 0;

	ask(text, CHOOSE_ALL);
	for (int o = 0; o < OBJECTS; o++)
		set |= (unsigned)chosen[o] << o;
	return set;
}

/* Puts the tin beside mug `beside` (0 or 1), or back. */
static void move_tin(int beside, int back)
{
	const double by[2] = {beside ? 1.2 : -1.2, 3};

	for (int i = 3 * EACH; i < 4 * EACH; i++)
		for (int d = 0; d < 2; d++)
			means[3 * i + d] += (float)(back ? -by[d] : by[d]);
}

/* The mug that has nothing near it is the other one than that beside the tin: near, denied, and no anchor, as
 * the networks parse "by itself". */
static void by_itself(void)
{
	for (int beside = 0; beside < 2; beside++) {
		move_tin(beside, 0);
		const int best = ask("the mug that is not near", CHOOSE_ALL);
		CHECK(best == !beside, "the tin by mug %d: %d", beside, best);
		move_tin(beside, 1);
	}
}

/* As many of an end as are counted. */
static void counted(void)
{
	for (int beside = 0; beside < 2; beside++) {
		move_tin(beside, 0);
		const unsigned two = set_of("the two leftmost things"),
			       three = set_of("the three leftmost things");
		CHECK(two == (beside ? 5U : 9U), "the tin by mug %d, two: %u", beside, two);
		CHECK(three == 13, "the tin by mug %d, three: %u", beside, three);
		move_tin(beside, 1);
	}
}

static void parts(void)
{
	CHECK(ask("the wooden thing", WORDS) == 2 && probability[2] > 0.4, "words");
	CHECK(ask("the crate", WORDS | NAMES) == 2 && probability[2] > 0.9, "names");
	CHECK(ask("the red thing", COLOURS) == 2 && probability[2] > 0.8, "colours");
	CHECK(ask("the large thing", SIZES) == 2 && ask("the small thing", SIZES) != 2, "sizes");
	CHECK(ask("the dull can", SENTENCE) == 3 && probability[3] > 0.99, "a training sentence");
	CHECK(ask("the thing nearest to us", RELATIONS) == 3 && probability[3] > 0.8, "relations");
	CHECK(ask("the thing to the left of the box", WORDS | RELATIONS) == 0, "an anchor");
	CHECK(ask("the thing to the right of the box", WORDS | RELATIONS) == 1, "an anchor");
	CHECK(ask("the thing to the right of the crate", WORDS | NAMES | RELATIONS) == 1,
		"an anchor by its name");
	CHECK(ask("the shiny mug on the right", CHOOSE_ALL) == 1,
		"shiny is only said of the other, which looks the same");
	ask("the mug", CHOOSE_ALL);
	float sum = 0;
	for (int o = 0; o < OBJECTS; o++)
		sum += probability[o];
	CHECK(fabsf(sum - 1) < 1e-5F, "one thing is meant, with %g in all", (double)sum);
}

/* A colour in a name is said of its thing, whichever of two that look the same it is. */
static void named_colours(void)
{
	static const char *const asked[] = {"the teal mug", "the plum mug", "the plum cup"};
	static char *const named[2][2] = {{"Teal mug", "plum-mug 2"}, {"plum_mug", "teal mug 2"}};
	char *const old[2] = {names[0], names[1]};

	for (int k = 0; k < 2; k++) {
		memcpy(names, named[k], sizeof named[k]);
		for (int i = 0; i < 3; i++)
			CHECK(ask(asked[i], CHOOSE_ALL) == (k ^ (i > 0)), "'%s', %s", asked[i], named[k][0]);
		CHECK(set_of("all teal mugs") == 1U << k, "%x", set_of("all teal mugs"));
		ask("something plum", CHOOSE_ALL);
		const double colour = choice.there;
		ask("the plum", CHOOSE_ALL);
		CHECK(choice.there < 0.5 * colour, "a fruit is no colour: %g, %g", choice.there, colour);
		/* the first colour is the thing's, the second may be of its rim */
		ask("the teal mug that is red", CHOOSE_ALL);
		CHECK(choice.there > 0.5, "a part of it is red: %g", choice.there);
		ask("the red mug that is teal", CHOOSE_ALL);
		CHECK(choice.there < 0.1, "a part of it is teal: %g", choice.there);
	}
	memcpy(names, old, sizeof old);
}

/* A noun of two words that is known as one is another thing than its second word alone names, unless it is a
 * kind of that or the first is said of the thing. */
static void kinds_of_two_words(void)
{
	if (!wordnet_is_there())
		return;
	ask("the mug", CHOOSE_ALL);
	const double mug = choice.there;
	best_of_roles("the beer mug", ". N T", PARSE_OTHER);
	const double beer = choice.there;
	best_of_roles("the voice box", ". N T", PARSE_OTHER);
	CHECK(mug > beer && beer > 0.5 && choice.there < 0.5, "a mug is there %g, a kind of it %g, no box %g",
		mug, beer, choice.there);
	ask("the ice cream", CHOOSE_ALL);
	CHECK(choice.there < 0.1, "no cream thing: %g", choice.there);
	char *old[OBJECTS];
	memcpy(old, names, sizeof old);
	names[3] = "mouse pad";
	CHECK(ask("the mousepad", CHOOSE_ALL) == 3 && choice.there > 0.9, "joined: %g", choice.there);
	CHECK(ask("the mouse mat", CHOOSE_ALL) == 3 && choice.there > 0.5, "its line: %g", choice.there);
	memcpy(names, old, sizeof old);
}

/* What is left out may be an attribute alone; "the other one" is of the kind that was spoken of. */
static void left_out(void)
{
	CHECK(!wordnet_is_there() || set_of("all things that are not wooden") == (1 | 2 | 8), "%x",
		set_of("all things that are not wooden"));
	CHECK(set_of("not the left mug , the other one") == 2, "%x",
		set_of("not the left mug , the other one"));
	CHECK(set_of("not the right mug , the other one") == 1, "%x",
		set_of("not the right mug , the other one"));
}

/* Anchors never count for the target; what is said of something that is no object says nothing. */
static void anchors(void)
{
	CHECK(ask("the mug to the left of the crate", CHOOSE_ALL) == 0, "the mug");
	CHECK(ask("the crate to the right of the mug", CHOOSE_ALL) == 2, "the crate");
	ask("the mug to the left of the zeppelin", CHOOSE_ALL & ~(unsigned)SENTENCE);
	const float left = probability[0] / probability[1];
	ask("the mug", CHOOSE_ALL & ~(unsigned)SENTENCE);
	CHECK(fabsf(left / (probability[0] / probability[1]) - 1) < 0.5F, "%g against %g", (double)left,
		(double)(probability[0] / probability[1]));
}

/* Several objects, and which order they are in does not matter. */
static void sets(void)
{
	CHECK(set_of("the mugs") == 3 && choice.is_several, "the mugs: %x", set_of("the mugs"));
	CHECK(set_of("both mugs") == 3, "both mugs: %x", set_of("both mugs"));
	CHECK(set_of("all mugs except the left one") == 2, "%x", set_of("all mugs except the left one"));
	CHECK(set_of("the second mug from the left") == 2, "%x", set_of("the second mug from the left"));
	CHECK(set_of("the second mug from the right") == 1, "%x", set_of("the second mug from the right"));
	/* what is left out is all of its kind, unless it is told which; what is unknown is nothing */
	CHECK(set_of("all things except the mug") == (4 | 8), "%x", set_of("all things except the mug"));
	CHECK(set_of("all things except the zeppelin") == 15, "%x", set_of("all things except the zeppelin"));
	/* what is nothing here leaves nothing out, and nothing is beside it */
	static const char *const denied[] = {"the box but not the one by the zeppelin",
		"the box that is not next to the zeppelin", "the box between the tin and the zeppelin"};
	for (size_t i = 0; i < sizeof denied / sizeof *denied; i++)
		CHECK(set_of(denied[i]) == 4 && choice.there > 0.5, "'%s': %x, %g", denied[i],
			set_of(denied[i]), choice.there);
	CHECK(set_of("all mugs that are not on the table") == 0 || choice.there < 0.5, "%x, %g",
		set_of("all mugs that are not on the table"), choice.there);
	CHECK(set_of("whatever is behind the tin") == (1 | 2 | 4), "%x",
		set_of("whatever is behind the tin"));
	/* what an ordinal counts along: an end that is named, a superlative */
	static const struct {
		const char *text;
		unsigned meant;
	} counted[] = {{"the second mug on the left", 2}, {"the first thing behind the tin", 1 | 2},
		{"the second largest thing", 1 | 2 | 8}};
	for (size_t i = 0; i < sizeof counted / sizeof *counted; i++)
		CHECK(set_of(counted[i].text) & counted[i].meant, "'%s': %x", counted[i].text,
			set_of(counted[i].text));
	CHECK(best_of_roles("the last mug on the left", ". . T . . P", PARSE_LEFT) == 0, "the last");
}

static void absent(void)
{
	ask("the red slab", CHOOSE_ALL & ~SENTENCE);
	CHECK(choice.there > 0.5, "a shape: %g", choice.there);
	ask("the red slab of butter", CHOOSE_ALL & ~SENTENCE);
	CHECK(choice.there < 0.5, "a name: %g", choice.there);
	ask("the large wooden box", CHOOSE_ALL);
	CHECK(choice.there > 0.8, "what is there has %g", choice.there);
	ask("the violet zeppelin", CHOOSE_ALL);
	CHECK(choice.there < 0.2, "what is not there has %g", choice.there);
	ask("the green crate", CHOOSE_ALL);
	CHECK(choice.there < 0.5, "a colour that it has not: %g", choice.there);
	ask("the mug on top of the tin", CHOOSE_ALL);
	CHECK(choice.there < 0.65, "a relation that is not so: %g", choice.there);
	ask("the second crate from the left", CHOOSE_ALL);
	CHECK(choice.there < 0.65, "there is but one crate: %g", choice.there);
	CHECK(set_of("all things") == 15 && choice.there > 0.8, "all things: %x, %g", set_of("all things"),
		choice.there);
	CHECK(set_of("") == 0 && choice.there == 0, "no words mean nothing");
}

/* Several at once are as one by one; pieces may be unknown. */
static void many(void)
{
	static float a[MOST * WIDTH], b[MOST * WIDTH];
	const struct choose_sentence s[] = {
		{"the red box", "the red box", a, NULL, encode("the red box", a), {0}, NULL, 0},
		{"another", NULL, b, NULL, encode("the dull can", b), {0}, NULL, 0}};
	float both[2 * OBJECTS];
	char of_both[2 * OBJECTS];
	struct choice two[2];
	struct err e;

	if (!CHECK(!choose(&scene, s, 2, CHOOSE_ALL, two, both, of_both, NULL, &e), "%s", e.message))
		return;
	ask("the red box", CHOOSE_ALL);
	CHECK(!memcmp(both, probability, sizeof probability), "one of two differs from it alone");
	CHECK(both[OBJECTS + 3] > 0.25F && both[OBJECTS + 3] > both[OBJECTS], "without pieces: %g",
		(double)both[OBJECTS + 3]);
	const struct lifted none = {.gaussians = N, .width = WIDTH, .indptr = indptr, .offsets = offsets};
	const struct choose_scene empty = {&none, &splats, &cameras, &parser, 1, NULL};
	CHECK(!choose(&empty, s, 2, CHOOSE_ALL, two, both, of_both, NULL, &e), "a model without objects");
}

/* What is kept from one call to the next changes nothing, whatever was asked before and from where. */
static void kept(void)
{
	static const char *const asked[] = {
		"the red box", "the mug left of the crate", "", "the mugs", "the red box"};
	static float vectors[MOST * WIDTH];
	struct viewpoint from = {.kind = VIEWPOINT_POINT, .point = {0, 10, 1}};
	float of_kept[OBJECTS], alone[OBJECTS];
	char chosen_kept[OBJECTS], chosen_alone[OBJECTS];
	struct choice with, without;
	struct err e;
	struct chooser *c = chooser_make(&scene, CHOOSE_ALL, &e);

	if (!CHECK(c, "%s", e.message))
		return;
	for (int i = 0; i < 10; i++) {
		const char *text = asked[i / 2];
		from.kind = i % 2 ? VIEWPOINT_POINT : VIEWPOINT_USUAL;
		const struct choose_sentence s = {
			text, text, vectors, NULL, encode(text, vectors), from, NULL, 0};
		CHECK(!choose_with(c, &s, 1, &with, of_kept, chosen_kept, NULL, &e) &&
				!choose(&scene, &s, 1, CHOOSE_ALL, &without, alone, chosen_alone, NULL, &e),
			"'%s': %s", text, e.message);
		CHECK(!memcmp(of_kept, alone, sizeof alone) &&
				!memcmp(chosen_kept, chosen_alone, sizeof chosen_alone) &&
				!memcmp(&with.there, &without.there, sizeof with.there) &&
				with.is_several == without.is_several,
			"'%s' after %d others differs from it alone", text, i);
	}
	chooser_free(c);
	chooser_free(NULL);
}

/* A copy whose shares can be moved. */
static struct lifted copy(int64_t copied_indptr[OBJECTS + 1], int32_t copied_index[N], float copied_share[N],
	float copied_confidence[OBJECTS])
{
	struct lifted l = lifted;

	memcpy(copied_indptr, indptr, sizeof indptr);
	memcpy(copied_index, index_of, sizeof index_of);
	memcpy(copied_share, share, sizeof share);
	memcpy(copied_confidence, confidence, sizeof confidence);
	l.indptr = copied_indptr;
	l.index = copied_index;
	l.share = copied_share;
	l.confidence = copied_confidence;
	return l;
}

static struct disambiguated found[OBJECTS];

/* How many change places; -1: it failed. */
static int count_moved(struct lifted *l, size_t named, const char *is_fixed)
{
	int moved = 0;
	struct err e;

	if (disambiguate(l, named, is_fixed, &splats, &cameras, &parser, found, &e))
		return -1;
	for (size_t o = 0; o < named; o++)
		moved += found[o].is_moved;
	return moved;
}

/* Two mugs that have each other's Gaussians get their own, as one of them is left of the crate; what is as it
 * should be stays, and so does a crate that is called a tin, if all of its words are a tin's. */
static void twins(void)
{
	int64_t at[OBJECTS + 1];
	int32_t index[N];
	float shares[N], sure[OBJECTS];
	struct lifted l = copy(at, index, shares, sure);

	CHECK(count_moved(&l, OBJECTS, "\0\0\0\0\0\0\0\0") == 0, "something moved in a right model");
	CHECK(!memcmp(index, index_of, sizeof index), "a right model changed");
	for (int i = 0; i < 2 * EACH; i++)
		index[i] = (i + EACH) % (2 * EACH);
	sure[1] = 0.5F;
	for (int one = 0; one < 2; one++) { // a person named one of them, and that is enough
		const char is_fixed[OBJECTS] = {(char)!one, (char)one};
		CHECK(count_moved(&l, OBJECTS, is_fixed) == 0 && index[0] == EACH && index[EACH] == 0,
			"a label that a person gave is another's");
	}
	CHECK(count_moved(&l, OBJECTS, "\0\0\0\0\0\0\0\0") == 2, "not two have moved");
	CHECK(!memcmp(index, index_of, sizeof index) && at[1] == EACH, "the mugs have not changed places");
	CHECK(sure[0] == 0.5F && sure[1] == 1, "confidence stays with the Gaussians");
	const struct lifted none = {.gaussians = N, .width = WIDTH, .indptr = indptr, .offsets = offsets};
	struct lifted empty = none;
	CHECK(count_moved(&empty, 0, "") == 0, "a model without objects");
}

/* A mug that is where the tin is gets its own Gaussians, which no sentence names; what is as it should be
 * stays, whatever is spare. Of two lots at one place it gets the one whose masks agree. */
static void spare(void)
{
	static char *nameless[] = {"mug", "mug 2", "crate", ""},
		    *said[] = {"the white one to the left of the crate", "the leftmost white one",
			    "the one to the right of the crate", "the wooden crate"};
	static float said_words[4 * 16 * WIDTH];
	int64_t said_offsets[5] = {0};
	int64_t at[OBJECTS + 1];
	int32_t index[N];
	float shares[N], sure[OBJECTS];
	struct lifted l = copy(at, index, shares, sure);

	for (int r = 0; r < 4; r++)
		said_offsets[r + 1] =
			said_offsets[r] + (int64_t)encode(said[r], said_words + said_offsets[r] * WIDTH);
	l.names = nameless;
	l.texts = l.pieces = said;
	l.offsets = said_offsets;
	l.words = said_words;
	l.sentences = 4;
	CHECK(count_moved(&l, 3, "\0\0\0\0\0\0\0\0") == 0, "something moved in a right model");
	CHECK(!memcmp(index, index_of, sizeof index), "a right model changed");
	for (int i = 0; i < EACH; i++) {
		index[i] = i + 3 * EACH;
		index[i + 3 * EACH] = i;
	}
	sure[3] = 0.5F;
	CHECK(count_moved(&l, 3, "\0\0\0\0\0\0\0\0") == 1, "not one moved");
	CHECK(!memcmp(index, index_of, sizeof index), "the mug has not its own Gaussians");
	CHECK(sure[0] == 0.5F && sure[3] == 1, "confidence stays with the Gaussians");
	for (int i = 0; i < EACH; i++)
		index[i + 3 * EACH] = i;
	sure[0] = 0.01F;
	CHECK(count_moved(&l, 3, "\0\0\0\0") > 0 && sure[0] == 1 && sure[1] == 1, "masks that do not agree");
}

/* A sentence of the vectors of a noun is about what is called so, and one without words about nothing. */
static void is_about(void)
{
	static float vectors[MOST * WIDTH];
	static const char *const said[3] = {"cup", "mug", "box"};
	struct vocabulary v;
	struct err e;
	double match[OBJECTS];

	CHECK(!vocabulary_make(&v, &lifted, &parser, &e), "%s", e.message);
	for (int o = 0; o < 3; o++) {
		struct parse_word word = {.pieces = (int)encode(said[o], vectors)};
		const struct parse parse = {.word_count = 1, .words = &word};
		const struct vocabulary_sentence s = {&parse, vectors, (size_t)word.pieces};
		int best = 0;
		vocabulary_about(&v, &s, "\1", match);
		for (int k = 0; k < OBJECTS; k++)
			best = match[k] > match[best] ? k : best;
		CHECK(best == o, "'%s' is about %s", said[o], names[best]);
	}
	const struct parse empty = {0};
	const struct vocabulary_sentence none = {&empty, vectors, 0};
	vocabulary_about(&v, &none, "", match);
	for (int k = 0; k < OBJECTS; k++)
		CHECK(isfinite(match[k]), "%s: %g", names[k], match[k]);
	vocabulary_free(&v);
}

/* A vocabulary of the scene's objects and other sentences, for vocabulary_free; said and about hold n. */
static struct lifted other_said(char **said, int32_t *about, size_t n, int64_t *at, float *vectors)
{
	struct lifted l = lifted;

	at[0] = 0;
	for (size_t r = 0; r < n; r++)
		at[r + 1] = at[r] + (int64_t)encode(said[r], vectors + (size_t)at[r] * WIDTH);
	l.sentences = n;
	l.object = about;
	l.texts = l.pieces = said;
	l.offsets = at;
	l.words = vectors;
	return l;
}

/* "toy" is said of a mug and of a box: it fits the other mug, but not the tin. */
static void general_nouns(void)
{
	static char *said[] = {"the toy", "the mug", "the toy", "the box", "the mug", "the can"};
	static int32_t about[] = {0, 0, 2, 2, 1, 3};
	static float vectors[6 * 4 * WIDTH], word_vector[WIDTH];
	int64_t at[7];
	const struct lifted l = other_said(said, about, 6, at, vectors);
	struct parse_word word = {.text = "toy", .lemma = "toy", .pieces = (int)encode("toy", word_vector)};
	const struct parse parse = {.word_count = 1, .words = &word};
	const struct vocabulary_sentence s = {&parse, word_vector, 1};
	struct vocabulary v;
	struct err e;
	double match[OBJECTS + 1];

	CHECK(!vocabulary_make(&v, &l, &parser, &e), "%s", e.message);
	for (v.has_names = 0; v.has_names < 2; v.has_names++) {
		vocabulary_noun(&v, &s, 0, match);
		CHECK(match[0] == 1 && match[2] == 1, "toys: %g, %g", match[0], match[2]);
		CHECK(match[1] > 0.5 && match[1] < 1, "the other mug: %g", match[1]);
		CHECK(match[3] < 0.5, "the tin: %g", match[3]);
	}
	vocabulary_free(&v);
}

/* The eraser of an "eraser tin", by its name or a word for the same, but not the green of a "green tin". */
static void contents(void)
{
	static char *held[] = {"mug", "Eraser tin", "crate", "green tin 2"};
	static const char *const asked[] = {"eraser", "rubber", "green"};
	static float word_vector[WIDTH];
	struct lifted l = lifted;
	struct vocabulary v;
	struct err e;
	double match[OBJECTS + 1];

	l.names = held;
	CHECK(!vocabulary_make(&v, &l, &parser, &e), "%s", e.message);
	for (int i = 0; i < 3; i++) {
		char *text = (char *)asked[i];
		struct parse_word word = {
			.text = text, .lemma = text, .pieces = (int)encode(text, word_vector)};
		const struct parse parse = {.word_count = 1, .words = &word};
		const struct vocabulary_sentence s = {&parse, word_vector, 1};
		vocabulary_noun(&v, &s, 0, match);
		CHECK(i < 2 ? match[1] > 0.5 && match[1] < 1 && match[0] < 0.5 && match[3] < 0.5
			    : match[3] < 0.5,
			"%s: %g, %g, %g", text, match[0], match[1], match[3]);
	}
	vocabulary_free(&v);
}

/* The colour of a part is not the thing's, nor is that of what it is near. */
static void colours_of_parts(void)
{
	static char *said[] = {"the mug with the green handle", "the tin on the green mat", "the green box"};
	static int32_t about[] = {0, 3, 2};
	static float vectors[3 * 8 * WIDTH];
	int64_t at[4];
	const struct lifted l = other_said(said, about, 3, at, vectors);
	struct arranged objects[OBJECTS] = {0};
	const struct arrangement a = {.n = OBJECTS, .objects = objects};
	struct vocabulary v;
	struct err e;
	double fit[OBJECTS];

	CHECK(!vocabulary_make(&v, &l, &parser, &e), "%s", e.message);
	CHECK(vocabulary_colour(&v, &a, "green", fit), "green is no colour");
	CHECK(fit[2] == 1 && fit[0] == 0 && fit[1] == 0 && fit[3] == 0,
		"green: mugs %g and %g, crate %g, tin %g", fit[0], fit[1], fit[2], fit[3]);
	vocabulary_free(&v);
}

/* What a word means that was not said of the thing itself. */
static void words_of_others(void)
{
	static char *said[] = {"the shiny cup", "the mug with a handle", "the red box", "the can"};
	static int32_t about[] = {0, 1, 2, 3};
	static float vectors[4 * 8 * WIDTH], asked[MOST * WIDTH];
	int64_t at[5];
	const struct lifted l = other_said(said, about, 4, at, vectors);
	const struct choose_scene s = {&l, &splats, &cameras, &parser, 1, NULL};
	static const struct {
		const char *text, *why;
		int means;
	} asks[] = {
		{"the cup on the right", "what one mug is called, the other may be called", 1},
		{"the red gadget", "anything may be a gadget", 2},
		{"the red lump", "and have a shape", 2},
		{"the mug left of the handle", "a part stands for its thing", 0},
		{"not the mug on the left , the other one", "the other one is a mug", 1},
	};
	struct err e;

	for (size_t i = 0; i < sizeof asks / sizeof *asks; i++) {
		const struct choose_sentence q = {asks[i].text, asks[i].text, asked, NULL,
			encode(asks[i].text, asked), {.kind = VIEWPOINT_USUAL}, NULL, 0};
		CHECK(!choose(&s, &q, 1, CHOOSE_ALL, &choice, probability, chosen, NULL, &e), "%s",
			e.message);
		for (int o = 0; o < OBJECTS; o++)
			CHECK(chosen[o] == (o == asks[i].means), "'%s', %s: object %d is %d", asks[i].text,
				asks[i].why, o, chosen[o]);
		CHECK(choice.there > 0.5, "'%s': %g there", asks[i].text, choice.there);
	}
}

/* A mug that is left of the crate has no crate. */
static void places_are_no_parts(void)
{
	ask("the thing with a crate", WORDS | RELATIONS);
	CHECK(probability[0] < 0.5, "the mug has a crate: %g", (double)probability[0]);
}

/* The left one of two is one, wherever it is; of what is there but once the side has to be so. */
static void sides(void)
{
	CHECK(ask("the mug on the left", CHOOSE_ALL) == 0 && choice.there > 0.7, "a left mug: %g",
		choice.there);
	ask("the crate at the front", CHOOSE_ALL);
	CHECK(choice.there < 0.5, "the crate is at the back: %g", choice.there);
	CHECK(ask("the crate at the back", CHOOSE_ALL) == 2 && choice.there > 0.7, "the back: %g",
		choice.there);
}

/* One of those that are named, whatever else fits. */
static void members(void)
{
	const char *behind = "of the mug and the tin the back one", *back = "the back one";

	CHECK(best_of_roles(back, ". P T", PARSE_BEHIND) == 2, "the crate is at the back");
	const int mug = best_of_roles(behind, ". . M . . M . P T", PARSE_BEHIND);
	CHECK((mug == 0 || mug == 1) && choice.there > 0.5, "a mug is behind the tin: %d, %g", mug,
		choice.there);
	CHECK(best_of_roles("of the tin and the mug the back one", ". . M . . M . P T", PARSE_BEHIND) == mug,
		"in any order");
	best_of_roles("of the zeppelin and the wug the back one", ". . M . . M . P T", PARSE_BEHIND);
	CHECK(choice.there < 0.5, "neither is there: %g", choice.there);
}

/* Of four things a sentence that says nothing means none. */
static void nothing_said(void)
{
	ask("where is it?", CHOOSE_ALL);
	CHECK(choice.there < 0.5, "it: %g", choice.there);
	ask("the thing", CHOOSE_ALL);
	CHECK(choice.there < 0.5, "the thing: %g", choice.there);
	ask("the red thing", CHOOSE_ALL);
	CHECK(choice.there > 0.5, "the red thing: %g", choice.there);
}

int main(void)
{
	make_scene();
	nothing_said();
	members();
	sides();
	twins();
	spare();
	kinds_of_two_words();
	parts();
	by_itself();
	counted();
	named_colours();
	left_out();
	anchors();
	sets();
	absent();
	many();
	kept();
	is_about();
	general_nouns();
	contents();
	colours_of_parts();
	words_of_others();
	places_are_no_parts();
	return unit_end();
}
