#include "cmd/lift/proposing.h"

#include "base/compare.h"
#include "base/each.h"
#include "base/file.h"
#include "base/mem.h"
#include "base/names.h"
#include "cmd/import/warping.h"
#include "formats/records/masks.h"
#include "formats/scene/proposed.h"
#include "formats/scene/weights.h"
#include "mask/shrink.h"
#include "splat/backproject.h"
#include "splat/weights_pack.h"

#include <math.h>
#include <stdio.h>

/* Found on Ref-Synth and the desk's training views. */
#define KEPT_WEIGHT 0.98 /* of all blend weight that the Gaussians with neighbours have */
enum { NEIGHBOURS = 12 };
#define LINKAGE_POWER 0.1
#define LEAST_REGION 2e-4 /* of all blend weight that a node has */
/* IoU above which two regions are one. Photographs alone have many regions that nearly agree. */
#define NESTED_AGREE (p->box_count ? 0.9 : 0.7)

void proposing_free(struct proposing *p)
{
	for (size_t v = 0; v < p->scene.cameras.n && p->views; v++) {
		pieces_free(&p->views[v].pieces);
		free(p->views[v].boxes);
		free(p->views[v].shown.nodes);
	}
	mem_free_all(p->views, p->weight, p->score);
	region_scores_free(&p->scores);
	mem_free_strings(p->classes, p->class_count);
	free(p->chosen);
	affinity_free(&p->affinity);
	region_tree_free(&p->tree);
	scene_free(&p->scene);
}

/* The size of a view's weights, and what they have of each Gaussian. */
static int weigh_view(struct proposing *p, size_t at, struct weights_room *room, struct err *e)
{
	struct proposing_view *v = &p->views[at];
	SCOPED_BY(weights_close) struct weights w = {0};

	if (weights_open_in(&w, room, WEIGHTS_ROWS, p->options->weights, &p->scene, at, e))
		return -1;
	v->shown.height = w.height;
	v->shown.width = w.width;
	const struct view_weights rows = weights_view(&w);
	backproject_weight(&rows, p->weight);
	return 0;
}

static int read_pieces(void *context, int worker, size_t at, struct err *e)
{
	struct proposing *p = context;
	struct proposing_view *v = &p->views[at];
	uint8_t *rgb = NULL;
	int height, width;

	(void)worker;
	if (!v->is_used)
		return 0;
	if (warping_read_photograph(
		    &p->scene.cameras.views[at], p->options->scene, 0, &rgb, &height, &width, e))
		return -1;
	SCOPED uint8_t *small = shrink_picture(rgb, height, width, v->shown.height, v->shown.width, e);
	free(rgb);
	return !small || pieces_make(&v->pieces, small, v->shown.height, v->shown.width, e) ? -1 : 0;
}

/* The words for what boxes are of, in their own order. */
static int take_classes(struct proposing *p, const struct names *words, struct err *e)
{
	p->classes = mem_zalloc(names_count(words), sizeof *p->classes, "boxes", e);
	for (size_t i = 0; i < words->n && p->classes; i++) {
		const char *word = words->sorted[i].name;
		if (i && !strcmp(word, words->sorted[i - 1].name))
			continue;
		if (!(p->classes[p->class_count++] = mem_strdup(word, e)))
			return -1;
	}
	return p->classes ? 0 : -1;
}

static int32_t class_of(const struct proposing *p, const char *word)
{
	char **at = word && p->class_count
			    ? bsearch(&word, p->classes, p->class_count, sizeof word, compare_string)
			    : NULL;

	return at ? (int32_t)(at - p->classes) : -1;
}

/* A detection of a view, in pixels of its weights. */
static int take_box(struct proposing_view *v, const struct detection *d, int32_t class, struct err *e)
{
	const double across = (double)v->shown.width / d->width, down = (double)v->shown.height / d->height;
	size_t room = v->box_count;

	if (mem_grow((void **)&v->boxes, &room, v->box_count + 1, sizeof *v->boxes, "boxes", e))
		return -1;
	v->boxes[v->box_count++] = (struct affinity_box){
		d->box[0] * across, d->box[1] * down, d->box[2] * across, d->box[3] * down, d->score, class};
	return 0;
}

static int take_boxes(struct proposing *p, const struct report *to, struct err *e)
{
	const struct cameras *c = &p->scene.cameras;
	SCOPED_BY(names_free) struct names names = {0}, words = {0};
	SCOPED_BY(detections_free) struct detections all = {0};

	if (detections_read(&all, p->options->boxes, e) ||
		names_make(&names, c->views, sizeof *c->views, offsetof(struct camera, name), c->n, e) ||
		names_make(
			&words, all.items, sizeof *all.items, offsetof(struct detection, name), all.n, e) ||
		take_classes(p, &words, e))
		return -1;
	for (size_t i = 0; i < all.n; i++) {
		const size_t at = names_find(&names, all.items[i].view);
		if (at == NAMES_NONE || !p->views[at].is_used)
			continue;
		p->box_count++;
		if (take_box(&p->views[at], &all.items[i], class_of(p, all.items[i].name), e))
			return -1;
	}
	report_note(to, 1, "%zu of %zu boxes are of these views", p->box_count, all.n);
	return p->box_count
		       ? 0
		       : err_file(e, file_name(p->options->boxes),
				 "no box is of a training view of %s; views are called there as in its cameras.json",
				 p->options->scene);
}

/* The views that are used: for training, with weights and a photograph. */
static int find_views(struct proposing *p, const struct report *to, struct err *e)
{
	const struct cameras *c = &p->scene.cameras;
	SCOPED char *is_there = mem_alloc(c->n, 1, "views", e);
	SCOPED_BY(weights_room_free) struct weights_room room = {0};
	size_t missing, used = 0;

	p->views = mem_zalloc(c->n, sizeof *p->views, "views", e);
	p->weight = mem_zalloc(p->scene.splats.n, sizeof *p->weight, "views", e);
	if (!is_there || !p->views || !p->weight ||
		weights_mark(p->options->weights, c, is_there, &missing, e))
		return -1;
	for (size_t v = 0; v < c->n; v++) {
		p->views[v].is_used = is_there[v] && c->views[v].image;
		used += (size_t)p->views[v].is_used;
		if (p->views[v].is_used && weigh_view(p, v, &room, e))
			return -1;
	}
	if (!used)
		return err_file(e, p->options->scene,
			"no training view has a photograph: import the scene with --images");
	report_note(to, 1, "%zu training views with a photograph and weights", used);
	return 0;
}

/* The Gaussians that have most of the weight, and which are neighbours. */
static int find_neighbours(struct proposing *p, const struct report *to, struct err *e)
{
	const size_t n = p->scene.splats.n;
	SCOPED struct ranked *by = mem_alloc(n, sizeof *by, "neighbours", e);
	SCOPED float *points = mem_alloc(n, 3 * sizeof *points, "neighbours", e);
	SCOPED int32_t *kept = mem_alloc(n, sizeof *kept, "neighbours", e);
	double all = 0, sum = 0;

	if (!by || !points || !kept)
		return -1;
	for (size_t i = 0; i < n; i++) {
		by[i] = (struct ranked){p->weight[i], i};
		all += p->weight[i];
	}
	qsort(by, n, sizeof *by, ranked_falling);
	for (p->kept = 0; p->kept < n && by[p->kept].by > 0 && sum < KEPT_WEIGHT * all; p->kept++) {
		sum += by[p->kept].by;
		kept[p->kept] = (int32_t)by[p->kept].at;
		memcpy(points + 3 * p->kept, p->scene.splats.means + 3 * (size_t)kept[p->kept],
			3 * sizeof *points);
	}
	if (affinity_init(&p->affinity, points, kept, p->kept, NEIGHBOURS, e))
		return -1;
	report_note(to, 1, "%zu of %zu Gaussians have %g of the weight, %zu pairs of neighbours", p->kept, n,
		KEPT_WEIGHT, p->affinity.count);
	return 0;
}

static int add_views(struct proposing *p, struct err *e)
{
	SCOPED_BY(weights_room_free) struct weights_room room = {0};

	for (size_t at = 0; at < p->scene.cameras.n; at++) {
		struct proposing_view *v = &p->views[at];
		SCOPED_BY(weights_close) struct weights w = {0};
		if (!v->is_used)
			continue;
		if (weights_open_in(&w, &room, WEIGHTS_TILES, p->options->weights, &p->scene, at, e))
			return -1;
		const struct view_matrix matrix = weights_matrix(&w);
		if (affinity_view(&p->affinity, &matrix, &v->pieces, v->boxes, v->box_count, e))
			return -1;
	}
	return 0;
}

static int grow_tree(struct proposing *p, struct err *e)
{
	const size_t n = p->scene.splats.n;
	SCOPED_BY(linkage_free) struct linkage l = {0};
	SCOPED struct linkage_edge *edges = mem_alloc(p->affinity.count, sizeof *edges, "neighbours", e);
	SCOPED double *size = mem_alloc(n, sizeof *size, "neighbours", e);
	double all = 0;

	if (!edges || !size)
		return -1;
	affinity_edges(&p->affinity, edges);
	for (size_t i = 0; i < n; i++) {
		size[i] = fmax(p->weight[i], 1e-9);
		all += p->weight[i];
	}
	if (linkage_make(&l, (int32_t)n, size, edges, p->affinity.count, LINKAGE_POWER, e) ||
		region_tree_make(&p->tree, &l, LEAST_REGION * all, e))
		return -1;
	affinity_free(&p->affinity);
	return 0;
}

static int score_view(struct proposing *p, size_t at, struct weights_room *room, struct err *e)
{
	struct proposing_view *v = &p->views[at];
	SCOPED_BY(weights_close) struct weights w = {0};

	if (weights_open_in(&w, room, WEIGHTS_ROWS, p->options->weights, &p->scene, at, e))
		return -1;
	const struct view_weights rows = weights_view(&w);
	return region_picture_take(&v->shown, &p->tree, &rows, e) ||
			       region_scores_view(&p->scores, &p->tree, v->shown.nodes, &v->pieces, v->boxes,
				       v->box_count, e)
		       ? -1
		       : 0;
}

static int choose_regions(struct proposing *p, const struct report *to, struct err *e)
{
	const struct proposing_options *o = p->options;
	const int32_t most = o->most	      ? (int32_t)o->most
			     : o->is_disjoint ? PROPOSING_DISJOINT
					      : PROPOSING_NESTED;
	const size_t n = (size_t)p->tree.n;
	SCOPED_BY(weights_room_free) struct weights_room room = {0};
	SCOPED double *value = mem_alloc(n, sizeof *value, "regions", e);

	p->score = mem_alloc(n, sizeof *p->score, "regions", e);
	p->chosen = mem_alloc((size_t)most, sizeof *p->chosen, "regions", e);
	if (!value || !p->score || !p->chosen ||
		region_scores_init(&p->scores, p->tree.n, (int32_t)p->class_count, e))
		return -1;
	for (size_t at = 0; at < p->scene.cameras.n; at++)
		if (p->views[at].is_used && score_view(p, at, &room, e))
			return -1;
	region_scores_end(&p->scores, p->box_count > 0, p->score);
	region_scores_value(&p->scores, p->score, value);
	p->count = o->is_disjoint ? region_tree_disjoint(&p->tree, value, most, p->chosen, e)
				  : region_tree_nested(&p->tree, p->score, p->scores.area, NESTED_AGREE, most,
					    p->chosen, e);
	if (p->count < 0)
		return -1;
	report_note(to, 1, "%d regions, of which %d are chosen", p->tree.n, p->count);
	return 0;
}

static int put_view(struct proposing *p, size_t at, FILE *out, struct err *e)
{
	const struct proposing_view *v = &p->views[at];
	SCOPED uint8_t *mask = mem_alloc((size_t)v->shown.height, (size_t)v->shown.width, "masks", e);
	char name[32];
	int bad = !mask;

	for (int32_t k = 0; k < p->count && !bad; k++) {
		const int32_t node = p->chosen[k];
		struct mask m = {.view = p->scene.cameras.views[at].name,
			.object = name,
			.score = p->score[node],
			.visible = NAN};
		snprintf(name, sizeof name, "region-%d", k + 1);
		if (!region_tree_mask(&p->tree, v->shown.nodes,
			    (size_t)v->shown.height * (size_t)v->shown.width, node, mask))
			continue;
		bad = rle_encode(&m.rle, mask, v->shown.height, v->shown.width, e) || masks_put(out, &m, e);
		rle_free(&m.rle);
	}
	return bad ? -1 : 0;
}

static int put_all(struct proposing *p, FILE *out, struct err *e)
{
	const struct cameras *c = &p->scene.cameras;
	double scale = 1;

	for (size_t at = 0; at < c->n; at++)
		if (p->views[at].is_used)
			scale = (double)p->views[at].shown.width / c->views[at].width;
	for (size_t at = 0; at < c->n; at++) {
		const int is_train = c->views[at].split == SPLIT_TRAIN;
		if (p->options->split != PROPOSING_ALL && is_train != (p->options->split == PROPOSING_TRAIN))
			continue;
		struct region_picture *shown = &p->views[at].shown;
		if ((!shown->nodes &&
			    region_picture_render(shown, &p->tree, &p->scene, &c->views[at], scale, e)) ||
			put_view(p, at, out, e))
			return -1;
	}
	return 0;
}

static int write_regions(const struct proposing *p, struct err *e)
{
	const size_t classes = p->class_count, count = (size_t)p->count;
	SCOPED float *score = mem_alloc((size_t)p->tree.n, sizeof *score, "regions", e);
	SCOPED float *votes = mem_alloc(count, classes * sizeof *votes, "regions", e);
	const struct regions_file file = {
		p->tree, score, count, p->chosen, classes, p->classes, votes, p->scene.fingerprint};

	if (!score || !votes)
		return -1;
	for (size_t i = 0; i < count * classes; i++)
		votes[i] = (float)p->scores.votes[(size_t)p->chosen[i / classes] * classes + i % classes];
	for (int32_t k = 0; k < p->tree.n; k++)
		score[k] = (float)p->score[k];
	return regions_file_write(&file, p->options->regions, p->options->boxes ? "--boxes" : "", e);
}

int proposing_write(
	struct proposing *p, const struct proposing_options *options, const struct report *to, struct err *e)
{
	struct file_out out;

	p->options = options;
	if (scene_read(&p->scene, options->scene, e) || find_views(p, to, e) ||
		(options->boxes && take_boxes(p, to, e)) || find_neighbours(p, to, e))
		return -1;
	const struct each by = {p, each_workers(p->scene.cameras.n), read_pieces, NULL};
	if (each_run(&by, p->scene.cameras.n, e) || add_views(p, e) || grow_tree(p, e) ||
		choose_regions(p, to, e) || (options->regions && write_regions(p, e)) ||
		file_out_open(&out, options->output, e))
		return -1;
	return file_out_end(&out, put_all(p, out.stream, e), e);
}
