/* Numbers as text. */
#pragma once

enum { NUMBER_SIZE = 32 };

/* The fewest digits that read back as the same finite number, so that 0.83 stays 0.83. Returns text. */
char *number_text(char text[NUMBER_SIZE], double x);

/* A probability: "97%"; "below 1%", and at most "99%", where it is neither 0 nor 1. Returns text. */
char *number_percent(char text[NUMBER_SIZE], double p);
