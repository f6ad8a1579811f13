/* What each object is worth as what a sentence says the use of (lang/purpose.h), whatever its parse makes of
 * it: by how near its words are to the uses of such things (lang/things_vectors.h) and to the object's nouns;
 * and by the colours and places that its parse has. The thing is
 * here if the sentence is nearly as near to its uses as to those of all everyday things together. */
#pragma once

#include "ask/meaning.h"

/* score (O): logarithms of what fits, for a softmax; scratch (3 O). Returns P that the best of them is meant,
 * 0 where no use is said. m: the sentence is judged. */
double usage_judge(const struct meaning *m, double *score, double *scratch);

/* Whether the parse tells of colours or places besides: "the red thing you drink from". */
int usage_says_more(const struct meaning *m);
