#include "synth/frames.h"

static const char *const train_frames[] = {
	"the %S %C %N %R",
	"the %C %N standing %R",
	"the %F %C %N that stands %R",
	"the %S %N %R and %R",
	"the %C %G placed %R",
	"the %M %N with a %F %C surface, %R",
	"the %S %F %C %M %N among the things on the table",
	"the %C object %R",
	"the %F thing %R and %R",
	"the %S %M %N %R",
	"the %N %R, %R",
	"the %S %C %G set down %R",
	"the %N made of %M, %R",
	"the %Z one of the %K %C %P",
	"the %Z one of the %K %F %P, %R",
	"the %Z %C %N, %R",
	"the %S %F %N, the one %R",
	"the %S %C %M %N that is %R",
	"the %N that is %C and %F, %R",
	"the %F %C %N %R and %R",
};
static const char *const test_frames[] = {
	"the %C coloured %N resting %R",
	"the %F %N of %C colour, located %R",
	"the %S %C %G that you can see %R",
	"the %S %N in %C, positioned %R",
	"the %N whose colour is %C, %R",
	"the %C item found %R and %R",
	"the %S %F %N lying %R",
	"out of the %K %C %P the %Z one, %R",
	"the %M %N that rests %R and %R",
	"the %S %G of %C colour, %R",
};

enum { TRAIN_WORDINGS = 4, TEST_WORDINGS = 2 };

/* How each relation is said, and how often it is tried. */
static const struct {
	int weight;
	const char *train[TRAIN_WORDINGS], *test[TEST_WORDINGS];
} relations[SYNTH_RELATIONS] = {
	[SYNTH_LEFT_OF] = {14, {"to the left of %A", "left of %A"},
		{"on the left-hand side of %A", "over to the left from %A"}},
	[SYNTH_RIGHT_OF] = {14, {"to the right of %A", "right of %A"},
		{"on the right-hand side of %A", "over to the right from %A"}},
	[SYNTH_IN_FRONT_OF] = {12, {"in front of %A"}, {"on the near side of %A", "on our side of %A"}},
	[SYNTH_BEHIND] = {12, {"behind %A", "to the rear of %A"},
		{"on the far side of %A", "on the other side of %A from us"}},
	[SYNTH_NEXT_TO] = {16, {"next to %A", "beside %A", "close to %A"}, {"right by %A", "alongside %A"}},
	[SYNTH_NEAREST_TO] = {6, {"nearest to %A", "closest to %A"}, {"at the least distance from %A"}},
	[SYNTH_FARTHEST_FROM] = {4, {"farthest from %A", "farthest away from %A"}, {"most distant from %A"}},
	[SYNTH_ON] = {70, {"on %A", "on top of %A"}, {"upon %A", "atop %A"}},
	[SYNTH_UNDER] = {60, {"under %A", "beneath %A"}, {"underneath %A", "directly below %A"}},
	[SYNTH_BETWEEN] = {20, {"between %A and %B", "in between %A and %B"},
		{"with %A and %B on either side"}},
	[SYNTH_LEFT_SIDE] = {3, {"at the left of the table", "towards the left edge of the table"},
		{"in the left half of the table"}},
	[SYNTH_RIGHT_SIDE] = {3, {"at the right of the table", "towards the right edge of the table"},
		{"in the right half of the table"}},
	[SYNTH_FRONT_SIDE] = {3, {"at the front of the table", "towards the front edge of the table"},
		{"in the near half of the table"}},
	[SYNTH_BACK_SIDE] = {3, {"at the back of the table", "towards the back edge of the table"},
		{"in the far half of the table"}},
	[SYNTH_MIDDLE] = {3, {"in the middle of the table", "near the centre of the table"},
		{"in the central part of the table"}},
	[SYNTH_ON_TABLE] = {1, {"directly on the table", "on the bare wood of the table"},
		{"right on the table top"}},
	[SYNTH_LEFTMOST] = {2, {"farthest to the left", "at the far left"}, {"at the leftmost place"}},
	[SYNTH_RIGHTMOST] = {2, {"farthest to the right", "at the far right"}, {"at the rightmost place"}},
	[SYNTH_NEAREST_US] = {4, {"nearest to us", "closest to the camera", "nearest to the viewer"},
		{"closest to where we stand"}},
	[SYNTH_FARTHEST_US] = {4,
		{"farthest from us", "farthest from the camera", "farthest from the viewer"},
		{"most distant from where we stand"}},
	[SYNTH_LEFT_ONE] = {3, {"left", "leftmost"}, {"left-hand"}},
	[SYNTH_RIGHT_ONE] = {3, {"right", "rightmost"}, {"right-hand"}},
	[SYNTH_NEAR_ONE] = {3, {"nearest", "closest"}, {"foremost"}},
	[SYNTH_FAR_ONE] = {3, {"farthest"}, {"hindmost"}},
	[SYNTH_MIDDLE_ONE] = {3, {"middle"}, {"central"}},
	[SYNTH_LARGEST] = {4, {"largest", "biggest"}, {"bulkiest"}},
	[SYNTH_SMALLEST] = {4, {"smallest", "littlest"}, {"tiniest"}},
	[SYNTH_TALLEST] = {3, {"tallest"}, {"highest"}},
};

int synth_frame_count(int is_test)
{
	return (int)(is_test ? sizeof test_frames / sizeof *test_frames
			     : sizeof train_frames / sizeof *train_frames);
}

const char *synth_frame(int is_test, int i)
{
	return is_test ? test_frames[i] : train_frames[i];
}

const char *synth_wording(enum synth_relation relation, int is_test, struct rng *r)
{
	const char *const *all = is_test ? relations[relation].test : relations[relation].train;
	uint32_t n = 0, most = is_test ? TEST_WORDINGS : TRAIN_WORDINGS;

	while (n < most && all[n])
		n++;
	return all[rng_below(r, n)];
}

enum synth_relation synth_relation_choose(char slot, struct rng *r)
{
	int first = slot == 'Z' ? SYNTH_LEFT_ONE : 0, end = slot == 'Z' ? SYNTH_RELATIONS : SYNTH_LEFT_ONE;
	int sum = 0;

	for (int i = first; i < end; i++)
		sum += relations[i].weight;
	int at = (int)rng_below(r, (uint32_t)sum), i = first;
	while (at >= relations[i].weight)
		at -= relations[i++].weight;
	return (enum synth_relation)i;
}
