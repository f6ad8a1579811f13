#include "lift/labels.h"

#include "base/mem.h"

#include <math.h>

#define GOLDEN_SECTION 0.6180339887498949
static const double saturation = 0.75, value = 0.95;

/* Both lists rise; the extent's Gaussians are some of the object's. */
static void label_one(
	int32_t *labels, float *largest, const struct lifted *l, size_t object, const struct extent *x)
{
	int64_t k = l->indptr[object];

	for (size_t i = 0; i < x->n; i++) {
		const int32_t id = x->ids[i];
		while (l->index[k] < id)
			k++;
		if (l->share[k] <= largest[id])
			continue;
		largest[id] = l->share[k];
		labels[id] = (int32_t)object + 1;
	}
}

int labels_find(int32_t *labels, const struct lifted *l, const struct extent *extents, struct err *e)
{
	SCOPED float *largest = mem_zalloc(l->gaussians, sizeof *largest, "labels", e);

	if (!largest)
		return -1;
	for (size_t i = 0; i < l->gaussians; i++)
		labels[i] = 0;
	for (size_t o = 0; o < l->objects; o++)
		label_one(labels, largest, l, o, &extents[o]);
	return 0;
}

void labels_colour(int32_t label, uint8_t rgb[3])
{
	const double hue = fmod(label * GOLDEN_SECTION, 1);

	for (int c = 0; c < 3; c++) {
		const double k = fmod(5 - 2 * c + 6 * hue, 6);
		const double less = fmax(0, fmin(1, fmin(k, 4 - k)));
		rgb[c] = (uint8_t)lrint(255 * value * (1 - saturation * less));
	}
}
