/* What the parts of lift/regions share. */
#pragma once

#include "lift/regions.h"

#define REGIONS_JOINS 0.4 /* agreement from which a candidate joins a region */
#define REGIONS_PEER 0.65 /* of the region's typical agreement, from which a candidate shows it */
/* No agreement below this is ever looked at, as typical ones are above REGIONS_JOINS. */
#define REGIONS_MATTERS (REGIONS_JOINS * REGIONS_PEER)

/* Moves the candidates that are lifted together, in the order of their views. */
void regions_settle(struct regions *r);

/* The candidates' shares by Gaussian. */
struct regions_shown {
	size_t *begin;	    /* (N+1) */
	int32_t *candidate; /* (entries) rising for each Gaussian */
	float *share;	    /* (entries) l_ki */
	double *slabs;	    /* (REGIONS_SLABS,count) sums on their way */
};
enum { REGIONS_SLABS = 8 };

int regions_shown_make(struct regions_shown *s, const struct regions *r, struct err *e);
void regions_shown_free(struct regions_shown *s);

/* both (count): what each candidate has of the n members. */
void regions_overlap(struct regions_shown *s, size_t count, const int32_t *members, size_t n, double *both);

/* Of the Gaussians that candidates show: the weight in them, and all weight in their views. */
struct regions_sums {
	size_t n;
	int32_t *index;	  /* (n of N) rising */
	float *sum, *all; /* (n of N) */
	/* of all Gaussians, 0 between uses */
	float *shown; /* (N) */
	uint64_t *marks;
};

int regions_sums_make(struct regions_sums *s, size_t gaussians, struct err *e);
void regions_sums_free(struct regions_sums *s);

/* chosen (views) has a candidate or REGIONS_NONE. */
void regions_sum(struct regions_sums *s, const struct regions *r, const size_t *chosen);

/* share (sentences,regions): q_s(R). Fills spare, once the objects have theirs. */
int regions_find_spare(struct regions *r, const double *share, struct err *e);

/* The candidate that is a region's mask in a view, or REGIONS_NONE. */
size_t regions_find_candidate(const struct regions *r, const struct region *region, size_t view);
