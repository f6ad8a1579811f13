/* Numbers as text. */
#ifndef BASE_NUMBER_H
#define BASE_NUMBER_H

enum { NUMBER_SIZE = 32 };

/* The fewest digits that read back as the same finite number, so that 0.83 stays 0.83. Returns text. */
char *number_text(char text[NUMBER_SIZE], double x);

#endif
