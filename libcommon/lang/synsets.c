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

SynsetPtr synsets_read(int pos, long synset)
{
	static char none[] = "";

	return read_synset(pos, synset, none);
}

int synsets_next_up(const Synset *s, int pos, int *at, long *up)
{
	while (*at < s->ptrcount) {
		const int i = (*at)++;
		if (s->ptrtyp[i] == HYPERPTR && s->ppos[i] == pos) {
			*up = s->ptroff[i];
			return 1;
		}
	}
	return 0;
}
#endif
