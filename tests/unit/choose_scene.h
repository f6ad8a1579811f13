/* A made-up scene of four objects whose words have made-up vectors, and how it is asked. */
#ifndef CHOOSE_SCENE_H
#define CHOOSE_SCENE_H

#include "tests/unit/default_parser.h"
#include "ask/choose.h"
#include "rules_help.h"
#include "unit.h"

#include <math.h>
#include <string.h>

enum { OBJECTS = 4, EACH = 30, N = OBJECTS * EACH, WIDTH = 96, MOST = 64 };

/* A word's vector: its own direction, and all the same one besides. */
static inline void vector_of(const char *word, size_t length, float out[WIDTH])
{
	unsigned state = 1;

	for (size_t i = 0; i < length; i++)
		state = state * 31 + (unsigned char)word[i];
	for (int d = 0; d < WIDTH; d++) {
		state = state * 1664525u + 1013904223u;
		out[d] = (float)(state >> 8) / (1 << 23) - 1 + (d == 0 ? 5 : 0);
	}
}

static inline size_t encode(const char *pieces, float *vectors)
{
	size_t n = 0;

	for (const char *p = pieces; *p; n++) {
		size_t length = strcspn(p, " ");
		vector_of(p, length, vectors + n * WIDTH);
		p += length + (p[length] == ' ');
	}
	return n;
}

/* mug 1 and mug 2 look the same, on the left and on the right; a red box behind, a tin before them. */
static char *names[] = {"mug", "mug 2", "crate", "tin"};
static char *pieces[] = {"the shiny mug", "the striped cup to the left of the crate", "the small mug",
	"the wooden box", "the metal can nearest to us", "the dull can"};
static int32_t object[] = {0, 0, 1, 2, 3, 3};
static int64_t offsets[7];
static float words[6 * 16 * WIDTH];

static float means[3 * N], scales[3 * N], quats[4 * N], opacities[N], sh[3 * N], share[N];
static int32_t index_of[N];
static int64_t indptr[OBJECTS + 1];
static float confidence[OBJECTS] = {1, 1, 1, 1};
static struct splats splats = {N, 1, SPLATS_NEAR, means, scales, quats, opacities, sh};
static struct lifted lifted = {N, OBJECTS, names, confidence, indptr, index_of, share, 6, WIDTH, object,
	pieces, pieces, offsets, words, NULL, NULL, NULL};
static struct camera view;
static struct cameras cameras = {1, &view};

static inline void make_scene(void)
{
	static const double at[OBJECTS][3] = {{-2, 0, 0}, {2, 0, 0}, {0, 3, 0}, {0, -3, 0}};
	static const float colour[OBJECTS][3] = {{1, 1, 1}, {1, 1, 1}, {1.2f, -1.5f, -1.5f}, {0, 0, 0}};
	double rotation[3][3] = {{1, 0, 0}, {0, 0, -1}, {0, 1, 0}};

	view = (struct camera){.width = 100, .height = 100, .fx = 100, .fy = 100, .cx = 50, .cy = 50};
	camera_set_centre(&view, rotation, (double[3]){0, -10, 1});
	for (int i = 0; i < N; i++) {
		const int o = i / EACH, k = i % EACH;
		const double size = o == 2 ? 2 : 1;
		const double offset[3] = {
			size * 0.1 * (k % 3), size * 0.1 * (k / 3 % 3), size * 0.1 * (k % 7)};
		for (int d = 0; d < 3; d++) {
			means[3 * i + d] = (float)(at[o][d] + offset[d]);
			scales[3 * i + d] = 0.1f;
			sh[3 * i + d] = colour[o][d];
		}
		index_of[i] = i;
		share[i] = opacities[i] = 1;
	}
	for (int o = 0; o <= OBJECTS; o++)
		indptr[o] = o * EACH;
	for (int r = 0; r < 6; r++)
		offsets[r + 1] = offsets[r] + (int64_t)encode(pieces[r], words + (size_t)offsets[r] * WIDTH);
}

static struct parser parser;

__attribute__((constructor)) static void make_parser(void)
{
	parser = default_parser();
}
static const struct choose_scene scene = {&lifted, &splats, &cameras, &parser, 1, NULL};
static float probability[OBJECTS];
static char chosen[OBJECTS];
static struct choice choice;

/* The sentence's best object; p: its parse, or NULL. */
static inline int ask_parsed(const char *text, unsigned parts, struct viewpoint from, const struct parse *p)
{
	static float vectors[MOST * WIDTH];
	const struct choose_sentence s = {text, text, vectors, NULL, encode(text, vectors), from, p, 0};
	struct err e;
	int best = 0;

	if (!CHECK(!choose(&scene, &s, 1, parts, &choice, probability, chosen, NULL, &e), "%s", e.message))
		return -1;
	for (int o = 0; o < OBJECTS; o++) {
		best = probability[o] > probability[best] ? o : best;
		CHECK(probability[o] >= 0 && probability[o] <= 1, "'%s': %g", text, (double)probability[o]);
	}
	CHECK(choice.there >= 0 && choice.there <= 1, "'%s': %g there", text, choice.there);
	return best;
}

static inline int ask_from(const char *text, unsigned parts, struct viewpoint from)
{
	return ask_parsed(text, parts, from, NULL);
}

static inline int ask(const char *text, unsigned parts)
{
	return ask_from(text, parts, (struct viewpoint){.kind = VIEWPOINT_USUAL});
}

enum {
	WORDS = 1 << CHOOSE_WORDS,
	NAMES = 1 << CHOOSE_NAMES,
	COLOURS = 1 << CHOOSE_COLOURS,
	SURFACES = 1 << CHOOSE_SURFACES,
	SIZES = 1 << CHOOSE_SIZES,
	RELATIONS = 1 << CHOOSE_RELATIONS,
	SENTENCE = 1 << CHOOSE_SENTENCE
};

/* The best of a sentence whose words are so. */
static inline int best_of_roles(const char *text, const char *roles, enum parse_relation relation)
{
	struct parse p = built(text, roles, relation);
	const int best = ask_parsed(text, CHOOSE_ALL, (struct viewpoint){.kind = VIEWPOINT_USUAL}, &p);
	parse_free(&p);
	return best;
}

#endif
