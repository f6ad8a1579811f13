/* Cosine and relevancy as they are published: for the pixels of a rendered feature map. A view's features are
 * blended some channels at a time, and only their inner products with the vectors and their length stay. */
#include "cmd/feature/feature_query.h"

#include "answer/peak.h"
#include "base/mem.h"
#include "formats/records/masks.h"
#include "lift/query_rules.h"
#include "splat/render.h"

#include <math.h>

struct pixels {
	struct feature_query *q;
	size_t level;
	float *packed; /* (C,N) features of the level, as render_pack has them */
	size_t view;   /* of q->views */
	const struct camera *camera;
	size_t n;	/* pixels */
	float *images;	/* (RENDER_GROUP,n) */
	float *cosines; /* (vectors,n) */
	double *length; /* (n) of the features of pixels; 0 of those that count as none */
	size_t images_room, cosines_room, length_room;
};

static int choose_views(struct feature_query *q, struct err *e)
{
	const struct cameras *c = &q->scene.cameras;
	const struct features *f = &q->features[0];

	if (scene_read(&q->scene, q->options->pixels, e) ||
		scene_check(&q->scene, f->file.path, f->gaussians, &f->scene, e) ||
		!(q->views = mem_alloc(c->n, sizeof *q->views, "views", e)))
		return -1;
	for (size_t v = 0; v < c->n; v++)
		if (c->views[v].split == SPLIT_TEST)
			q->views[q->view_count++] = v;
	size_t count;
	if (mem_size(q->view_count, q->count, &count))
		return err_set(e, ERR_SYSTEM, "masks do not fit in memory");
	q->shown = mem_zalloc(count, sizeof *q->shown, "masks", e);
	return q->shown ? 0 : -1;
}

/* The level's features, packed to be blended. */
static int pack(struct pixels *p, struct err *e)
{
	const struct features *f = &p->q->features[p->level];
	const size_t n = f->gaussians, channels = f->channels;
	SCOPED float *row = mem_alloc(channels, sizeof *row, "features", e);

	for (size_t i = 0; i < n && row; i++) {
		features_floats(f, i, 1, row);
		for (size_t c = 0; c < channels; c++)
			p->packed[c * n + i] = row[c];
	}
	return row ? render_pack(p->packed, n, (int)channels, e) : -1;
}

/* Channels first to first + now - 1 of all pixels. */
static void add_channels(struct pixels *p, size_t first, size_t now)
{
	const struct query_vectors *v = &p->q->vectors;

#pragma omp parallel for schedule(static)
	for (size_t r = 0; r <= v->n; r++)
		for (size_t k = 0; k < now; k++) {
			const float *image = p->images + k * p->n;
			if (r == v->n) {
				for (size_t i = 0; i < p->n; i++)
					p->length[i] += (double)image[i] * (double)image[i];
				continue;
			}
			const float x = v->values[r * v->channels + first + k];
			float *to = p->cosines + r * p->n;
			for (size_t i = 0; i < p->n; i++)
				to[i] += x * image[i];
		}
}

/* The cosines of a view's pixels; 0 where nothing has a feature. */
static int find_cosines(struct pixels *p, struct err *e)
{
	const struct query_vectors *v = &p->q->vectors;
	const size_t gaussians = p->q->scene.splats.n;
	struct render_view *view = scene_prepare(&p->q->scene, p->camera, e);

	if (!view)
		return -1;
	memset(p->cosines, 0, v->n * p->n * sizeof *p->cosines);
	memset(p->length, 0, p->n * sizeof *p->length);
	for (size_t first = 0; first < v->channels; first += RENDER_GROUP) {
		const size_t left = v->channels - first, now = left < RENDER_GROUP ? left : RENDER_GROUP;
		render_packed(view, p->packed + first * gaussians, (int)now, p->images, NULL);
		add_channels(p, first, now);
	}
	render_free(view);
	for (size_t i = 0; i < p->n; i++) {
		const double length = sqrt(p->length[i]);
		p->length[i] = length >= p->q->options->least ? length : 0;
	}
#pragma omp parallel for schedule(static)
	for (size_t r = 0; r < v->n; r++) {
		float *x = p->cosines + r * p->n;
		for (size_t i = 0; i < p->n; i++)
			x[i] = p->length[i] > 0 ? (float)((double)x[i] / p->length[i]) : 0;
	}
	return 0;
}

/* What one sentence has of a view. */
struct pixel_map {
	float *values;	     /* (n) cosines or relevancies */
	double *mean, *room; /* (n) */
	uint8_t *mask;	     /* (n) */
};

static void pixel_map_free(struct pixel_map *m)
{
	mem_free_all(m->values, m->mean, m->room, m->mask);
}

static int pixel_map_make(struct pixel_map *m, size_t n, struct err *e)
{
	*m = (struct pixel_map){mem_alloc(n, sizeof *m->values, "map", e),
		mem_alloc(n, sizeof *m->mean, "map", e), mem_alloc(n, sizeof *m->room, "map", e),
		mem_alloc(n, 1, "map", e)};

	return m->values && m->mean && m->room && m->mask ? 0 : -1;
}

/* The mask of a sentence whose vector is nearer than those of all other groups; the map has its cosines. */
static void by_cosine(const struct pixels *p, size_t sentence, struct pixel_map *m)
{
	const struct feature_query *q = p->q;

	for (size_t i = 0; i < p->n; i++) {
		const float own = p->cosines[sentence * p->n + i];
		int is_nearest = p->length[i] > 0;
		for (size_t r = 0; r < q->vectors.n && is_nearest; r++)
			is_nearest = q->group[r] == q->group[sentence] || p->cosines[r * p->n + i] < own;
		m->values[i] = own;
		m->mask[i] = (uint8_t)is_nearest;
	}
}

/* The map has relevancies. */
static void find_relevancies(const struct pixels *p, size_t sentence, struct pixel_map *m)
{
	const struct feature_query *q = p->q;

	for (size_t i = 0; i < p->n; i++) {
		double least = p->length[i] > 0 ? 1 : 0;
		for (size_t r = q->count; r < q->vectors.n; r++)
			least = fmin(least, query_relevancy(p->cosines[sentence * p->n + i],
						    &p->cosines[r * p->n + i], 1));
		m->values[i] = (float)least;
	}
}

/* The mask of relevancies above the threshold, as they are or half smoothed, which the map becomes. */
static void by_relevancy(const struct pixels *p, struct pixel_map *m)
{
	const struct feature_query_options *o = p->q->options;
	double least = INFINITY, most = -INFINITY;

	for (size_t i = 0; i < p->n; i++) {
		m->values[i] = (float)((m->mean[i] + (double)m->values[i]) / 2);
		if (!(p->length[i] > 0))
			continue;
		least = fmin(least, (double)m->values[i]);
		most = fmax(most, (double)m->values[i]);
	}
	const double threshold =
		o->is_relative ? query_relative_threshold(p->q->threshold, least, most) : p->q->threshold;
	for (size_t i = 0; i < p->n; i++)
		m->mask[i] = p->length[i] > 0 && (double)m->values[i] > threshold;
}

/* The record of a sentence in the view, where this level's largest number is above all before. */
static int keep(const struct pixels *p, size_t sentence, const struct pixel_map *m, struct err *e)
{
	struct mask *to = &p->q->shown[p->view * p->q->count + sentence];
	size_t best = 0, peak = 0;

	for (size_t i = 1; i < p->n; i++) {
		best = m->values[i] > m->values[best] ? i : best;
		peak = m->mean[i] > m->mean[peak] ? i : peak;
	}
	if (p->level && (double)m->values[best] <= to->score)
		return 0;
	mask_free(to);
	to->score = fmin(1, (double)m->values[best]);
	to->visible = NAN;
	if (!(to->place = mask_place_new(e)))
		return -1;
	to->place->has_peak = 1;
	to->place->peak[0] = (double)(peak % (size_t)p->camera->width);
	to->place->peak[1] = (double)(peak / (size_t)p->camera->width);
	return rle_encode(&to->rle, m->mask, p->camera->height, p->camera->width, e);
}

static int answer_sentence(const struct pixels *p, size_t sentence, struct pixel_map *m, struct err *e)
{
	const struct feature_query_options *o = p->q->options;
	const int is_relevancy = o->rule == RULE_RELEVANCY;

	if (is_relevancy)
		find_relevancies(p, sentence, m);
	else
		by_cosine(p, sentence, m);
	peak_mean(m->values, p->camera->height, p->camera->width, (int)o->smooth, m->room, m->mean);
	if (is_relevancy)
		by_relevancy(p, m);
	return keep(p, sentence, m, e);
}

static int answer_view(struct pixels *p, struct err *e)
{
	const struct feature_query *q = p->q;
	size_t images, cosines;
	int is_bad = 0;

	if (mem_size(p->n, RENDER_GROUP, &images) || mem_size(p->n, q->vectors.n, &cosines))
		return err_set(e, ERR_SYSTEM, "cosines of %zu pixels do not fit in memory", p->n);
	if (mem_room((void **)&p->images, &p->images_room, images, sizeof *p->images, "features", e) ||
		mem_room((void **)&p->cosines, &p->cosines_room, cosines, sizeof *p->cosines, "cosines", e) ||
		mem_room((void **)&p->length, &p->length_room, p->n, sizeof *p->length, "features", e) ||
		find_cosines(p, e))
		return -1;
#pragma omp parallel reduction(| : is_bad)
	{
		SCOPED_BY(pixel_map_free) struct pixel_map m = {0};
		struct err own;
		is_bad = pixel_map_make(&m, p->n, &own) != 0;
#pragma omp for schedule(dynamic)
		for (size_t i = 0; i < q->count; i++)
			is_bad |= is_bad || answer_sentence(p, i, &m, &own);
	}
	return is_bad ? err_set(e, ERR_SYSTEM, "masks: out of memory") : 0;
}

static int answer_all(struct pixels *p, const struct report *to, struct err *e)
{
	struct feature_query *q = p->q;
	size_t done = 0;

	report_start(to, "views", (double)(q->view_count * q->levels));
	for (p->level = 0; p->level < q->levels; p->level++) {
		if (pack(p, e))
			return -1;
		for (p->view = 0; p->view < q->view_count; p->view++) {
			p->camera = &q->scene.cameras.views[q->views[p->view]];
			p->n = (size_t)p->camera->width * (size_t)p->camera->height;
			if (answer_view(p, e))
				return -1;
			report_step(to, (double)++done, p->camera->name);
		}
	}
	return 0;
}

int query_by_pixels(struct feature_query *q, const struct report *to, struct err *e)
{
	struct pixels p = {.q = q};

	if (query_read_vectors(q, e) || choose_views(q, e))
		return -1;
	p.packed = mem_alloc(q->scene.splats.n, q->vectors.channels * sizeof *p.packed, "features", e);
	const int bad = !p.packed || answer_all(&p, to, e);
	report_end(to);
	mem_free_all(p.packed, p.images, p.cosines, p.length);
	return bad ? -1 : 0;
}

int query_put_masks(FILE *out, const struct feature_query *q, struct err *e)
{
	for (size_t v = 0; v < q->view_count; v++)
		for (size_t i = 0; i < q->count; i++) {
			struct mask m = q->shown[v * q->count + i];
			m.view = q->scene.cameras.views[q->views[v]].name;
			m.ref = q->text.refs[q->which[i]];
			m.object = text_object(&q->text, q->which[i]);
			m.score = rle_area(&m.rle) ? m.score : 0;
			if (masks_put(out, &m, e))
				return -1;
		}
	return 0;
}
