/* What goes into the network and what comes out of it: nn/nanodet.h. */
#include "nn/nanodet.h"

#include "base/logistic.h"
#include "base/mem.h"

#include <math.h>

/* What each place of a line of the network's picture is of a line of `from` places: a tent as wide as two of
 * its own places, or two of the picture's where these are wider. weights (416,room). */
struct tents {
	size_t room;
	int first[NANODET_SIDE], n[NANODET_SIDE];
	float *weights;
};

static int make_tents(struct tents *t, int from, struct err *e)
{
	const double step = (double)from / NANODET_SIDE, reach = fmax(step, 1);

	t->room = (size_t)(2 * reach) + 3;
	t->weights = mem_alloc(t->room * NANODET_SIDE, sizeof *t->weights, "picture", e);
	for (int i = 0; i < NANODET_SIDE && t->weights; i++) {
		const double middle = (i + 0.5) * step;
		const int begin = (int)fmax(0, floor(middle - reach)),
			  end = (int)fmin(from, ceil(middle + reach));
		float *weight = t->weights + (size_t)i * t->room;
		double sum = 0;
		for (int k = begin; k < end; k++)
			sum += fmax(0, 1 - fabs(k + 0.5 - middle) / reach);
		for (int k = begin; k < end; k++)
			weight[k - begin] = (float)(fmax(0, 1 - fabs(k + 0.5 - middle) / reach) / sum);
		t->first[i] = begin;
		t->n[i] = end - begin;
	}
	return t->weights ? 0 : -1;
}

/* A row of the window at the network's width: to (416,3). */
static void fit_row(float *to, const uint8_t *row, const struct tents *t)
{
	for (size_t x = 0; x < NANODET_SIDE; x++, to += 3) {
		const uint8_t *from = row + 3 * (size_t)t->first[x];
		to[0] = to[1] = to[2] = 0;
		for (int k = 0; k < t->n[x]; k++)
			for (int c = 0; c < 3; c++)
				to[c] += t->weights[x * t->room + (size_t)k] * from[3 * k + c];
	}
}

/* A row of the network's picture, of rows at its width: to (416,3), blue first. */
static void fit_column(float *to, const float *rows, const struct tents *t, size_t y)
{
	static const float mean[3] = {123.675f, 116.28f, 103.53f}, deviation[3] = {58.395f, 57.12f, 57.375f};
	const float *from = rows + (size_t)t->first[y] * 3 * NANODET_SIDE;

	for (size_t x = 0; x < NANODET_SIDE; x++)
		for (size_t c = 0; c < 3; c++) {
			float sum = 0;
			for (size_t k = 0; k < (size_t)t->n[y]; k++)
				sum += t->weights[y * t->room + k] * from[(k * NANODET_SIDE + x) * 3 + c];
			to[3 * x + 2 - c] = (sum - mean[c]) / deviation[c];
		}
}

int nanodet_picture(
	float *in, const uint8_t *rgb, int width, const struct nanodet_window *window, struct err *e)
{
	const size_t row = 3 * (size_t)width, fitted = 3 * NANODET_SIDE;
	struct tents across = {0}, down = {0};
	const uint8_t *from = rgb + (size_t)window->top * row + 3 * (size_t)window->left;
	SCOPED float *rows = mem_alloc((size_t)window->height, fitted * sizeof *rows, "picture", e);
	const int bad =
		!rows || make_tents(&across, window->width, e) || make_tents(&down, window->height, e);

#pragma omp parallel for schedule(static)
	for (int y = 0; y < (bad ? 0 : window->height); y++)
		fit_row(rows + (size_t)y * fitted, from + (size_t)y * row, &across);
#pragma omp parallel for schedule(static)
	for (size_t y = 0; y < (bad ? 0 : NANODET_SIDE); y++)
		fit_column(in + y * fitted, rows, &down, y);
	mem_free_all(across.weights, down.weights);
	return bad ? -1 : 0;
}

/* The mean of the softmax over the bins. */
static double distance(const float *bins)
{
	double most = bins[0], sum = 0, mean = 0;

	for (int b = 1; b < NANODET_BINS; b++)
		most = fmax(most, bins[b]);
	for (int b = 0; b < NANODET_BINS; b++) {
		const double share = exp(bins[b] - most);
		sum += share;
		mean += b * share;
	}
	return mean / sum;
}

/* The box of cell (y,x) of `side` x `side`. */
static void read_sides(
	float box[4], const float *bins, int y, int x, int side, const struct nanodet_window *w)
{
	const double size[2] = {(double)w->width / side, (double)w->height / side};
	const double middle[2] = {x + 0.5, y + 0.5};
	const int from[2] = {w->left, w->top};

	for (int k = 0; k < 4; k++) {
		const double away = distance(bins + (ptrdiff_t)k * NANODET_BINS);
		const double at = middle[k % 2] + (k < 2 ? -away : away);
		box[k] = (float)(from[k % 2] + size[k % 2] * fmin(fmax(at, 0), side));
	}
}

static int add_cell(struct nanodet_boxes *to, const float *out, int y, int x, int side,
	const struct nanodet_window *w, float score, struct err *e)
{
	struct nanodet_box box = {.label = -1};

	for (int k = 0; k < NANODET_CLASSES; k++) {
		const float sure = (float)logistic(out[k]);
		if (!(sure >= score))
			continue;
		if (box.label < 0)
			read_sides(box.side, out + NANODET_CLASSES, y, x, side, w);
		box.score = sure;
		box.label = k;
		if (mem_grow((void **)&to->items, &to->capacity, to->n + 1, sizeof box, "boxes", e))
			return -1;
		to->items[to->n++] = box;
	}
	return 0;
}

int nanodet_add(struct nanodet_boxes *to, const float *out, const struct nanodet_window *window, float score,
	struct err *e)
{
	for (int side = NANODET_SIDE / 8; side >= NANODET_SIDE / 32; side /= 2)
		for (int y = 0; y < side; y++)
			for (int x = 0; x < side; x++, out += NANODET_OUT)
				if (add_cell(to, out, y, x, side, window, score, e))
					return -1;
	return 0;
}

/* The surest first; of one score by class and place, so that there is one order. */
static int compare(const void *a, const void *b)
{
	const struct nanodet_box *x = a, *y = b;

	if (x->score != y->score)
		return x->score > y->score ? -1 : 1;
	if (x->label != y->label)
		return x->label < y->label ? -1 : 1;
	for (int k = 0; k < 4; k++)
		if (x->side[k] != y->side[k])
			return x->side[k] < y->side[k] ? -1 : 1;
	return 0;
}

static double area(const float side[4])
{
	return fmax(0, (double)side[2] - side[0]) * fmax(0, (double)side[3] - side[1]);
}

static double overlap(const struct nanodet_box *a, const struct nanodet_box *b)
{
	const float both[4] = {fmaxf(a->side[0], b->side[0]), fmaxf(a->side[1], b->side[1]),
		fminf(a->side[2], b->side[2]), fminf(a->side[3], b->side[3])};
	const double shared = area(both), all = area(a->side) + area(b->side) - shared;

	return all > 0 ? shared / all : 1;
}

void nanodet_thin(struct nanodet_boxes *boxes, double most)
{
	size_t kept = 0;

	if (boxes->n)
		qsort(boxes->items, boxes->n, sizeof *boxes->items, compare);
	for (size_t i = 0; i < boxes->n; i++) {
		int is_new = 1;
		for (size_t k = 0; k < kept && is_new; k++)
			is_new = boxes->items[k].label != boxes->items[i].label ||
				 overlap(&boxes->items[k], &boxes->items[i]) <= most;
		if (is_new)
			boxes->items[kept++] = boxes->items[i];
	}
	boxes->n = kept;
}

const char *const nanodet_classes[NANODET_CLASSES] = {"person", "bicycle", "car", "motorcycle", "airplane",
	"bus", "train", "truck", "boat", "traffic light", "fire hydrant", "stop sign", "parking meter",
	"bench", "bird", "cat", "dog", "horse", "sheep", "cow", "elephant", "bear", "zebra", "giraffe",
	"backpack", "umbrella", "handbag", "tie", "suitcase", "frisbee", "skis", "snowboard", "sports ball",
	"kite", "baseball bat", "baseball glove", "skateboard", "surfboard", "tennis racket", "bottle",
	"wine glass", "cup", "fork", "knife", "spoon", "bowl", "banana", "apple", "sandwich", "orange",
	"broccoli", "carrot", "hot dog", "pizza", "donut", "cake", "chair", "couch", "potted plant", "bed",
	"dining table", "toilet", "tv", "laptop", "mouse", "remote", "keyboard", "cell phone", "microwave",
	"oven", "toaster", "sink", "refrigerator", "book", "clock", "vase", "scissors", "teddy bear",
	"hair drier", "toothbrush"};
