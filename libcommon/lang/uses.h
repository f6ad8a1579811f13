/* What things are for, by lang/things.h and by WordNet's glosses: a cup is "used for drinking", and tea is a
 * kind of drink. Without WordNet less is known. Call from one thread at a time, as lang/wordnet.h. */
#ifndef LANG_USES_H
#define LANG_USES_H

enum { USES_STEMS = 160 };

/* Stems of words, hashed, and what each is worth, in (0,1]. */
struct uses {
	int n;
	struct {
		unsigned stem;
		float worth;
	} of[USES_STEMS];
};

/* Fills `to` with the words of the uses that lang/things.h has of a noun, and of the glosses of a made thing
 * called so and of what it is a kind of, two steps up. */
void uses_of_thing(struct uses *to, const char *lemma);

/* Fills `to` with the words of what a thing called so usually is made of, and has. */
void uses_parts(struct uses *to, const char *lemma);

/* Fills `to` with the word alone. */
void uses_word(struct uses *to, const char *lemma);

/* Fills `to` with a word and the words of what it is a kind of, as a noun or a verb: drink for tea and sip.
 * Verbs that say nothing of what a thing is for ("put", "have") have none. */
void uses_of_word(struct uses *to, const char *lemma);

/* Whether a noun is one that things are called by, and not only who uses one or what is done to it: a cup,
 * not a referee or the weather. Without WordNet any may be. */
int uses_names_thing(const char *lemma);

/* How far a thing is for what a word says, in [0,1]. */
double uses_fit(const struct uses *thing, const struct uses *word);

#endif
