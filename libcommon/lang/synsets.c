#include "lang/synsets.h"

#ifdef HAVE_WORDNET
#include "lang/wordnet.h"

#include <string.h>

int synsets_of(const char *lemma, int pos, long *synsets, int most)
{
	char word[128]; /* libwordnet changes it */
	int n = 0;

	const size_t length = strlen(lemma);
	if (!wordnet_is_there() || !length || length >= sizeof word)
		return 0;
	memcpy(word, lemma, length + 1);
	IndexPtr index = index_lookup(word, pos);
	for (; index && n < index->off_cnt && n < most; n++)
		synsets[n] = (long)index->offset[n];
	if (index)
		free_index(index);
	return n;
}

void synsets_counts(const char *lemma, int pos, int *counts, int n)
{
	char word[128];
	const size_t length = strlen(lemma);

	memset(counts, 0, (size_t)n * sizeof *counts);
	if (!n || length >= sizeof word)
		return;
	memcpy(word, lemma, length + 1);
	IndexPtr index = index_lookup(word, pos);
	for (int i = 0; index && i < n; i++)
		counts[i] = GetTagcnt(index, i + 1);
	if (index)
		free_index(index);
}

/* Words are kinds of the same few things: the last synset of each place is kept. */
int synsets_up(long synset, long up[SYNSETS_UP])
{
	static char none[] = "";
	static struct {
		long synset, up[SYNSETS_UP]; /* 0: none yet */
		int n;
	} kept[2048], *k;

	k = &kept[synset % (long)(sizeof kept / sizeof *kept)];
	if (k->synset != synset) {
		SynsetPtr s = read_synset(NOUN, synset, none);
		k->synset = synset;
		k->n = 0;
		for (int i = 0; s && i < s->ptrcount && k->n < SYNSETS_UP; i++)
			if (s->ptrtyp[i] == HYPERPTR && s->ppos[i] == NOUN)
				k->up[k->n++] = s->ptroff[i];
		if (s)
			free_synset(s);
	}
	memcpy(up, k->up, sizeof k->up);
	return k->n;
}
#endif
