#include "places/object_span.h"

#include <math.h>

static const double trimmed = 0.1, longer = 0.1;
/* Of tips: how many times as far four times as much weight reaches as twice as much; a cone has 1.41, a
 * cylinder 2. tip_most: of the middle's length, from which on something else is on it. */
static const double sharpest = 1.35, blunt = 1.8, tip_most = 0.6;

/* What tapers has little of its weight near its tip: how far that is above `high`, where the trimmed part
 * begins, by where twice and four times as much lie. Of a density that rises as a power of the distance from
 * the tip this is exact; 0 where the weight ends bluntly. */
static double tip(struct quantile_item *along, size_t n, double high, double length)
{
	const double next = quantile_weighted(along, n, 1 - 2 * trimmed),
		     third = quantile_weighted(along, n, 1 - 4 * trimmed);
	const double ratio = high > next ? (next - third) / (high - next) : INFINITY;
	const double more = ratio < blunt ? (high - next) / (fmax(ratio, sharpest) - 1) : 0;

	return more < tip_most * length ? more : 0;
}

struct object_span object_span(struct quantile_item *along, size_t n, int is_upright)
{
	const double low = quantile_weighted(along, n, trimmed),
		     high = quantile_weighted(along, n, 1 - trimmed);
	const double more = longer * (high - low);

	return (struct object_span){low - more,
		high + (is_upright ? fmax(more, tip(along, n, high, high - low)) : more), (low + high) / 2};
}
