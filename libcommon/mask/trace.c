/* Each corner of the grid keeps which ways the border leaves it. A line is followed until it is back where it
 * began, and what was followed is taken off the grid. */
#include "mask/trace.h"

#include "base/mem.h"

enum { EAST, SOUTH, WEST, NORTH, WAYS };

struct grid {
	const uint8_t *mask;
	int height, width;
	uint8_t *ways; /* (height+1,width+1) bit 1 << way where the border leaves that way */
};

static uint8_t *ways_of(const struct grid *g, int x, int y)
{
	return &g->ways[(size_t)y * ((size_t)g->width + 1) + (size_t)x];
}

static int is_on(const struct grid *g, int x, int y)
{
	return x >= 0 && y >= 0 && x < g->width && y < g->height &&
	       g->mask[(size_t)y * (size_t)g->width + (size_t)x];
}

static void mark_pixel(const struct grid *g, int x, int y)
{
	if (!is_on(g, x, y - 1))
		*ways_of(g, x, y) |= 1 << EAST;
	if (!is_on(g, x + 1, y))
		*ways_of(g, x + 1, y) |= 1 << SOUTH;
	if (!is_on(g, x, y + 1))
		*ways_of(g, x + 1, y + 1) |= 1 << WEST;
	if (!is_on(g, x - 1, y))
		*ways_of(g, x, y + 1) |= 1 << NORTH;
}

/* Takes the way that turns most to the right: pixels that touch at a corner stay apart. */
static int leave(const struct grid *g, int x, int y, int way)
{
	uint8_t *ways = ways_of(g, x, y);

	for (int turn = 1; turn >= -1; turn--) {
		const int next = (way + turn + WAYS) % WAYS;
		if (!(*ways >> next & 1))
			continue;
		*ways &= (uint8_t) ~(1 << next);
		return next;
	}
	return -1;
}

static int add_corner(struct trace *t, int x, int y, int is_first, struct err *e)
{
	if (mem_grow((void **)&t->corners, &t->capacity, t->n + 1, sizeof *t->corners, "outline", e))
		return -1;
	t->corners[t->n++] = (struct trace_corner){x, y, is_first};
	return 0;
}

/* The line whose upper left corner this is: it leaves to the east. */
static int follow(struct trace *t, const struct grid *g, int x, int y, struct err *e)
{
	static const int dx[WAYS] = {1, 0, -1, 0}, dy[WAYS] = {0, 1, 0, -1};
	int way = EAST, next;

	if (add_corner(t, x, y, 1, e))
		return -1;
	*ways_of(g, x, y) &= (uint8_t) ~(1 << EAST);
	do {
		x += dx[way];
		y += dy[way];
		next = leave(g, x, y, way);
		if (next >= 0 && next != way && add_corner(t, x, y, 0, e))
			return -1;
		way = next;
	} while (way >= 0);
	return 0;
}

int trace_mask(struct trace *t, const uint8_t *mask, int height, int width, struct err *e)
{
	struct grid g = {mask, height, width, NULL};

	*t = (struct trace){0};
	g.ways = mem_zalloc((size_t)height + 1, (size_t)width + 1, "outline", e);
	int bad = !g.ways;
	for (int y = 0; y < height && !bad; y++)
		for (int x = 0; x < width; x++)
			if (is_on(&g, x, y))
				mark_pixel(&g, x, y);
	for (int y = 0; y <= height && !bad; y++)
		for (int x = 0; x <= width && !bad; x++)
			while (!bad && *ways_of(&g, x, y) & 1 << EAST)
				bad = follow(t, &g, x, y, e);
	free(g.ways);
	return bad ? -1 : 0;
}

void trace_free(struct trace *t)
{
	free(t->corners);
	*t = (struct trace){0};
}
