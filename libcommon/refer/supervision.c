#include "refer/supervision.h"

#include "base/mem.h"

#include <stdlib.h>
#include <string.h>

static int same(const char *a, const char *b)
{
	return a && b && !strcmp(a, b);
}

static const struct supervision_mask *find(
	const struct supervision *s, size_t view, const char *ref, const char *object)
{
	for (size_t i = 0; i < s->n; i++) {
		const struct supervision_mask *m = &s->masks[i];
		if (m->view == view && (ref ? same(m->ref, ref) : !m->ref && same(m->object, object)))
			return m;
	}
	return NULL;
}

int supervision_add(struct supervision *s, size_t view, int width, int height, const char *ref,
	const char *object, const struct rle *mask, struct err *e)
{
	struct rle resized = {0};
	void *block = s->masks;

	if (find(s, view, ref, object))
		return err_set(e, ERR_FORMAT, "a second mask of %s '%s' in the same view",
			ref ? "ref" : "object", ref ? ref : object);
	if (mem_grow(&block, &s->capacity, s->n + 1, sizeof *s->masks, "masks", e))
		return -1;
	s->masks = block;
	struct supervision_mask *m = &s->masks[s->n];
	*m = (struct supervision_mask){.view = view};
	s->n++;
	if ((ref && !(m->ref = mem_strdup(ref, e))) || (object && !(m->object = mem_strdup(object, e))))
		return -1;
	m->pixels = mem_alloc((size_t)width, (size_t)height, "mask", e);
	if (!m->pixels || rle_resize(&resized, mask, height, width, e))
		return -1;
	rle_decode(&resized, m->pixels);
	rle_free(&resized);
	return 0;
}

void supervision_free(struct supervision *s)
{
	for (size_t i = 0; i < s->n; i++) {
		free(s->masks[i].ref);
		free(s->masks[i].object);
		free(s->masks[i].pixels);
	}
	free(s->masks);
	*s = (struct supervision){0};
}

int supervision_link(const struct supervision *s, const char *const *refs, const char *const *objects,
	size_t sentences, struct train_view *views, size_t view_count, struct err *e)
{
	for (size_t v = 0; v < view_count; v++) {
		views[v].count = 0;
		views[v].sentences = mem_alloc(sentences, sizeof *views[v].sentences, "sentences", e);
		views[v].masks = mem_alloc(sentences, sizeof *views[v].masks, "masks", e);
		if (!views[v].sentences || !views[v].masks)
			return -1;
		for (size_t r = 0; r < sentences; r++) {
			const struct supervision_mask *m = find(s, v, refs[r], NULL);
			if (!m)
				m = find(s, v, NULL, objects[r]);
			if (!m)
				continue;
			views[v].sentences[views[v].count] = (int)r;
			views[v].masks[views[v].count++] = m->pixels;
		}
	}
	return 0;
}

void supervision_unlink(struct train_view *views, size_t view_count)
{
	for (size_t v = 0; v < view_count; v++) {
		free(views[v].sentences);
		free(views[v].masks);
	}
}
