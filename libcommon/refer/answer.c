#include "refer/answer.h"

#include "base/mem.h"
#include "base/threads.h"
#include "refer/respond.h"
#include "splat/render.h"

#include <math.h>
#include <stdlib.h>

/* Views are rendered side by side where they take no more memory than this. */
#define SIDE_BY_SIDE_BYTES 2e9

/* Memory that one view after the other uses. */
struct room {
	struct render_view *view;
	float *images, *rgb;
	uint8_t *mask;
	size_t image_room, rgb_room, mask_room;
};

static void room_free(struct room *room)
{
	render_free(room->view);
	free(room->images);
	free(room->rgb);
	free(room->mask);
}

/* Sentences that are blended in one pass. */
static size_t group_size(const struct answer_question *q, size_t first)
{
	return q->sentences - first < RENDER_GROUP ? q->sentences - first : RENDER_GROUP;
}

/* About what a room needs. */
static double room_bytes(const struct answer_question *q, double pixels)
{
	const double images =
		(double)group_size(q, 0) * sizeof(float) + (q->wants_rgb ? 7 * sizeof(float) : 0);

	return pixels * images + (double)render_bytes(q->splats->n);
}

static int prepare(struct room *room, const struct answer_question *q, const struct camera *c, struct err *e)
{
	if (room->view)
		return render_again(room->view, q->splats, c, e);
	room->view = render_prepare(q->splats, c, e);
	return room->view ? 0 : -1;
}

static int answer_view(struct room *room, const struct answer_question *q, const struct camera *c,
	const struct answer_calls *calls, FILE *records, struct err *e)
{
	const size_t pixels = (size_t)c->width * (size_t)c->height;
	size_t images;

	if (mem_size(pixels, group_size(q, 0), &images))
		return err_set(e, ERR_SYSTEM, "images: %zu of %zu pixels do not fit in memory",
			group_size(q, 0), pixels);
	if (mem_room((void **)&room->images, &room->image_room, images, sizeof(float), "images", e) ||
		mem_room((void **)&room->mask, &room->mask_room, pixels, 1, "mask", e) ||
		(q->wants_rgb && mem_room((void **)&room->rgb, &room->rgb_room, pixels, 3 * sizeof(float),
					 "colours", e)) ||
		prepare(room, q, c, e) ||
		(q->wants_rgb && render_colors(room->view, q->splats, c, (const float[3]){0}, room->rgb, e)))
		return -1;
	for (size_t first = 0; first < q->sentences; first += RENDER_GROUP) {
		const size_t now = group_size(q, first);
		render_packed(room->view, q->responses + first * q->splats->n, (int)now, room->images, NULL);
		for (size_t i = 0; i < now; i++) {
			const float *image = room->images + i * pixels;
			const struct answer a = {.camera = c,
				.sentence = first + i,
				.image = image,
				.mask = room->mask,
				.rgb = q->wants_rgb ? room->rgb : NULL,
				.score = respond_mask(image, pixels, q->lifts[first + i], room->mask)};
			if (calls->each(calls->data, &a, records, e))
				return -1;
		}
	}
	return 0;
}

/* The records of a view, which the caller frees; NULL with *e set. */
static char *view_records(struct room *room, const struct answer_question *q, const struct camera *c,
	const struct answer_calls *calls, struct err *e)
{
	char *text = NULL;
	size_t length;
	FILE *records = open_memstream(&text, &length);

	if (!records) {
		err_errno(e, "records");
		return NULL;
	}
	int bad = answer_view(room, q, c, calls, records, e);
	if (fclose(records) && !bad)
		bad = err_errno(e, "records");
	if (!bad)
		return text;
	free(text);
	return NULL;
}

/* Views that wait for those before them. */
struct queue {
	char **texts; /* (n) */
	size_t written;
	size_t failed; /* the first view where anything went wrong; n: none */
};

static void queue_put(struct queue *q, size_t n, size_t i, char *text, const struct answer_calls *calls)
{
	q->texts[i] = text;
	for (; q->written < n && q->texts[q->written]; q->written++) {
		calls->done(calls->data, q->written, q->texts[q->written]);
		free(q->texts[q->written]);
		q->texts[q->written] = NULL;
	}
}

/* Views begin to end - 1, by so many threads. */
static void answer_some(const struct answer_question *q, const struct camera *cameras, size_t n, size_t begin,
	size_t end, int threads, const struct answer_calls *calls, struct queue *queue, struct err *e)
{
#pragma omp parallel num_threads(threads) if (threads > 1)
	{
		struct room room = {0};
#pragma omp for schedule(dynamic)
		for (size_t i = begin; i < end; i++) {
			struct err mine;
			size_t failed;
#pragma omp atomic read
			failed = queue->failed;
			if (failed < i)
				continue;
			char *text = view_records(&room, q, &cameras[i], calls, &mine);
#pragma omp critical(answer_queue)
			if (text) {
				queue_put(queue, n, i, text, calls);
			} else if (i < queue->failed) {
				*e = mine;
#pragma omp atomic write
				queue->failed = i;
			}
		}
		room_free(&room);
	}
}

int answer_all(const struct answer_question *q, const struct camera *cameras, size_t n,
	const struct answer_calls *calls, struct err *e)
{
	struct queue queue = {mem_zalloc(n, sizeof *queue.texts, "records", e), 0, n};
	const int threads = threads_available();
	double most = 0;

	if (!queue.texts)
		return -1;
	for (size_t i = 0; i < n; i++)
		most = fmax(most, room_bytes(q, (double)cameras[i].width * cameras[i].height));
	/* the last ones, too few for all threads, one after the other */
	size_t together = most * threads <= SIDE_BY_SIDE_BYTES ? n - n % (size_t)threads : 0;
	answer_some(q, cameras, n, 0, together, threads, calls, &queue, e);
	answer_some(q, cameras, n, together, n, 1, calls, &queue, e);
	for (size_t i = 0; i < n; i++)
		free(queue.texts[i]);
	free(queue.texts);
	return queue.failed < n ? -1 : 0;
}
