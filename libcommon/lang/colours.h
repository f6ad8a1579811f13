/* Colour words: what each looks like, and how well a colour fits one. */
#ifndef LANG_COLOURS_H
#define LANG_COLOURS_H

/* The number of a colour word, or -1 where it is none. */
int colour_word(const char *word);
enum { COLOUR_WORDS = 49 };

/* CIE L*a*b* (D65) of an sRGB colour; what is outside [0,1] is cut. */
void colour_lab(const double rgb[3], double lab[3]);

void colour_word_lab(int word, double lab[3]);

/* How well a colour fits that of a word, in [0,1]: exp(-1/2 (distance / 25)^2), the distance that of L*a*b*
 * with lightness counting half, as it depends on the light. */
double colour_fit(const float lab[3], const double word[3]);

#endif
