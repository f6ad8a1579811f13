/* Colour words: what each looks like, and how well a colour fits one. */
#pragma once

/* The number of a colour word, or -1 where it is none. */
int colour_word(const char *word);
enum { COLOUR_WORDS = 49 };

/* The word of a number below COLOUR_WORDS. */
const char *colour_name(int word);

/* CIE L*a*b* (D65) of an sRGB colour; what is outside [0,1] is cut. */
void colour_lab(const double rgb[3], double lab[3]);

/* What all words look like. */
struct colour_labs {
	double of[COLOUR_WORDS][3];
};
void colour_labs_make(struct colour_labs *all);

/* Adds to share (COLOUR_WORDS) how far people would call a colour by each word, times weight: in [0,1], near
 * 1 for the nearest words, exp(-1/2 (d^2 - least^2) / 16^2) with d the distance of L*a*b* to the word's
 * colour and least that to the nearest word's. Lightness counts half, as it depends on the light. */
void colour_call(const struct colour_labs *all, const double lab[3], double weight, double *share);

/* How far two colour words are words for one colour, in [0,1]. */
double colour_words_alike(int a, int b);
