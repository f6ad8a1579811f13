#include "cmd/ask/reply.h"

#include "base/mem.h"
#include "splat/render.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

struct region {
	const struct camera *camera;
	int is_box;
	int left, top, right, bottom; /* right and bottom are outside */
};

/* What a view shows of objects, RENDER_GROUP at a time. */
struct shown {
	const struct asking *asking;
	struct render_view *view;
	float *shares;		    /* (RENDER_GROUP,N) */
	float *images, *background; /* (RENDER_GROUP,P), (P) */
	double *inside, *all;	    /* (objects) pixels of the mask, in the region and everywhere */
};

/* "1,2,3" of so many numbers. */
static int take_numbers(const char *text, double *x, int count)
{
	char *end;

	for (int i = 0; i < count; i++, text = end + 1) {
		x[i] = strtod(text, &end);
		if (end == text || !isfinite(x[i]) || fabs(x[i]) > 1e6 || *end != (i + 1 < count ? ',' : 0))
			return -1;
	}
	return 0;
}

static int find_view(struct region *r, const struct asking *a, const char *text, size_t length, struct err *e)
{
	SCOPED char *name = mem_alloc(length + 1, 1, "view", e);

	if (!name)
		return -1;
	memcpy(name, text, length);
	name[length] = 0;
	r->camera = asking_view(a, name);
	return r->camera ? 0
			 : err_set(e, ERR_USAGE, "%s: no view '%s'", r->is_box ? "--box" : "--point", name);
}

static int take_region(struct region *r, const struct asking *a, const char *text, struct err *e)
{
	const char *option = r->is_box ? "--box" : "--point", *colon = strrchr(text, ':');
	double x[4];

	if (!colon || take_numbers(colon + 1, x, r->is_box ? 4 : 2))
		return err_set(e, ERR_USAGE, "%s: '%s' is not %s", option, text,
			r->is_box ? "VIEW:x0,y0,x1,y1" : "VIEW:x,y");
	if (find_view(r, a, text, (size_t)(colon - text), e))
		return -1;
	r->left = (int)floor(fmax(r->is_box ? fmin(x[0], x[2]) : x[0], -1));
	r->top = (int)floor(fmax(r->is_box ? fmin(x[1], x[3]) : x[1], -1));
	r->right = r->is_box ? (int)ceil(fmax(x[0], x[2])) : r->left + 1;
	r->bottom = r->is_box ? (int)ceil(fmax(x[1], x[3])) : r->top + 1;
	if (r->is_box) {
		r->left = r->left < 0 ? 0 : r->left;
		r->top = r->top < 0 ? 0 : r->top;
		r->right = r->right > r->camera->width ? r->camera->width : r->right;
		r->bottom = r->bottom > r->camera->height ? r->camera->height : r->bottom;
	}
	if (r->left < 0 || r->top < 0 || r->right > r->camera->width || r->bottom > r->camera->height ||
		r->left >= r->right || r->top >= r->bottom)
		return err_set(e, ERR_USAGE, "%s: '%s' is outside of the view, which is %dx%d", option, text,
			r->camera->width, r->camera->height);
	return 0;
}

static void put_shares(const struct lifted *l, size_t object, float *shares)
{
	memset(shares, 0, l->gaussians * sizeof *shares);
	for (int64_t i = l->indptr[object]; i < l->indptr[object + 1]; i++)
		shares[l->index[i]] = l->share[i];
}

/* Counts the mask of one object: where more than its cut of what is seen is the object's. */
static void count(struct shown *s, const struct region *r, size_t object, const float *image)
{
	const float cut = lifted_cut_of(&s->asking->model.lifted, object);
	const int w = r->camera->width, h = r->camera->height;

	for (int y = 0; y < h; y++)
		for (int x = 0; x < w; x++) {
			const size_t at = (size_t)y * (size_t)w + (size_t)x;
			const int on = image[at] > cut * (1 - s->background[at]);
			s->all[object] += on;
			s->inside[object] +=
				on && x >= r->left && x < r->right && y >= r->top && y < r->bottom;
		}
}

static int look(struct shown *s, const struct region *r, double *probability, struct err *e)
{
	const struct lifted *l = &s->asking->model.lifted;
	const size_t pixels = (size_t)r->camera->width * (size_t)r->camera->height;
	const size_t point = (size_t)r->top * (size_t)r->camera->width + (size_t)r->left;

	for (size_t first = 0; first < l->objects; first += RENDER_GROUP) {
		const size_t left = l->objects - first, now = left < RENDER_GROUP ? left : RENDER_GROUP;
		for (size_t k = 0; k < now; k++)
			put_shares(l, first + k, s->shares + k * l->gaussians);
		if (render_values(s->view, s->shares, (int)now, s->images, s->background, e))
			return -1;
		for (size_t k = 0; k < now; k++) {
			const float *image = s->images + k * pixels;
			count(s, r, first + k, image);
			probability[first + k] = image[point];
		}
	}
	return 0;
}

/* Of a box: how much of it is the object, times how much of the object is in it. */
static void weigh_box(const struct shown *s, size_t objects, double *probability)
{
	double sum = 0;

	for (size_t o = 0; o < objects; o++)
		sum += probability[o] = s->all[o] > 0 ? s->inside[o] * s->inside[o] / s->all[o] : 0;
	for (size_t o = 0; o < objects && sum > 0; o++)
		probability[o] /= sum;
}

/* The likeliest object whose mask is there, and the next. */
static void choose_thing(const struct shown *s, size_t objects, struct asking_answer *answer)
{
	const double *p = answer->probability;
	size_t best = ASKING_NONE;

	for (size_t o = 0; o < objects; o++)
		if (s->inside[o] > 0 && (best == ASKING_NONE || p[o] > p[best]))
			best = o;
	for (size_t o = 0; o < objects; o++)
		if (o != best && (answer->runner_up == ASKING_NONE || p[o] > p[answer->runner_up]))
			answer->runner_up = o;
	answer->count = best != ASKING_NONE;
	answer->things[0] = best;
	answer->there = best == ASKING_NONE ? 0 : p[best];
}

static int shown_make(struct shown *s, const struct asking *a, const struct camera *c, struct err *e)
{
	const size_t n = a->model.lifted.gaussians, objects = a->model.lifted.objects;
	const size_t most = objects < RENDER_GROUP ? objects : RENDER_GROUP;
	const size_t pixels = (size_t)c->width * (size_t)c->height;

	*s = (struct shown){.asking = a, .view = scene_prepare(&a->scene, c, e)};
	if (!s->view)
		return -1;
	s->shares = mem_alloc(n, most * sizeof *s->shares, "shares", e);
	s->images = mem_alloc(pixels, most * sizeof *s->images, "images", e);
	s->background = mem_alloc(pixels, sizeof *s->background, "image", e);
	s->inside = mem_zalloc(objects, sizeof *s->inside, "objects", e);
	s->all = mem_zalloc(objects, sizeof *s->all, "objects", e);
	return s->shares && s->images && s->background && s->inside && s->all ? 0 : -1;
}

static void shown_free(struct shown *s)
{
	render_free(s->view);
	free(s->shares);
	free(s->images);
	free(s->background);
	free(s->inside);
	free(s->all);
}

int picking_find(const struct asking *a, const char *text, int is_box, struct asking_answer *answer,
	const struct camera **view, struct err *e)
{
	const size_t objects = a->model.lifted.objects;
	struct region r = {.is_box = is_box};
	SCOPED_BY(shown_free) struct shown s = {0};

	*answer = (struct asking_answer){.runner_up = ASKING_NONE};
	if (take_region(&r, a, text, e) || shown_make(&s, a, r.camera, e) ||
		asking_answer_make(answer, objects, e) || look(&s, &r, answer->probability, e))
		return -1;
	if (is_box)
		weigh_box(&s, objects, answer->probability);
	if (objects)
		choose_thing(&s, objects, answer);
	snprintf(answer->reason, sizeof answer->reason, "no thing that was lifted is seen there");
	*view = r.camera;
	return 0;
}
