/* clang-format off */
/* Which object a sentence means: a score of every lifted object for every sentence, from parts that can be
 * left out one by one.
 *
 * A sentence is taken apart (lang/sentence.h) into the words of its target and clauses with anchors. Of object o:
 *   words      A_o = sum over target words w of (M_wo - max M_w.), M_wo the best cosine of w with a target
 *              word of o's training sentences (vectors less the scene's mean): late interaction
 *   names      a word of o's name counts as a match of 0.95
 *   alike      objects that look the same share their words: M_wo = max over k of (M_wk + 0.07 alike(o,k)),
 *              arrangement_alike
 *   colours    for a colour word A_o += 0.6 (log(0.05 + fit_o) - max), fit_o the share of the object's own
 *              colours that fit it
 *   sizes      for "small", "medium" or "large" A_o += 0.6 fit_o less its maximum, of vocabulary_size
 *   relations  R_o = sum over clauses of log(t r_o + (1 - t) / 2 + 0.02), r of refer/relate.h with each anchor
 *              as likely each object as exp(12 A) of its words; t falls to 0 where the anchor's last word is
 *              no object's (cosine below 0.5): what is said of unknown things says nothing
 *   sentence   S_o the best cosine of the sentence's mean with a training sentence's, counted by the share of
 *              the target in the sentence's words; a training sentence means what it meant
 * score_o = 3.5 A_o + 1.6 R_o + S_o; the probability is its softmax, times that of the sentence meaning
 * anything at all. That goes by how well it fits its best object o,
 *   f = 3.2 M_o of the head noun + 8.9 mean over words of max M + sum over colour words of
 *       log((0.05 + fit_o) / 0.25) + 0.9 (R_o - clauses log 0.32) + 1.7 log of o's softmax,
 * against the scene's own training sentences, each fitted by the others alone: p = (1 + how many fit no
 * better) / (1 + R) is even for sentences about what is there, however freely the scene's sentences are
 * worded, and near 0 for others. P = 4 / (4 + p^-0.75 / 4). A sentence with no word for the thing itself is
 * taken to mean something. The figures were chosen on synthetic scenes (seeds 1 to 9). */
/* clang-format on */
#ifndef ASK_CHOOSE_H
#define ASK_CHOOSE_H

#include "base/err.h"
#include "base/list.h"
#include "geom/camera.h"
#include "refer/lifted.h"
#include "splat/splats.h"

enum choose_part {
	CHOOSE_WORDS,
	CHOOSE_NAMES,
	CHOOSE_ALIKE,
	CHOOSE_COLOURS,
	CHOOSE_SIZES,
	CHOOSE_RELATIONS,
	CHOOSE_SENTENCE,
	CHOOSE_PARTS
};
enum { CHOOSE_ALL = (1 << CHOOSE_PARTS) - 1 };

/* All parts but those in a comma-separated list of "words" ... "sentence" (NULL: all). 0, or -1 and *unknown
 * the first name that is no part's. */
int choose_without(const char *list, unsigned *parts, struct list_name *unknown);

struct choose_sentence {
	const char *pieces;   /* word pieces with single spaces between; NULL: not known, and only the part
				 `sentence` counts */
	const float *vectors; /* (words, the model's width) */
	size_t words;
};

struct choose_scene {
	const struct lifted *lifted;
	const struct splats *splats;
	const struct cameras *cameras; /* relations are as seen by the training views among them */
	double naming; /* how much words for the thing itself count, 1 but where it is in doubt which lifted
			  object has which name: colours and relations then tell */
};

/* probability (n,O): each row sums to at most 1; what is missing is the probability that the sentence means
 * nothing that was lifted. A sentence without words means nothing. parts: a bit 1 << part for each part that
 * counts. Returns 0, or -1 with *e set. */
int choose(const struct choose_scene *s, const struct choose_sentence *sentences, size_t n, unsigned parts,
	float *probability, struct err *e);

#endif
