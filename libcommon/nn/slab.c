#include "nn/slab.h"

#include "base/hash.h"
#include "base/mem.h"

float *slab_take(struct slab *s, size_t rows, size_t columns)
{
	const size_t limit = SIZE_MAX / 8;
	size_t count;
	float *at = s->at ? s->at + s->used : NULL;

	if (s->hash)
		*s->hash = hash64(at, rows * columns * sizeof *at, *s->hash);
	if (mem_size(rows, columns, &count) || (count = (count + 15) / 16 * 16) > limit - s->used) {
		s->bad = -1;
		return NULL;
	}
	s->used += count; /* a multiple of 16: each array begins on a 64-byte boundary */
	return at;
}

void slab_take_weight(struct slab *s, struct linear_weight *w, size_t rows, size_t columns)
{
	if (!w->halves)
		w->floats = slab_take(s, rows, columns);
	else if (s->hash)
		*s->hash = hash64_halves(w->halves, rows * columns, *s->hash);
}

float *slab_alloc(void (*lay_out)(void *of, struct slab *s), void *of, const char *what, struct err *e)
{
	struct slab count = {0}, place = {0};

	lay_out(of, &count);
	if (count.bad) {
		err_set(e, ERR_SYSTEM, "%s: its weights do not fit in memory", what);
		return NULL;
	}
	place.at = mem_alloc(count.used, sizeof *place.at, what, e);
	if (place.at)
		lay_out(of, &place);
	return place.at;
}
