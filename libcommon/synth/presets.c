#include "synth/presets.h"

/* A row: name; objects, views, width, height, Gaussians, test views; lots of shapes; lots of sizes; whether
 * stacked, severity; aspect, filled, hidden; distance, elevations; room; wood, boards; wall, carpet. */
static const struct synth_preset presets[SYNTH_PRESETS] = {
	{"table", 8, 25, 320, 240, 20000, 5, {1, 1, 1, 1, 1, 1, 1, 1, 1}, {1, 1, 1}, 0, SYNTH_MILD, 1.42,
		0.40, 0, 2.6, {26, 44}, 3.4, {0.70, 0.52, 0.34}, 0.55, {0.78, 0.80, 0.84},
		{0.42, 0.40, 0.41}},
	{"diner", 12, 38, 492, 364, 60000, 6, {1, 0, 2, 0, 2, 4, 4, 0, 3}, {1, 2, 1}, 1, SYNTH_SEVERE, 1.6,
		0.44, 0.20, 2.1, {30, 48}, 3.6, {0.56, 0.33, 0.22}, 0.8, {0.80, 0.72, 0.60},
		{0.50, 0.24, 0.20}},
	{"toys", 20, 52, 492, 364, 60000, 8, {3, 4, 3, 3, 0, 0, 0, 0, 0}, {1, 2, 1}, 1, SYNTH_SEVERE, 1.25,
		0.40, 0.20, 2.1, {30, 48}, 3.2, {0.80, 0.69, 0.50}, 2.0, {0.70, 0.80, 0.86},
		{0.40, 0.52, 0.40}},
	{"tea", 13, 45, 492, 364, 60000, 7, {1, 0, 0, 0, 4, 2, 3, 3, 0}, {1, 2, 1}, 1, SYNTH_SEVERE, 1.1,
		0.44, 0.20, 2.1, {30, 48}, 3.8, {0.40, 0.26, 0.17}, 0.4, {0.84, 0.83, 0.78},
		{0.36, 0.38, 0.46}},
	{"kitchen", 14, 60, 492, 364, 60000, 10, {1, 1, 1, 1, 2, 2, 2, 1, 2}, {1, 2, 2}, 1, SYNTH_SEVERE, 1.7,
		0.44, 0.20, 1.95, {30, 48}, 3.0, {0.72, 0.72, 0.70}, 1.2, {0.74, 0.80, 0.76},
		{0.56, 0.52, 0.47}},
};

const struct synth_preset *synth_preset(int number)
{
	return number >= 0 && number < SYNTH_PRESETS ? &presets[number] : NULL;
}

uint64_t synth_preset_seed(int number, uint64_t seed, int attempt)
{
	/* Odd constants far from small seeds: the golden ratio's, and one of splitmix64's. */
	return seed + (uint64_t)number * 0x9e3779b97f4a7c15u + (uint64_t)attempt * 0xbf58476d1ce4e5b9u;
}
