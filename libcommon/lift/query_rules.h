/* Which Gaussians of a field of features (lift/lift_features.h) a query means: the rules of the systems that
 * the field compares with, each for one Gaussian and by the cosines of its feature with vectors of texts. As
 * published they are for a pixel of a rendered feature map; here they are for a Gaussian, and what they
 * select is rendered. */
#pragma once

#include <stddef.h>
#include <stdint.h>

/* x (n,channels): each row divided by its length; rows of 0 stay. */
void query_unit(float *x, size_t n, size_t channels);

/* Cosine, as Feature 3DGS (arXiv 2312.03203) and LEGaussians (arXiv 2311.18482) segment: a Gaussian is of the
 * class whose text is nearest. selected[q] (queries) is 1 where cosine q is above all cosines (count, the
 * queries first) of other groups: what means one thing is not in its own way. */
void query_cosine(const float *cosines, const size_t *group, size_t count, size_t queries, char *selected);

/* Relevancy, as LERF (arXiv 2303.09553) and LangSplat (arXiv 2312.16084) score: against each canonical phrase
 * the softmax of both cosines times QUERY_TEMPERATURE, the least of them. In (0,1). */
#define QUERY_TEMPERATURE 10.0
double query_relevancy(float cosine, const float *canonical, size_t count);

/* The threshold on relevancies between `least` and `most`, where it is on LangSplat's scale: their range is
 * brought to [-1,1], and what is then above it is selected. */
double query_relative_threshold(double threshold, double least, double most);

/* Identities, as Gaussian Grouping (arXiv 2312.00732) picks groups: a label whose Gaussians lie in the
 * query's mask with more than `threshold` of them is selected, here by blend weight. labels (n) with -1 for
 * none; the label 0 is no group. inside (n): 1 in the mask. selected (n); sums (2,label_count) is scratch. */
void query_identity(const int32_t *labels, const float *weight, const char *inside, size_t n,
	double threshold, double *sums, size_t label_count, char *selected);
