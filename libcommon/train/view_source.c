#include "train/view_source.h"

static int is_read(const struct view_source *s, size_t view)
{
	return s->open && !s->views[view].weights.indptr;
}

int view_source_open(const struct view_source *s, size_t view, struct view_weights *w, struct err *e)
{
	if (is_read(s, view))
		return s->open(s->context, view, w, e);
	*w = s->views[view].weights;
	return 0;
}

void view_source_close(const struct view_source *s, size_t view)
{
	if (is_read(s, view))
		s->close(s->context, view);
}
