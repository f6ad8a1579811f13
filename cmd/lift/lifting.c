#include "cmd/lift/lifting.h"

#include "base/each.h"
#include "base/file.h"
#include "base/mem.h"
#include "formats/scene/weights.h"
#include "splat/weights_pack.h"

#include <math.h>

/* Sentences that name no object of the model stay out. */
int lifting_add_sentences(struct lifting *lifting, struct err *e)
{
	struct lifted *l = &lifting->model;
	const struct text *t = &lifting->text;
	const size_t *object = lifting->sentence_object;
	const size_t width = (size_t)t->width, words = (size_t)t->offsets[t->n];

	l->width = t->width;
	l->names = mem_zalloc(l->objects, sizeof *l->names, "objects", e);
	l->object = mem_alloc(t->n, sizeof *l->object, "sentences", e);
	l->texts = mem_zalloc(t->n, sizeof *l->texts, "sentences", e);
	l->pieces = mem_zalloc(t->n, sizeof *l->pieces, "sentences", e);
	l->offsets = mem_zalloc(t->n + 1, sizeof *l->offsets, "sentences", e);
	l->words = mem_alloc(words, width * sizeof *l->words, "sentences", e);
	if (t->middle)
		l->middle = mem_alloc(words, width * sizeof *l->middle, "sentences", e);
	if (!l->names || !l->object || !l->texts || !l->pieces || !l->offsets || !l->words ||
		(t->middle && !l->middle))
		return -1;
	for (size_t o = 0; o < l->objects; o++)
		if (!(l->names[o] = mem_strdup(lifting->names[o], e)))
			return -1;
	for (size_t i = 0; i < t->n; i++) {
		if (object[i] == LIFTING_NONE)
			continue;
		const size_t to = l->sentences++, from = (size_t)t->offsets[i];
		const size_t count = (size_t)t->offsets[i + 1] - from, at = (size_t)l->offsets[to];
		l->object[to] = (int32_t)object[i];
		memcpy(l->words + at * width, t->words + from * width, count * width * sizeof *l->words);
		if (t->middle)
			memcpy(l->middle + at * width, t->middle + from * width,
				count * width * sizeof *l->middle);
		l->offsets[to + 1] = (int64_t)(at + count);
		if (!(l->texts[to] = mem_strdup(t->texts[i], e)) ||
			!(l->pieces[to] = mem_strdup(t->pieces[i], e)))
			return -1;
	}
	return 0;
}

/* The masks of a file, and the view of each, after those that there are. */
static int add_masks(struct lifting *l, const char *path, const struct report *to, struct err *e)
{
	struct masks set;
	SCOPED long *lines = NULL;
	size_t taken = 0;

	if (masks_read_lines(&set, &lines, path, e))
		return -1;
	int bad = mem_grow((void **)&l->views, &l->view_capacity, l->set.n + set.n + 1, sizeof *l->views,
			  "masks", e) ||
		  masks_views(&set, lines, path, &l->scene.cameras, l->views + l->set.n, to, e);
	while (taken < set.n && !bad)
		bad = masks_add(&l->set, &set.items[taken++], e);
	while (taken < set.n)
		mask_free(&set.items[taken++]);
	free(set.items);
	return bad ? -1 : 0;
}

static int load(struct lifting *l, const struct report *to, struct err *e)
{
	if (scene_read(&l->scene, l->files->scene, e) || text_read(&l->text, l->files->text, e) ||
		(l->files->masks && (add_masks(l, l->files->masks, to, e) ||
					    masks_check_refs(&l->set, l->files->masks, l->text.refs,
						    l->text.objects, l->text.n, e))) ||
		(l->files->regions && (regions_file_read(&l->regions, l->files->regions, e) ||
					      fingerprint_check("scene", l->files->regions, &l->regions.scene,
						      l->files->scene, &l->scene.fingerprint, e))))
		return -1;
	l->own = l->set.n;
	if (l->files->spare && add_masks(l, l->files->spare, to, e))
		return -1;
	if (!l->text.pieces)
		return err_set(e, ERR_FORMAT, "%s: has no word pieces: encode the sentences anew",
			file_name(l->files->text));
	l->mask_object = mem_alloc(l->set.n, sizeof *l->mask_object, "masks", e);
	l->sentence_object = mem_alloc(l->text.n, sizeof *l->sentence_object, "sentences", e);
	l->names = mem_alloc(
		l->text.n + l->set.n - l->own + l->regions.chosen_count, sizeof *l->names, "objects", e);
	l->trained = mem_alloc(l->text.n, sizeof *l->trained, "sentences", e);
	l->is_shown = mem_zalloc(l->text.n, 1, "sentences", e);
	l->is_there = mem_zalloc(l->scene.cameras.n, 1, "views", e);
	if (!l->mask_object || !l->sentence_object || !l->names || !l->trained || !l->is_shown ||
		!l->is_there)
		return -1;
	memset(l->is_shown, l->files->regions != NULL, l->text.n);
	return mask_index_make(&l->index, l->set.items, l->set.n, MASK_BY_OBJECT, e);
}

/* Which training views can be looked at. */
static int find_views(struct lifting *l, const struct report *to, struct err *e)
{
	size_t left_out;

	if (weights_mark(l->files->weights, &l->scene.cameras, l->is_there, &left_out, e))
		return -1;
	if (left_out)
		report_warn(to, "%s: %zu training views have no weights, and their masks do not count",
			l->files->weights, left_out);
	return 0;
}

/* The first training sentence of a mask's object: a sentence's mask is its object's, but those of test
 * sentences, and of views without weights, are not looked at. NAMES_NONE where the mask does not count. */
static size_t sentence_of_mask(const struct lifting *l, size_t mask)
{
	const struct mask *m = &l->set.items[mask];
	const size_t ref = m->ref ? names_find(&l->refs, m->ref) : NAMES_NONE;
	const char *name = ref == NAMES_NONE ? m->object : l->trained[ref];

	return name && l->is_there[l->views[mask]] ? names_find(&l->objects_of, name) : NAMES_NONE;
}

static int find_sentences(struct lifting *l, struct err *e)
{
	const size_t n = l->text.n;

	for (size_t i = 0; i < n; i++)
		l->trained[i] =
			l->text.splits[i] == SPLIT_TRAIN && *l->text.objects[i] ? l->text.objects[i] : NULL;
	if (names_make(&l->refs, l->text.refs, sizeof(char *), 0, n, e) ||
		names_make(&l->objects_of, l->trained, sizeof(char *), 0, n, e))
		return -1;
	for (size_t i = 0; i < l->own; i++) {
		l->mask_object[i] = sentence_of_mask(l, i);
		if (l->mask_object[i] != NAMES_NONE)
			l->is_shown[l->mask_object[i]] = 1;
	}
	return 0;
}

/* The objects that a training sentence names and a mask shows. */
static void find_objects(struct lifting *l, const struct report *to)
{
	size_t unknown = 0;

	for (size_t i = 0; i < l->text.n; i++) {
		const size_t first = l->trained[i] ? names_find(&l->objects_of, l->trained[i]) : i;
		l->sentence_object[i] = first < i ? l->sentence_object[first] : LIFTING_NONE;
		if (first < i || !l->trained[i])
			continue;
		if (l->is_shown[i])
			l->names[l->sentence_object[i] = l->objects++] = l->text.objects[i];
		else
			report_warn(to, "%s: '%s' has no mask in a training view, and is left out",
				file_name(l->files->masks), l->trained[i]);
	}
	for (size_t i = 0; i < l->own; i++) {
		const size_t first = l->mask_object[i];
		l->mask_object[i] = first == NAMES_NONE ? LIFTING_NONE : l->sentence_object[first];
		unknown += l->is_there[l->views[i]] && l->mask_object[i] == LIFTING_NONE;
	}
	if (unknown)
		report_warn(to, "%s: %zu masks are of no training sentence's object",
			file_name(l->files->masks), unknown);
}

/* Spare regions are objects without a name, after the others, in the order in which they first come. */
static int find_spare(struct lifting *l, struct err *e)
{
	const size_t n = l->set.n - l->own;
	const struct mask *masks = l->set.items + l->own;
	size_t *number = l->mask_object + l->own;
	SCOPED_BY(names_free) struct names regions = {0};

	if (names_make(&regions, masks, sizeof *masks, offsetof(struct mask, object), n, e))
		return -1;
	for (size_t i = 0; i < n; i++) {
		const size_t first = masks[i].object ? names_find(&regions, masks[i].object) : NAMES_NONE;
		if (first == i)
			l->names[l->objects + l->spare] = "";
		number[i] = first == NAMES_NONE ? LIFTING_NONE
			    : first < i		? number[first]
						: l->objects + l->spare++;
	}
	for (size_t i = 0; i < n; i++)
		if (!l->is_there[l->views[l->own + i]])
			number[i] = LIFTING_NONE;
	return 0;
}

static int by_object(const void *a, const void *b)
{
	const struct lift_mask *x = a, *y = b;

	return (x->object > y->object) - (x->object < y->object);
}

/* The masks of a view that count, in the order of their objects. */
static size_t masks_of_view(const struct lifting *l, size_t view, struct lift_mask *masks)
{
	size_t n = 0, begin, end;

	mask_index_view(&l->index, l->scene.cameras.views[view].name, &begin, &end);
	for (size_t k = begin; k < end; k++) {
		const size_t i = l->index.keys[k].at;
		if (l->mask_object[i] != LIFTING_NONE)
			masks[n++] = (struct lift_mask){&l->set.items[i], l->mask_object[i]};
	}
	qsort(masks, n, sizeof *masks, by_object);
	return n;
}

struct lift_round {
	struct lifting *l;
	const struct report *to;
	int round;
	struct lift_mask *masks;    /* (workers, set.n) */
	struct weights_room *rooms; /* (workers) */
};

static int lift_view(void *context, int worker, size_t view, struct err *e)
{
	const struct lift_round *r = context;
	struct lifting *l = r->l;
	struct lift_mask *masks = r->masks + (size_t)worker * l->set.n;
	const size_t n = masks_of_view(l, view, masks);
	SCOPED_BY(weights_close) struct weights weights = {0};

	if (!n)
		return 0;
	if (weights_open_in(
		    &weights, &r->rooms[worker], WEIGHTS_TILES, l->files->weights, &l->scene, view, e))
		return -1;
	const struct view_matrix w = weights_matrix(&weights);
	return r->round ? lift_objects_vote(&l->lift, view, &w, e)
			: lift_objects_view(&l->lift, view, &w, masks, n, e);
}

static int step(void *context, size_t view, struct err *e)
{
	const struct lift_round *r = context;
	(void)e;

	report_step(r->to, (double)((size_t)r->round * r->l->scene.cameras.n + view + 1), NULL);
	return 0;
}

static int lift(struct lifting *l, const struct report *to, struct err *e)
{
	const size_t n = l->scene.cameras.n;
	struct lift_round r = {.l = l, .to = to};
	const struct each by = {&r, each_workers(n), lift_view, step};

	r.masks = mem_alloc((size_t)by.workers, l->set.n * sizeof *r.masks, "masks", e);
	r.rooms = mem_zalloc((size_t)by.workers, sizeof *r.rooms, "views", e);
	int bad = !r.masks || !r.rooms ||
		  lift_objects_init(&l->lift, l->scene.splats.n, l->objects + l->spare, n, e);
	for (; r.round < LIFT_ROUNDS && !bad; r.round++)
		bad = each_run(&by, n, e) || lift_objects_settle(&l->lift, e);
	for (int i = 0; i < by.workers && r.rooms; i++)
		weights_room_free(&r.rooms[i]);
	mem_free_all(r.rooms, r.masks);
	return bad || lift_objects_finish(&l->lift, &l->model, e) ? -1 : 0;
}

int lifting_read(struct lifting *l, const struct lifting_files *files, const struct report *to, struct err *e)
{
	l->files = files;
	if (load(l, to, e) || parser_weights_default(&l->weights, e) ||
		parser_weights_need_middle(
			&l->weights, file_name(files->text), l->text.middle, &l->text.encoder, e) ||
		(l->files->weights && find_views(l, to, e)) || find_sentences(l, e))
		return -1;
	find_objects(l, to);
	if (l->own && !l->objects)
		return err_set(e, ERR_FORMAT,
			"%s: no mask of a training view is of a training sentence's object of %s",
			file_name(files->masks), file_name(files->text));
	return find_spare(l, e);
}

/* A person gives no score, every detector and pseudomask-select does. */
static int find_fixed(struct lifting *l, int is_as_masked, struct err *e)
{
	l->is_fixed = mem_zalloc(l->objects + l->spare, 1, "objects", e);
	l->found = mem_zalloc(l->objects, sizeof *l->found, "objects", e);
	if (!l->is_fixed || !l->found)
		return -1;
	for (size_t i = 0; i < l->own; i++)
		if (l->mask_object[i] != LIFTING_NONE && l->is_there[l->views[i]])
			l->is_fixed[l->mask_object[i]] |= is_as_masked || isnan(l->set.items[i].score);
	return 0;
}

/* Warns of sentences that say otherwise, and of what changed places: one line. How many did. */
static size_t tell_names(const struct lifting *l, const struct report *to)
{
	const char *path = file_name(l->files->masks);
	const struct disambiguated *first = NULL;
	size_t moved = 0, at = 0;

	for (size_t o = 0; o < l->objects; o++) {
		const struct disambiguated *d = &l->found[o];
		if (d->is_moved && !moved++) {
			first = d;
			at = o;
		} else if (l->is_fixed[o] && d->against)
			report_warn(to,
				"%s: %zu of the %zu sentences of '%s' say another thing, as '%s', which fits '%s' (%.2f against %.2f): the label stays; is the sentence of it?",
				path, d->against, d->sentences, l->names[o], l->model.texts[d->sentence],
				l->names[d->other], (double)d->other_p, (double)d->own_p);
	}
	if (moved)
		report_warn(to,
			"%s: %zu objects have masks that a detector found for others, as their sentences say: '%s' has those of %s%s%s, by '%s' (%.2f against %.2f); --names masks keeps them",
			path, moved, l->names[at], *l->names[first->other] ? "'" : "",
			*l->names[first->other] ? l->names[first->other] : "a region without a name",
			*l->names[first->other] ? "'" : "", l->model.texts[first->sentence],
			(double)first->other_p, (double)first->own_p);
	return moved;
}

int lifting_make(struct lifting *l, int is_as_masked, size_t *moved, const struct report *to, struct err *e)
{
	const struct parser parser = {.weights = &l->weights, .encoder = l->text.encoder.hex};

	report_start(to, "views", (double)l->scene.cameras.n * LIFT_ROUNDS);
	int bad = lift(l, to, e);
	report_end(to);
	if (bad || lifting_add_sentences(l, e) || find_fixed(l, is_as_masked, e) ||
		disambiguate(&l->model, l->objects, l->is_fixed, &l->scene.splats, &l->scene.cameras, &parser,
			l->found, e))
		return -1;
	*moved = tell_names(l, to);
	lifted_cut(&l->model, l->objects);
	return 0;
}

void lifting_free(struct lifting *l)
{
	scene_free(&l->scene);
	text_free(&l->text);
	masks_free(&l->set);
	mask_index_free(&l->index);
	mem_free_all(l->views, l->sentence_object, l->mask_object);
	names_free(&l->refs);
	names_free(&l->objects_of);
	mem_free_all(l->trained, l->is_fixed, l->found, l->is_shown, l->names, l->is_there);
	lift_objects_free(&l->lift);
	lifted_free(&l->model);
	regions_file_free(&l->regions);
	parser_weights_free(&l->weights);
}
