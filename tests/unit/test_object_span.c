/* Where objects of known shapes begin and end (places/object_span.h). */
#include "places/object_span.h"
#include "unit.h"

#include <math.h>

enum { N = 4000 };

/* Heights of points that lie evenly on the sides of a cone or cylinder 3 high from 2 on. */
static void fill(struct quantile_item *along, int is_cone, int many)
{
	for (int i = 0; i < many; i++) {
		const double share = (i + 0.5) / many;
		along[i] = (struct quantile_item){2 + 3 * (is_cone ? 1 - sqrt(1 - share) : share), 1};
	}
}

static struct object_span span_of(int is_cone, int is_upright)
{
	static struct quantile_item along[N];

	fill(along, is_cone, N);
	return object_span(along, N, is_upright);
}

int main(void)
{
	static struct quantile_item along[N + N / 4];
	const struct object_span cylinder = span_of(0, 1), cone = span_of(1, 1), lying = span_of(1, 0);

	CHECK(fabs(cylinder.high - 5) < 0.1 && fabs(cylinder.low - 2) < 0.1, "a cylinder: %g to %g",
		cylinder.low, cylinder.high);
	CHECK(fabs(cone.high - 5) < 0.05, "the tip of a cone: %g", cone.high);
	CHECK(lying.high < 4.5 && lying.low == cone.low && lying.middle == cone.middle, "only upwards: %g",
		lying.high);
	CHECK(fabs(cylinder.middle - 3.5) < 0.01, "its middle: %g", cylinder.middle);

	/* a little of something else above is not its tip */
	fill(along, 0, N);
	for (int i = 0; i < N / 4; i++)
		along[N + i] = (struct quantile_item){5 + 8.0 * i / N, 1};
	const struct object_span with = object_span(along, N + N / 4, 1);
	CHECK(with.high < 7.2, "with something on it: %g", with.high);
	return unit_end();
}
