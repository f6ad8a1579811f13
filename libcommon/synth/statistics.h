/* What is in a synthetic benchmark, in figures. */
#pragma once

#include "base/err.h"
#include "synth/synth_scene.h"
#include "synth/sentence.h"

enum { SYNTH_QUANTILES = 5, SYNTH_BANDS = 5, SYNTH_SPLITS = 2 };

/* Of (view, object) pairs, by visibility: visible pixels over those of the whole object. The bands are 0, up
 * to 0.15, up to 0.5, up to 0.85, and from there (each without its upper end). */
struct synth_visibility {
	long pairs;   /* with the object in the image; the bands sum to them */
	long outside; /* pairs with nothing of the object in the image */
	long bands[SYNTH_BANDS];
};

struct synth_statistics {
	int objects;
	int alike, alike_groups; /* objects that share shape and colour with others; groups of such */
	int stacked;		 /* objects that stand on others */
	/* Indices are enum camera_split. */
	int views[SYNTH_SPLITS], sentences[SYNTH_SPLITS];
	double words[SYNTH_SPLITS]; /* the mean length of a sentence */
	size_t gaussians;
	/* At 5, 25, 50, 75 and 95%: opacity; largest over smallest scale; largest scale in world units. */
	double opacity[SYNTH_QUANTILES], aspect[SYNTH_QUANTILES], size[SYNTH_QUANTILES];
	struct synth_visibility visibility[SYNTH_SPLITS];
};

/* All but the visibility, which stays 0. Returns 0, or -1 with *e set. */
int synth_statistics_make(struct synth_statistics *s, const struct synth_scene *scene,
	const struct synth_sentences *sentences, struct err *e);

/* Counts an object in a view: its visible pixels, and how many they would be with nothing else there. */
void synth_statistics_see(struct synth_statistics *s, enum camera_split split, size_t visible, size_t whole);

/* The share of sentences that have a relation (a row of RELATIONS). */
double synth_statistics_share(const struct synth_sentences *sentences, const struct synth_row *relation);

extern const char *const synth_bands[SYNTH_BANDS]; /* their names: "0", "<0.15" ... */
