/* The directions of uses that are a part of the program, and what is chosen by them. A word's vectors are
 * made up here: those of a line of the table itself. */
#include "tests/unit/default_parser.h"
#include "ask/choose.h"
#include "lang/things.h"
#include "lang/things_vectors.h"
#include "unit.h"

#include <math.h>
#include <string.h>

enum { WIDTH = 384, OBJECTS = 3, EACH = 30, N = OBJECTS * EACH, MOST = 32 };
static const char encoder[] = "250e199d5d49d82d";

static struct things_vectors all;

static int line_of(const char *name)
{
	struct things_rows rows;

	things_find(&rows, name);
	CHECK(rows.n > 0, "%s is in the table", name);
	return rows.row[0];
}

static void table(void)
{
	static float direction[WIDTH], cosine[4096];
	struct things_vectors other;
	struct err e;
	size_t length;
	double square = 0;

	CHECK(!things_vectors_open(&all, encoder, WIDTH, &e) && all.lines > 1000 && all.lines <= 4096,
		"%d lines", all.lines);
	CHECK(things_text(all.lines - 1, THINGS_NAMES, &length) &&
			!things_text(all.lines, THINGS_NAMES, &length),
		"as many as the table has");
	CHECK(all.hash == things_hash(), "made of this table: make -f pipelines/parse.mk things");
	const int8_t *line = all.of + (size_t)line_of("kettle") * WIDTH;
	for (int d = 0; d < WIDTH; d++)
		square += line[d] * line[d];
	for (int d = 0; d < WIDTH; d++)
		direction[d] = (float)(line[d] / sqrt(square));
	things_vectors_cosines(&all, direction, cosine);
	for (int i = 0; i < all.lines; i++) {
		double dot = 0, own = 0;
		for (int d = 0; d < WIDTH; d++) {
			const double x = all.of[(size_t)i * WIDTH + (size_t)d];
			dot += x * (double)direction[d];
			own += x * x;
		}
		if (!(fabs((double)cosine[i] - dot / sqrt(own)) < 1e-5))
			CHECK(0, "line %d: %g, in float64 %g", i, (double)cosine[i], dot / sqrt(own));
	}
	CHECK(fabs((double)cosine[line_of("kettle")] - 1) < 1e-5, "a line with itself");
	CHECK(cosine[line_of("teapot")] > cosine[line_of("hammer")], "tea is nearer than nails");
	const int three[] = {line_of("hammer"), line_of("teapot"), line_of("saw")},
		  kettle = line_of("kettle");
	CHECK(fabs(things_vectors_between(&all, &kettle, 1, three, 3) - (double)cosine[three[1]]) < 1e-5 &&
			things_vectors_between(&all, &kettle, 1, three, 0) < 0,
		"the best of several lines");
	CHECK(!things_vectors_open(&other, "0123456789abcdef", WIDTH, &e) && !other.lines, "another encoder");
	CHECK(!things_vectors_open(&other, NULL, WIDTH, &e) && !other.lines, "nobody knows which");
	CHECK(!things_vectors_open(&other, encoder, WIDTH - 1, &e) && !other.lines, "another width");
}

static char *names[] = {"red kettle", "stapler 2", "zorb"};
static float means[3 * N], scales[3 * N], quats[4 * N], opacities[N], sh[3 * N], share[N];
static int32_t index_of[N];
static int64_t indptr[OBJECTS + 1], offsets[1];
static float confidence[OBJECTS] = {1, 1, 1}, no_words[1];
static struct camera view;

static struct choice choice;
static float probability[OBJECTS];

static unsigned parts = CHOOSE_ALL;

/* The object that a sentence means whose words all have the vector of a line; -1: none. */
static int ask(const char *text, const char *thing, const char *of)
{
	static float vectors[MOST * WIDTH];
	static const struct splats splats = {N, 1, SPLATS_NEAR, means, scales, quats, opacities, sh};
	static const struct cameras cameras = {1, &view};
	const struct lifted lifted = {N, OBJECTS, names, confidence, indptr, index_of, share, 0, WIDTH, NULL,
		NULL, NULL, offsets, no_words, NULL, NULL, NULL};
	struct parser parser = default_parser();
	parser.encoder = of;
	const struct choose_scene scene = {&lifted, &splats, &cameras, &parser, 1, NULL};
	char chosen[OBJECTS];
	struct err e;
	size_t words = 1;
	const int8_t *line = all.of + (size_t)line_of(thing) * WIDTH;

	for (const char *p = text; *p; p++)
		words += *p == ' ';
	for (size_t i = 0; i < words * WIDTH; i++)
		vectors[i] = (float)line[i % WIDTH];
	const struct choose_sentence s = {
		text, text, vectors, NULL, words, {.kind = VIEWPOINT_USUAL}, NULL, 0};
	CHECK(!choose(&scene, &s, 1, parts, &choice, probability, chosen, NULL, &e), "'%s'", text);
	for (int o = 0; o < OBJECTS && choice.there > 0.5; o++)
		if (chosen[o])
			return o;
	return -1;
}

static void make_scene(void)
{
	double rotation[3][3] = {{1, 0, 0}, {0, 0, -1}, {0, 1, 0}};

	view = (struct camera){.width = 100, .height = 100, .fx = 100, .fy = 100, .cx = 50, .cy = 50};
	camera_set_centre(&view, rotation, (double[3]){0, -10, 1});
	for (int i = 0; i < N; i++) {
		means[3 * i] = (float)(3 * (i / EACH) + 0.1 * (i % 3));
		means[3 * i + 1] = (float)(0.1 * (i / 3 % 3));
		means[3 * i + 2] = (float)(0.1 * (i % 7));
		quats[4 * i] = share[i] = opacities[i] = 1;
		for (int d = 0; d < 3; d++)
			scales[3 * i + d] = 0.1F;
		index_of[i] = i;
	}
	for (int o = 0; o <= OBJECTS; o++)
		indptr[o] = o * EACH;
}

static void expect(int object, const char *text, const char *thing, const char *of, const char *why)
{
	const int got = ask(text, thing, of);

	CHECK(got == object, "%s: '%s' means %d, %g", why, text, got, choice.there);
}

static void uses(void)
{
	static const char form[] = "what you warm yourself up with", story[] = "visitors always freeze here";

	expect(0, form, "kettle", encoder, "a kettle");
	CHECK(choice.is_by_purpose, "by what it is for");
	expect(1, form, "stapler", encoder, "the number of a name is no word of it");
	expect(-1, form, "hammer", encoder, "there is no hammer");
	parts &= ~(1U << CHOOSE_NAMES);
	expect(-1, form, "kettle", encoder, "nobody says that it is a kettle");
	parts = CHOOSE_ALL;
	expect(0, story, "kettle", encoder, "without the form of one");
	expect(-1, story, "hammer", encoder, "nor a hammer then");
	expect(-1, "where is the trombone", "kettle", encoder, "a name, and not here");
	expect(-1, story, "kettle", "0123456789abcdef", "of another encoder nothing is known");
}

int main(void)
{
	table();
	make_scene();
	uses();
	things_vectors_free(&all);
	return unit_end();
}
