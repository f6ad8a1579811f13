#include "lang/colours.h"

#include <math.h>
#include <string.h>

/* The words of libcommon/lang/colours.tsv; the build makes these lines of it. */
#define ALIKE(word, other)
#define COLOUR(word, r, g, b) {word, {r, g, b}},
static const struct {
	const char *word;
	unsigned char rgb[3];
} colours[COLOUR_WORDS] = {
#include "lang/colours.inc"
};
#undef ALIKE
#undef COLOUR

const char *colour_name(int word)
{
	return colours[word].word;
}

/* Other words, and the one of colours[] that looks the same. */
#define ALIKE(word, other) {word, other},
#define COLOUR(word, r, g, b)
static const char *const others[][2] = {
#include "lang/colours.inc"
};

int colour_word(const char *word)
{
	for (size_t i = 0; i < sizeof others / sizeof *others; i++)
		if (!strcmp(word, others[i][0]))
			word = others[i][1];
	for (int i = 0; i < COLOUR_WORDS; i++)
		if (!strcmp(word, colours[i].word))
			return i;
	return -1;
}

static double linear(double c)
{
	c = fmin(fmax(c, 0), 1);
	return c <= 0.04045 ? c / 12.92 : pow((c + 0.055) / 1.055, 2.4);
}

static double curve(double t)
{
	return t > 216.0 / 24389 ? cbrt(t) : (24389.0 / 27 * t + 16) / 116;
}

void colour_lab(const double rgb[3], double lab[3])
{
	const double r = linear(rgb[0]), g = linear(rgb[1]), b = linear(rgb[2]);
	const double x = curve((0.4124 * r + 0.3576 * g + 0.1805 * b) / 0.9505);
	const double y = curve(0.2126 * r + 0.7152 * g + 0.0722 * b);
	const double z = curve((0.0193 * r + 0.1192 * g + 0.9505 * b) / 1.089);

	lab[0] = 116 * y - 16;
	lab[1] = 500 * (x - y);
	lab[2] = 200 * (y - z);
}

static const double told_apart = 16, one_colour = 16;

static void lab_of_word(int word, double lab[3])
{
	const unsigned char *c = colours[word].rgb;

	colour_lab((double[3]){c[0] / 255.0, c[1] / 255.0, c[2] / 255.0}, lab);
}

static double square_distance(const double lab[3], const double other[3])
{
	const double l = 0.5 * (lab[0] - other[0]), a = lab[1] - other[1], b = lab[2] - other[2];

	return l * l + a * a + b * b;
}

void colour_labs_make(struct colour_labs *all)
{
	for (int w = 0; w < COLOUR_WORDS; w++)
		lab_of_word(w, all->of[w]);
}

void colour_call(const struct colour_labs *all, const double lab[3], double weight, double *share)
{
	double square[COLOUR_WORDS], least = INFINITY;

	for (int w = 0; w < COLOUR_WORDS; w++) {
		square[w] = square_distance(lab, all->of[w]);
		least = fmin(least, square[w]);
	}
	for (int w = 0; w < COLOUR_WORDS; w++)
		share[w] += weight * exp(-0.5 * (square[w] - least) / (told_apart * told_apart));
}

double colour_words_alike(int a, int b)
{
	double lab[3], other[3];

	lab_of_word(a, lab);
	lab_of_word(b, other);
	return exp(-0.5 * square_distance(lab, other) / (one_colour * one_colour));
}
