#include "cmd/text/encode.h"

#include "base/file.h"
#include "base/mem.h"
#include "formats/encoders/merges.h"
#include "formats/encoders/vocab.h"

char *cache_folder(const char *name, struct err *e)
{
	const char *cache = getenv("XDG_CACHE_HOME"), *home = getenv("HOME");
	const int has_cache = cache && *cache;

	if (!has_cache && !(home && *home)) {
		err_set(e, ERR_USAGE, "no %s is named, and HOME is not set", name);
		return NULL;
	}
	SCOPED char *dir = has_cache ? file_join(cache, "refersplat", "", e)
				     : file_join(home, ".cache/refersplat", "", e);
	return dir ? file_join(dir, name, "", e) : NULL;
}

char *cached_model(const char *what, struct err *e)
{
	char *dir = cache_folder(what, e);

	if (!dir || file_is_dir(dir))
		return dir;
	err_set(e, ERR_SYSTEM, "%s: no %s there: 'refersplat-%s' fetches one, in a checkout 'make %s'", dir,
		what, what, what);
	free(dir);
	return NULL;
}

/* Ids index the embedding, so none may lie past it. */
static int check_vocab(const struct vocab *v, int words, const char *dir, struct err *e)
{
	for (size_t i = 0; i < v->n; i++)
		if (v->entries[i].id >= words)
			return err_set(e, ERR_FORMAT, "%s: token '%s' has id %d, but vocab_size is %d", dir,
				v->entries[i].token, v->entries[i].id, words);
	return 0;
}

static int read_bert(struct encoder *x, const char *dir, struct err *e)
{
	if (vocab_read(&x->vocab, dir, e) || bert_model_read(&x->tower, dir, e) ||
		check_vocab(&x->vocab, x->tower.words, dir, e))
		return -1;
	x->fingerprint = fingerprint_encoder(&x->tower, &x->vocab, NULL, x->is_static);
	return 0;
}

static int read_clip(struct encoder *x, const char *dir, struct err *e)
{
	if (clip_model_read(&x->tower, dir, e) || merges_read(&x->bpe, dir, x->tower.words, e) ||
		check_vocab(&x->bpe.vocab, x->tower.words, dir, e))
		return -1;
	x->fingerprint = fingerprint_encoder(&x->tower, &x->bpe.vocab, &x->bpe, x->is_static);
	return 0;
}

int encoder_read(struct encoder *x, const char *dir, int is_static, struct err *e)
{
	x->is_static = is_static;
	x->is_clip = clip_model_is(dir);
	return x->is_clip ? read_clip(x, dir, e) : read_bert(x, dir, e);
}

void encoder_free(struct encoder *x)
{
	text_tower_free(&x->tower);
	vocab_free(&x->vocab);
	bpe_free(&x->bpe);
}

int encoder_width(const struct encoder *x)
{
	return x->is_static ? x->tower.body.width : text_tower_width(&x->tower);
}

size_t encoder_positions(const struct encoder *x)
{
	return (size_t)x->tower.positions;
}

int32_t encoder_first(const struct encoder *x)
{
	return x->is_clip ? x->bpe.start : x->vocab.special[WORDPIECE_CLS];
}

int32_t encoder_last(const struct encoder *x)
{
	return x->is_clip ? x->bpe.end : x->vocab.special[WORDPIECE_SEP];
}

int encoder_pools(const struct encoder *x)
{
	return x->is_clip && !x->is_static;
}

int encoder_cut(const struct encoder *x, const char *text, struct wordpieces *out, struct err *e)
{
	return x->is_clip ? bpe_encode(&x->bpe, text, out, e) : wordpiece_encode(&x->vocab, text, out, e);
}

char *encoder_print(const struct encoder *x, const int32_t *ids, size_t n, struct err *e)
{
	return x->is_clip ? merges_print(&x->bpe, ids, n, e) : vocab_print(&x->vocab, ids, n, e);
}

int encoder_has_middle(const struct encoder *x)
{
	return !x->is_clip && !x->is_static;
}

void encoder_forward(const struct encoder *x, const int32_t *ids, const size_t *starts, size_t n, float *out,
	float *middle, float *scratch)
{
	if (x->is_static)
		text_tower_static(&x->tower, ids + starts[0], starts[n] - starts[0], out);
	else
		text_tower_forward(&x->tower, ids, starts, n, out, middle, scratch);
}
