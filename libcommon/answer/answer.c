#include "answer/answer.h"

#include "answer/respond.h"
#include "base/mem.h"
#include "base/threads.h"
#include "splat/render.h"

#include <math.h>

/* Views are rendered side by side where they take no more memory than this. */
#define SIDE_BY_SIDE_BYTES 2e9

/* Memory that one view after the other uses. */
struct room {
	struct render_view *view, *alone; /* of the scene, and of an object */
	float *images, *rgb, *ones;
	uint8_t *mask;
	size_t image_room, rgb_room, ones_room, mask_room;
};

static void room_free(struct room *room)
{
	render_free(room->view);
	render_free(room->alone);
	mem_free_all(room->images, room->rgb, room->ones, room->mask);
}

/* Channels that are blended in one pass. */
static size_t group_size(const struct answer_question *q, size_t first)
{
	const size_t left = q->responses->answers - first;

	return left < RENDER_GROUP ? left : RENDER_GROUP;
}

/* About what a room needs. */
static double room_bytes(const struct answer_question *q, double pixels)
{
	const double images =
		(double)group_size(q, 0) * sizeof(float) + (q->wants_rgb ? 7 * sizeof(float) : 0);

	return pixels * images + (double)render_bytes(q->splats->n) * (q->wholes ? 2 : 1);
}

static int prepare(struct render_view **view, const struct splats *s, const struct camera *c,
	const uint8_t *is_wanted, struct err *e)
{
	if (*view)
		return render_again_where(*view, s, c, is_wanted, e);
	*view = render_prepare_where(s, c, is_wanted, e);
	return *view ? 0 : -1;
}

/* The outline of a whole object in place of what a->image and a->mask have of it. */
static int take_outline(struct room *room, const struct splats *whole, struct answer *a, float *image,
	uint8_t *mask, struct err *e)
{
	const size_t pixels = (size_t)a->camera->width * (size_t)a->camera->height;
	size_t covered = 0, seen = 0;

	if (prepare(&room->alone, whole, a->camera, NULL, e) ||
		mem_room((void **)&room->ones, &room->ones_room, whole->n, sizeof(float), "values", e))
		return -1;
	for (size_t i = 0; i < whole->n; i++)
		room->ones[i] = 1;
	render_packed(room->alone, room->ones, 1, image, NULL);
	for (size_t p = 0; p < pixels; p++) {
		image[p] -= ANSWER_OUTLINE;
		covered += image[p] > 0;
		seen += image[p] > 0 && mask[p];
		mask[p] = image[p] > 0;
	}
	a->visible = covered ? (double)seen / (double)covered : 0;
	return 0;
}

static int answer_view(struct room *room, const struct answer_question *q, const uint8_t *is_wanted,
	const struct camera *c, size_t view, const struct answer_calls *calls, struct err *e)
{
	const struct responses *responses = q->responses;
	const size_t pixels = (size_t)c->width * (size_t)c->height;
	size_t images;

	if (mem_size(pixels, group_size(q, 0), &images))
		return err_set(e, ERR_SYSTEM, "images: %zu of %zu pixels do not fit in memory",
			group_size(q, 0), pixels);
	if (mem_room((void **)&room->images, &room->image_room, images, sizeof(float), "images", e) ||
		mem_room((void **)&room->mask, &room->mask_room, pixels, 1, "mask", e) ||
		(q->wants_rgb && mem_room((void **)&room->rgb, &room->rgb_room, pixels, 3 * sizeof(float),
					 "colours", e)) ||
		prepare(&room->view, q->splats, c, is_wanted, e) ||
		(q->wants_rgb && render_colors(room->view, q->splats, c, (const float[3]){0}, room->rgb, e)))
		return -1;
	for (size_t first = 0; first < responses->answers; first += RENDER_GROUP) {
		const size_t now = group_size(q, first);
		render_packed(room->view, responses->responses + first * q->splats->n, (int)now, room->images,
			NULL);
		for (size_t i = 0; i < now; i++) {
			float *image = room->images + i * pixels;
			const size_t answer = first + i;
			struct answer a = {.camera = c,
				.view = view,
				.answer = answer,
				.image = image,
				.mask = room->mask,
				.rgb = q->wants_rgb ? room->rgb : NULL,
				.score = respond_mask(image, pixels, responses->lifts[answer], room->mask),
				.visible = NAN};
			if (q->wholes && take_outline(room, &q->wholes[answer], &a, image, room->mask, e))
				return -1;
			if (calls->each(calls->data, &a, e))
				return -1;
		}
	}
	return 0;
}

/* Views that wait for those before them. */
struct queue {
	const struct answer_calls *calls;
	size_t next;
	char *ready;   /* (n) */
	size_t failed; /* the first view where anything went wrong; n: none */
	struct err *e;
};

/* View i went well, or not for the reason *why. */
static void queue_put(struct queue *q, size_t i, int bad, const struct err *why)
{
	if (bad && i < q->failed) {
		q->failed = i;
		*q->e = *why;
	}
	q->ready[i] = !bad;
	for (struct err e; q->next < q->failed && q->ready[q->next]; q->next++)
		if (q->calls->done && q->calls->done(q->calls->data, q->next, &e)) {
			q->failed = q->next;
			*q->e = e;
		}
}

/* Views begin to end - 1, by so many threads. */
static void answer_some(struct queue *queue, const struct answer_question *q, const uint8_t *is_wanted,
	const struct camera *cameras, size_t begin, size_t end, int threads)
{
#pragma omp parallel num_threads(threads) if (threads > 1)
	{
		SCOPED_BY(room_free) struct room room = {0};
#pragma omp for schedule(dynamic)
		for (size_t i = begin; i < end; i++) {
			struct err e;
			size_t failed;
#pragma omp critical(answer_queue)
			failed = queue->failed;
			if (failed < i)
				continue;
			int bad = answer_view(&room, q, is_wanted, &cameras[i], i, queue->calls, &e);
#pragma omp critical(answer_queue)
			queue_put(queue, i, bad, &e);
		}
	}
}

/* Gaussians with a response above 0 to some sentence: without them a pixel is in no mask. */
static uint8_t *find_wanted(const struct answer_question *q, struct err *e)
{
	const size_t n = q->splats->n;
	uint8_t *is_wanted = mem_zalloc(n, 1, "Gaussians", e);

	for (size_t first = 0; first < q->responses->answers && is_wanted; first += RENDER_GROUP) {
		const size_t now = group_size(q, first);
		const float *responses = q->responses->responses + first * n;
		for (size_t i = 0; i < n; i++)
			for (size_t k = 0; k < now; k++)
				is_wanted[i] |= responses[i * now + k] > 0;
	}
	return is_wanted;
}

int answer_all(const struct answer_question *q, const struct camera *cameras, size_t n,
	const struct answer_calls *calls, struct err *e)
{
	const int threads = threads_available();
	struct queue queue = {.calls = calls, .ready = mem_zalloc(n, 1, "views", e), .failed = n, .e = e};
	const int is_all = q->wants_rgb || q->wants_images;
	SCOPED uint8_t *is_wanted = is_all ? NULL : find_wanted(q, e);
	double most = 0;

	if (!queue.ready || (!is_all && !is_wanted)) {
		free(queue.ready);
		return -1;
	}
	for (size_t i = 0; i < n; i++)
		most = fmax(most, room_bytes(q, (double)cameras[i].width * cameras[i].height));
	/* the last ones, too few for all threads, one after the other */
	size_t together = most * threads <= SIDE_BY_SIDE_BYTES ? n - n % (size_t)threads : 0;
	answer_some(&queue, q, is_wanted, cameras, 0, together, threads);
	answer_some(&queue, q, is_wanted, cameras, together, n, 1);
	free(queue.ready);
	return queue.failed < n ? -1 : 0;
}
