/* Lifted features told by their first principal components: feature-lift --components.
 * formats/scene/features.md.
 */
#ifndef CMD_FEATURE_FEATURE_COMPONENTS_H
#define CMD_FEATURE_FEATURE_COMPONENTS_H

#include "base/err.h"
#include "formats/scene/features.h"
#include "lift/components.h"

struct feature_components {
	struct components of;
	void *values; /* (N,K) as the features that they stand for: half floats or floats; owned */
	double error; /* root of the sum of squared differences over that of squares, over the seen Gaussians
		       */
};

/* The components of seen Gaussians' features, of a sample of them where there are many. Returns 0, or -1 with
 * *e set and nothing to free. */
int feature_components_make(
	struct feature_components *c, const struct features *f, size_t count, struct err *e);
void feature_components_free(struct feature_components *c);

#endif
