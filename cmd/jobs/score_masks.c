#include "cmd/jobs/score_masks.h"

#include "base/file.h"
#include "base/mem.h"

#include <stdlib.h>

void score_masks_free(struct score_masks *s)
{
	masks_free(&s->set);
	free(s->masks);
	*s = (struct score_masks){0};
}

static int list_masks(struct score_masks *s, const long *lines, struct err *e)
{
	size_t earlier, later;

	s->masks = mem_alloc(s->set.n, sizeof *s->masks, s->path, e);
	if (!s->masks)
		return -1;
	for (size_t i = 0; i < s->set.n; i++) {
		const struct mask_record *r = &s->set.records[i];
		s->masks[i] = (struct score_mask){r->view, r->ref, r->object, &r->mask};
	}
	s->n = s->set.n;
	int found = score_duplicate(s->masks, s->n, &earlier, &later, e);
	if (found <= 0)
		return found;
	const struct score_mask *m = &s->masks[later];
	return err_set(e, ERR_FORMAT, "%s:%ld: view '%s', %s '%s' is on line %ld already", file_name(s->path),
		lines[later], m->view, m->ref ? "ref" : "object", m->ref ? m->ref : m->object,
		lines[earlier]);
}

int score_masks_read(struct score_masks *s, const char *path, struct err *e)
{
	long *lines;

	*s = (struct score_masks){.path = path};
	if (masks_read_lines(&s->set, &lines, path, e))
		return -1;
	int bad = list_masks(s, lines, e);
	free(lines);
	if (bad)
		score_masks_free(s);
	return bad;
}
