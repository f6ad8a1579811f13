#include "cmd/feature/feature_lifting.h"

#include "base/file.h"
#include "base/mem.h"
#include "base/path.h"

#include <stdio.h>

/* 1 where the folder has VIEW and the suffix, or the .npz has it, 0 where not, -1 with *e. */
static int has_file(
	const struct feature_maps *m, const char *view, const char *suffix, const char *ending, struct err *e)
{
	char name[16];

	if (m->is_npz)
		return strcmp(ending, ".npy") ? 0 : npz_has(&m->npz, view, suffix, e);
	snprintf(name, sizeof name, "%s%s", suffix, ending);
	SCOPED char *path = file_join(m->options->folder, view, name, e);
	return path ? file_exists(path) : -1;
}

/* The kind of files that a view has: 0, or -1 with *e. */
static int find_kind(
	const struct feature_maps *m, const char *view, enum feature_maps_kind *kind, struct err *e)
{
	static const struct {
		const char *suffix, *ending;
		enum feature_maps_kind kind;
	} files[] = {{"", ".npy", MAPS_CELLS}, {"", ".npz", MAPS_CELLS}, {"_s", ".npy", MAPS_SEGMENTS},
		{"", ".png", MAPS_LABELS}};

	*kind = MAPS_NONE;
	for (size_t k = 0; k < sizeof files / sizeof *files && *kind == MAPS_NONE; k++) {
		const int found = has_file(m, view, files[k].suffix, files[k].ending, e);
		if (found < 0)
			return -1;
		*kind = found ? files[k].kind : MAPS_NONE;
	}
	return 0;
}

/* What is said where no training view has anything. */
static int find_nothing(const struct feature_maps *m, struct err *e)
{
	const char *dir = m->options->folder;

	if (m->is_npz)
		return err_set(e, ERR_FORMAT, "%s: has no VIEW.npy or VIEW_s.npy of a training view", dir);
	if (!file_is_dir(dir))
		return err_set(e, ERR_SYSTEM, "%s: no such folder", dir);
	return err_set(e, ERR_FORMAT,
		"%s: has no VIEW.npy, VIEW.npz, VIEW_s.npy or VIEW.png of a training view", dir);
}

static int find_files(struct feature_maps *m, const struct report *to, struct err *e)
{
	const struct cameras *c = &m->scene->cameras;
	const char *dir = m->options->folder;
	size_t missing = 0;

	m->is_npz = path_ends(dir, ".npz") && !file_is_dir(dir);
	if (m->is_npz && npz_open(&m->npz, dir, e))
		return -1;
	for (size_t v = 0; v < c->n; v++) {
		enum feature_maps_kind kind;
		if (c->views[v].split != SPLIT_TRAIN)
			continue;
		if (find_kind(m, c->views[v].name, &kind, e))
			return -1;
		if (m->kind == MAPS_NONE)
			m->kind = kind;
		m->is_there[v] = kind != MAPS_NONE && kind == m->kind;
		missing += !m->is_there[v];
	}
	if (m->kind == MAPS_NONE)
		return find_nothing(m, e);
	if (missing)
		report_warn(to, "%s: %zu training views have no features", dir, missing);
	return 0;
}

/* The sentence, or the number from 1 on of the object, that each mask is of. */
static int find_rows(struct feature_maps *m, const struct report *to, struct err *e)
{
	const struct feature_maps_options *o = m->options;
	SCOPED_BY(names_free) struct names refs = {0}, objects = {0};
	size_t unknown = 0, labels = 0;
	char **names = o->text ? m->text.objects : mem_alloc(m->set.n, sizeof *names, "masks", e);

	for (size_t i = 0; i < m->set.n && names && !o->text; i++)
		names[i] = (char *)(size_t)mask_object(&m->set.items[i]);
	int bad = !names ||
		  (o->text && names_make(&refs, m->text.refs, sizeof *m->text.refs, 0, m->text.n, e)) ||
		  names_make(&objects, names, sizeof *names, 0, o->text ? m->text.n : m->set.n, e);
	for (size_t i = 0; i < m->set.n && !bad; i++) {
		const struct mask *mask = &m->set.items[i];
		size_t at = o->text && mask->ref ? names_find(&refs, mask->ref) : NAMES_NONE;
		if (at == NAMES_NONE && (mask->object || !o->text))
			at = names_find(&objects, mask_object(mask));
		m->row[i] = at == NAMES_NONE ? -1 : (int32_t)at;
		if (!o->text)
			m->row[i] = at == i ? (int32_t)++labels : m->row[at];
		unknown += at == NAMES_NONE;
	}
	if (unknown)
		report_warn(to, "%s: %zu masks are of no sentence of %s", file_name(o->masks), unknown,
			file_name(o->text));
	if (!o->text)
		free(names);
	return bad ? -1 : 0;
}

static int find_masks(struct feature_maps *m, const struct report *to, struct err *e)
{
	const struct feature_maps_options *o = m->options;
	const struct cameras *c = &m->scene->cameras;
	SCOPED long *lines = NULL;
	SCOPED size_t *views = NULL;

	int bad = masks_read_lines(&m->set, &lines, o->masks, e) ||
		  (o->text && (text_read(&m->text, o->text, e) ||
				      masks_check_refs(&m->set, o->masks, m->text.refs, m->text.objects,
					      m->text.n, e))) ||
		  !(views = mem_alloc(m->set.n, sizeof *views, "masks", e)) ||
		  masks_views(&m->set, lines, o->masks, c, views, to, e) ||
		  mask_index_make(&m->index, m->set.items, m->set.n, MASK_BY_OBJECT, e) ||
		  !(m->row = mem_alloc(m->set.n, sizeof *m->row, "masks", e)) || find_rows(m, to, e);
	for (size_t v = 0; v < c->n && !bad; v++)
		m->is_there[v] = c->views[v].split == SPLIT_TRAIN;
	m->kind = o->text ? MAPS_MASKS : MAPS_MASK_LABELS;
	m->channels = (size_t)m->text.width;
	return bad ? -1 : 0;
}

int feature_maps_find(struct feature_maps *m, const struct feature_maps_options *options,
	const struct scene *scene, const struct report *to, struct err *e)
{
	m->options = options;
	m->scene = scene;
	m->is_there = mem_zalloc(scene->cameras.n, 1, "views", e);
	if (!m->is_there || (options->folder ? find_files(m, to, e) : find_masks(m, to, e)))
		return -1;
	for (size_t v = 0; v < scene->cameras.n && !m->channels; v++)
		if (m->is_there[v] && feature_tables_channels(m, v, &m->channels, e))
			return -1;
	return 0;
}

void feature_maps_free(struct feature_maps *m)
{
	npz_close(&m->npz);
	masks_free(&m->set);
	mask_index_free(&m->index);
	text_free(&m->text);
	mem_free_all(m->is_there, m->row);
	*m = (struct feature_maps){0};
}

void feature_sources_free(struct feature_sources *s)
{
	npy_close(&s->table);
	mem_free_all(s->source, s->row, s->label, s->place, s->raw, s->mask);
	*s = (struct feature_sources){0};
}

static int make_room(struct feature_sources *s, size_t pixels, size_t rows, struct err *e)
{
	return mem_room((void **)&s->source, &s->pixel_room, pixels, sizeof *s->source, "pixels", e) ||
	       mem_room((void **)&s->place, &s->place_room, rows, sizeof *s->place, "sources", e) ||
	       mem_room((void **)&s->row, &s->row_room, pixels + 1, sizeof *s->row, "sources", e) ||
	       mem_room((void **)&s->label, &s->label_room, pixels + 1, sizeof *s->label, "sources", e);
}

/* Sources for the rows that a pixel has, in the order of the rows; the last one, where it is wanted, for
 * pixels without. */
static int take_sources(
	const struct feature_maps *m, struct feature_sources *s, size_t pixels, size_t rows, struct err *e)
{
	const int is_label = !m->channels;

	if (make_room(s, pixels, rows, e))
		return -1;
	memset(s->place, 0, rows * sizeof *s->place);
	for (size_t p = 0; p < pixels; p++)
		if (s->raw[p] >= 0)
			s->place[s->raw[p]] = 1;
	s->count = 0;
	for (size_t r = 0; r < rows; r++)
		if (s->place[r]) {
			s->row[s->count] = r;
			s->label[s->count] = (int32_t)r;
			s->place[r] = (int32_t)s->count++;
		}
	const int32_t none = !is_label && m->options->is_zero ? (int32_t)s->count : -1;
	for (size_t p = 0; p < pixels; p++)
		s->source[p] = s->raw[p] < 0 ? none : s->place[s->raw[p]];
	if (none >= 0)
		s->row[s->count++] = FEATURES_ZERO;
	return 0;
}

int feature_maps_view(
	struct feature_maps *m, size_t view, int height, int width, struct feature_sources *s, struct err *e)
{
	const size_t pixels = (size_t)height * (size_t)width;
	size_t rows;

	if (mem_room((void **)&s->raw, &s->raw_room, pixels, sizeof *s->raw, "pixels", e))
		return -1;
	return -(feature_tables_open(m, view, height, width, s, &rows, e) ||
		 take_sources(m, s, pixels, rows, e));
}
