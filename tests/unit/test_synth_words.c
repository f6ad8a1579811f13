/* What the sentences of a synthetic scene say: relations on layouts made by hand, and whole descriptions. */
#include "unit.h"

#include "synth/presets.h"
#include "synth/cameras.h"
#include "synth/sentence.h"

enum { SEEDS = UNIT_DRAWS(5, 1), H = 90, W = 120 };

static const int counts[] = {2, 3, 5, 8, 24};

struct relation_case {
	struct synth_relation relation;
	int of, verdict;
};

static void judge_all(const struct synth_viewpoint *v, const struct synth_sense *sense,
	const struct relation_case *cases, size_t n, const char *what)
{
	int among[SYNTH_MAX_OBJECTS];

	for (int i = 0; i < v->n; i++)
		among[i] = synth_sense_judge(sense, &v->objects[i]);
	for (size_t i = 0; i < n; i++) {
		int verdict = synth_relation_judge(v, &cases[i].relation, cases[i].of, among);
		CHECK(verdict == cases[i].verdict, "%s, case %zu: %d", what, i, verdict);
	}
}

/* Five things in a cross, seen from -y. */
static void relations_are_judged(void)
{
	struct synth_object o[5] = {
		{.on = -1}, {.x = -1, .on = -1}, {.x = 1, .on = -1}, {.y = -1, .on = -1}, {.y = 1, .on = -1}};
	enum { MIDDLE, LEFT, RIGHT, FRONT, BACK };
	struct synth_table t = {2, 2};
	struct synth_viewpoint v;
	static const struct relation_case cases[] = {
		{{PARSE_LEFT, PARSE_PLAIN, MIDDLE, -1}, LEFT, 1},
		{{PARSE_LEFT, PARSE_PLAIN, MIDDLE, -1}, RIGHT, -1},
		{{PARSE_LEFT, PARSE_PLAIN, MIDDLE, -1}, BACK, -1},
		{{PARSE_LEFT, PARSE_PLAIN, BACK, -1}, LEFT, 0},
		{{PARSE_RIGHT, PARSE_PLAIN, MIDDLE, -1}, RIGHT, 1},
		{{PARSE_RIGHT, PARSE_PLAIN, LEFT, -1}, LEFT, -1},
		{{PARSE_FRONT, PARSE_PLAIN, MIDDLE, -1}, FRONT, 1},
		{{PARSE_FRONT, PARSE_PLAIN, MIDDLE, -1}, BACK, -1},
		{{PARSE_BEHIND, PARSE_PLAIN, MIDDLE, -1}, BACK, 1},
		{{PARSE_BEHIND, PARSE_PLAIN, MIDDLE, -1}, FRONT, -1},
		{{PARSE_NEAR, PARSE_PLAIN, MIDDLE, -1}, LEFT, -1},
		{{PARSE_BETWEEN, PARSE_PLAIN, LEFT, RIGHT}, MIDDLE, 1},
		{{PARSE_BETWEEN, PARSE_PLAIN, LEFT, RIGHT}, BACK, -1},
		{{PARSE_BETWEEN, PARSE_PLAIN, LEFT, RIGHT}, LEFT, -1},
		{{PARSE_NEAR, PARSE_MOST, LEFT, -1}, MIDDLE, 1},
		{{PARSE_NEAR, PARSE_MOST, LEFT, -1}, RIGHT, -1},
		{{PARSE_FAR, PARSE_MOST, LEFT, -1}, RIGHT, 1},
		{{PARSE_FAR, PARSE_MOST, MIDDLE, -1}, RIGHT, 0},
		{{PARSE_LEFT, PARSE_PLAIN, -1, -1}, LEFT, 1},
		{{PARSE_LEFT, PARSE_PLAIN, -1, -1}, MIDDLE, -1},
		{{PARSE_RIGHT, PARSE_PLAIN, -1, -1}, RIGHT, 1},
		{{PARSE_FRONT, PARSE_PLAIN, -1, -1}, FRONT, 1},
		{{PARSE_BEHIND, PARSE_PLAIN, -1, -1}, FRONT, -1},
		{{PARSE_MIDDLE, PARSE_PLAIN, -1, -1}, MIDDLE, 1},
		{{PARSE_MIDDLE, PARSE_PLAIN, -1, -1}, LEFT, 0},
		{{PARSE_LEFT, PARSE_MOST, -1, -1}, LEFT, 1},
		{{PARSE_RIGHT, PARSE_MOST, -1, -1}, RIGHT, 1},
		{{PARSE_RIGHT, PARSE_MOST, -1, -1}, MIDDLE, -1},
		{{PARSE_NEAR, PARSE_MOST, -1, -1}, FRONT, 1},
		{{PARSE_NEAR, PARSE_MOST, -1, -1}, LEFT, -1},
		{{PARSE_FAR, PARSE_MOST, -1, -1}, BACK, 1},
		{{PARSE_FAR, PARSE_MOST, -1, -1}, FRONT, -1},
		{{PARSE_LEFT, PARSE_MORE, -1, -1}, LEFT, 1},
		{{PARSE_RIGHT, PARSE_MORE, -1, -1}, LEFT, -1},
		{{PARSE_FRONT, PARSE_MORE, -1, -1}, FRONT, 1},
		{{PARSE_BEHIND, PARSE_MORE, -1, -1}, FRONT, -1},
		{{PARSE_MIDDLE, PARSE_MORE, -1, -1}, MIDDLE, 0}, /* of five */
		{{PARSE_ON, PARSE_PLAIN, -1, -1}, LEFT, 1},
	};

	synth_viewpoint_make(&v, o, 5, &t, (double[3]){0}, (double[2]){1, 0}, (double[2]){0, 1}, 0);
	judge_all(&v, &synth_anything, cases, sizeof cases / sizeof *cases, "cross");
	/* From the other side of the table left is right. */
	synth_viewpoint_make(&v, o, 5, &t, (double[3]){0}, (double[2]){-1, 0}, (double[2]){0, -1}, 0);
	struct synth_relation r = {PARSE_LEFT, PARSE_PLAIN, MIDDLE, -1};
	CHECK(synth_relation_judge(&v, &r, RIGHT, NULL) == 1, "left depends on the viewpoint");
}

/* A ball on a mug on a plate; another mug beside the plate; a third, larger one at the left; a book. From -y.
 */
static void stacks_are_judged(void)
{
	enum { PLATE, CARRIED, BALL, BESIDE, LEFT, BOOK, N };
	struct synth_object o[N] = {
		[PLATE] = {.shape = SYNTH_PLATE, .on = -1, .radius = 0.6, .height = 0.1},
		[CARRIED] = {.shape = SYNTH_MUG, .x = 0.35, .on = PLATE, .radius = 0.2, .height = 0.3},
		[BALL] = {.shape = SYNTH_BALL, .x = 0.35, .on = CARRIED, .radius = 0.2, .height = 0.4},
		[BESIDE] = {.shape = SYNTH_MUG, .x = 1, .on = -1, .radius = 0.2, .height = 0.3},
		[LEFT] = {.shape = SYNTH_MUG, .x = -1.5, .y = -1, .on = -1, .radius = 0.4, .height = 0.6},
		[BOOK] = {.shape = SYNTH_BOOK, .x = 1.5, .y = -1, .on = -1, .radius = 0.5, .height = 0.2},
	};
	static const struct relation_case cases[] = {
		{{PARSE_ON, PARSE_PLAIN, PLATE, -1}, CARRIED, 1},
		{{PARSE_ON, PARSE_PLAIN, PLATE, -1}, BALL, 0}, /* by way of the mug */
		{{PARSE_ON, PARSE_PLAIN, CARRIED, -1}, BALL, 1},
		{{PARSE_ON, PARSE_PLAIN, PLATE, -1}, BESIDE, -1},
		{{PARSE_ON, PARSE_PLAIN, CARRIED, -1}, PLATE, -1},
		{{PARSE_BELOW, PARSE_PLAIN, CARRIED, -1}, PLATE, 1},
		{{PARSE_BELOW, PARSE_PLAIN, BALL, -1}, PLATE, 0},
		{{PARSE_BELOW, PARSE_PLAIN, PLATE, -1}, CARRIED, -1},
		{{PARSE_ON, PARSE_PLAIN, -1, -1}, PLATE, 1}, {{PARSE_ON, PARSE_PLAIN, -1, -1}, CARRIED, -1},
		{{PARSE_RIGHT, PARSE_PLAIN, PLATE, -1}, CARRIED, 0}, /* on its right part */
		{{PARSE_RIGHT, PARSE_PLAIN, PLATE, -1}, BESIDE, 1},
		{{PARSE_LEFT, PARSE_PLAIN, PLATE, -1}, CARRIED, -1},
		{{PARSE_NEAR, PARSE_PLAIN, PLATE, -1}, CARRIED, 0},
		{{PARSE_NEAR, PARSE_PLAIN, PLATE, -1}, BESIDE, 1},
		{{PARSE_BETWEEN, PARSE_PLAIN, PLATE, BESIDE}, CARRIED, 0},
		{{PARSE_BETWEEN, PARSE_PLAIN, CARRIED, BALL}, BESIDE,
			0}, /* nothing is between two in one place */
	};
	static const struct relation_case of_mugs[] = {
		{{PARSE_NEAR, PARSE_MOST, PLATE, -1}, CARRIED, 0},
		{{PARSE_NEAR, PARSE_MOST, PLATE, -1}, BESIDE, 0}, /* or is it the one on the plate? */
		{{PARSE_NEAR, PARSE_MOST, BOOK, -1}, BESIDE, 1},
		{{PARSE_NEAR, PARSE_MOST, BOOK, -1}, CARRIED, -1},
		{{PARSE_LEFT, PARSE_MORE, -1, -1}, LEFT, 1},
		{{PARSE_LEFT, PARSE_MORE, -1, -1}, CARRIED, -1},
		{{PARSE_RIGHT, PARSE_MORE, -1, -1}, BESIDE, 1},
		{{PARSE_FRONT, PARSE_MORE, -1, -1}, LEFT, 1},
		{{PARSE_BEHIND, PARSE_MORE, -1, -1}, CARRIED, 0}, /* as far as the one beside it */
		{{PARSE_MIDDLE, PARSE_MORE, -1, -1}, CARRIED, 0},
		{{PARSE_MIDDLE, PARSE_MORE, -1, -1}, LEFT, -1},
		{{PARSE_LARGER, PARSE_MOST, -1, -1}, LEFT, 1},
		{{PARSE_LARGER, PARSE_MOST, -1, -1}, CARRIED, -1},
		{{PARSE_SMALLER, PARSE_MOST, -1, -1}, LEFT, -1},
		{{PARSE_SMALLER, PARSE_MOST, -1, -1}, CARRIED, 0}, /* two are alike */
		{{PARSE_TALLER, PARSE_MOST, -1, -1}, LEFT, 1},
		{{PARSE_TALLER, PARSE_MOST, -1, -1}, BESIDE, -1},
	};
	static const struct relation_case of_all[] = {
		{{PARSE_LARGER, PARSE_MOST, -1, -1}, LEFT, 0}, /* in bulk, but the plate is as wide */
		{{PARSE_TALLER, PARSE_MOST, -1, -1}, LEFT, 1},
		{{PARSE_TALLER, PARSE_MOST, -1, -1}, BALL, -1},
	};
	static const struct relation_case of_balls[] = {
		{{PARSE_LARGER, PARSE_MOST, -1, -1}, BALL, 0}, /* of one */
		{{PARSE_LEFT, PARSE_MORE, -1, -1}, BALL, 0},
		{{PARSE_RIGHT, PARSE_MOST, -1, -1}, BALL, -1}, /* of everything */
	};
	struct synth_table t = {2, 2};
	struct synth_viewpoint v;
	struct synth_sense mugs = synth_anything, balls = synth_anything;

	mugs.surely[SYNTH_SHAPE] = 1U << SYNTH_MUG;
	balls.surely[SYNTH_SHAPE] = 1U << SYNTH_BALL;
	synth_viewpoint_make(&v, o, N, &t, (double[3]){0}, (double[2]){1, 0}, (double[2]){0, 1}, 0);
	judge_all(&v, &synth_anything, cases, sizeof cases / sizeof *cases, "stack");
	judge_all(&v, &mugs, of_mugs, sizeof of_mugs / sizeof *of_mugs, "mugs");
	judge_all(&v, &synth_anything, of_all, sizeof of_all / sizeof *of_all, "all");
	judge_all(&v, &balls, of_balls, sizeof of_balls / sizeof *of_balls, "balls");
	/* The mug at the right moved to the other side: the carried one is now amid the three. */
	o[BESIDE].y = 0.8;
	o[BESIDE].x = 2.2;
	o[LEFT].y = -0.8;
	synth_viewpoint_make(&v, o, N, &t, (double[3]){0}, (double[2]){1, 0}, (double[2]){0, 1}, 0);
	static const struct relation_case middle = {{PARSE_MIDDLE, PARSE_MORE, -1, -1}, CARRIED, 1};
	judge_all(&v, &mugs, &middle, 1, "the middle one of three mugs");
}

/* No frame and no wording of a test sentence is one of a training sentence. */
static void test_words_are_new(void)
{
	struct synth_wordings w;
	struct err e = {0};

	if (!CHECK(!synth_wordings_load(&w, SYNTH_TABLE_SENTENCES, &e), "%s", e.message))
		return;
	for (int i = 0; i < w.n; i++)
		for (int k = 0; k < i; k++) {
			const struct synth_row *a = &w.rows[k], *b = &w.rows[i];
			int both = (a->list == SYNTH_TRAIN && b->list == SYNTH_TEST) ||
				   (a->list == SYNTH_SAID && b->list == SYNTH_SAID_TEST);
			CHECK(!both || strcmp(a->text, b->text), "'%s' is in both", a->text);
		}
	synth_wordings_free(&w);
}

/* Every row of the data is understood. */
static void rows_are_known(int is_unseen)
{
	int lists[SYNTH_LISTS] = {0};
	struct synth_wordings w;
	struct err e = {0};

	if (!CHECK(!synth_wordings_load(&w, is_unseen ? SYNTH_TABLE_UNSEEN : SYNTH_TABLE_SENTENCES, &e), "%s",
		    e.message))
		return;
	for (int i = 0; i < w.n; i++) {
		const struct synth_row *r = &w.rows[i];
		if (!CHECK(r->list < SYNTH_LISTS && *r->text && r->weight > 0, "'%s'", r->text))
			continue;
		lists[r->list]++;
		if (r->list < SYNTH_FRAMES)
			for (const char *p = strchr(r->text, '%'); p; p = strchr(p + 1, '%'))
				CHECK(p[1] && strchr("SFMCNQGTPRWZVLAXYKOEUI", p[1]), "'%s'", r->text);
		else if (r->list == SYNTH_KINDS)
			CHECK(r->frames < SYNTH_FRAMES, "'%s'", r->text);
		else if (r->list < SYNTH_SIZES_SAID)
			CHECK((int)r->relation >= 0 && r->anchors >= -1 && r->anchors <= 2 && r->form &&
					strchr(r->list == SYNTH_RELATIONS ? "RZ01v2" : "phwc", r->form),
				"'%s'", r->text);
		else
			CHECK(r->list == SYNTH_FOREIGN || r->surely, "'%s'", r->text);
	}
	CHECK(lists[SYNTH_NOUNS] && lists[SYNTH_RELATIONS] && lists[SYNTH_SAID], "lists are missing");
	for (int list = SYNTH_PLAINLY; list < SYNTH_FRAMES; list++)
		CHECK(!lists[list] == !is_unseen, "%d frames of list %d", lists[list], list);
	synth_wordings_free(&w);
}

/* Every kind of motion is said, kept back in words of its own; slots are filled. */
static void motion_is_said(void)
{
	struct synth_wordings seen, kept;
	struct err e = {0};
	int lists[SYNTH_LISTS][2] = {0}, n = 0;

	if (!CHECK(!synth_wordings_load(&seen, SYNTH_TABLE_MOVES, &e), "%s", e.message) ||
		!CHECK(!synth_wordings_load(&kept, SYNTH_TABLE_MOVES_KEPT, &e), "%s", e.message))
		return;
	for (int k = 0; k < 2; k++) {
		const struct synth_wordings *w = k ? &kept : &seen;
		for (int i = 0; i < w->n; i++) {
			const struct synth_row *r = &w->rows[i];
			CHECK(r->list >= SYNTH_MOTIONS && r->list < SYNTH_LISTS && r->form &&
					strchr("spe", r->form),
				"'%s'", r->text);
			for (const char *p = strchr(r->text, '%'); p; p = strchr(p + 1, '%'))
				CHECK(p[1] && strchr("TPAY", p[1]), "'%s'", r->text);
			CHECK(strchr(r->text, '%') && strcspn(r->text, "\"\\") == strlen(r->text), "'%s'",
				r->text);
			lists[r->list][k] += r->form == 's';
			n += k;
			for (int j = 0; j < seen.n && k; j++)
				CHECK(strcmp(seen.rows[j].text, r->text), "'%s' is in both", r->text);
		}
	}
	for (int list = SYNTH_MOTIONS; list < SYNTH_LISTS; list++)
		CHECK(lists[list][0] && lists[list][1], "%s is not said",
			synth_motion_name((enum synth_list)list));
	CHECK(n >= 60, "%d are kept back", n);
	synth_wordings_free(&seen);
	synth_wordings_free(&kept);
}

static int shares_words(const char *text, const struct synth_sentence *with, const struct synth_object *o)
{
	/* The pair "colour noun" in its plainest form; synonyms are covered by the generator's own rule. */
	char pair[64];

	snprintf(pair, sizeof pair, "%s %s", synth_value_name(SYNTH_COLOUR, (int)o->colour),
		synth_value_name(SYNTH_SHAPE, (int)o->shape));
	return strstr(text, pair) && strstr(with->text, pair);
}

/* What all sentences have in common. */
struct tally {
	int sentences, words, with_relation, arguable;
};

/* The verdict of a whole sentence about object i. */
static int sentence_judge(const struct synth_sentence *s, const struct synth_viewpoint *v, int i)
{
	int among[SYNTH_MAX_OBJECTS];

	for (int k = 0; k < v->n; k++)
		among[k] = synth_sense_judge(&s->phrases[0].sense, &v->objects[k]);
	int verdict = among[i];
	for (int k = 0; k < s->clause_count; k++) {
		int one = synth_relation_judge(v, &s->clauses[k].is, i, among);
		verdict = one < verdict ? one : verdict;
	}
	return verdict;
}

static int is_wrong(const struct synth_sentence *s, const struct synth_viewpoint *v)
{
	int others = 0;

	for (int k = 0; k < v->n; k++)
		others += k != s->object && sentence_judge(s, v, k) >= 0;
	return others || sentence_judge(s, v, s->object) < 0;
}

static int is_on_wrong_side(const struct synth_sentence *s, const struct synth_viewpoint *v)
{
	int wrong = 0;

	for (int k = 0; k < s->clause_count; k++) {
		const struct synth_relation *r = &s->clauses[k].is;
		if (r->degree != PARSE_PLAIN || r->a < 0)
			continue;
		if (r->relation == PARSE_LEFT)
			wrong += v->u[s->object] >= v->u[r->a] || !strstr(s->text, "left");
		if (r->relation == PARSE_BEHIND)
			wrong += v->v[s->object] <= v->v[r->a];
	}
	return wrong;
}

static void sentences_of(uint64_t seed, int n, struct tally *t)
{
	struct synth_object o[SYNTH_MAX_OBJECTS];
	struct synth_sentences list = {0};
	struct synth_table table;
	struct synth_viewpoint v;
	struct cameras c;
	struct err e = {0};
	const struct synth_preset *preset = synth_preset(n % SYNTH_PRESETS);
	struct synth_options options = {.preset = preset,
		.seed = seed,
		.objects = n,
		.views = 25,
		.width = W,
		.height = H,
		.gaussians = 1000};
	int wrong = 0, false_side = 0, same = 0, length = 0, shared = 0, total = n * SYNTH_SENTENCES;

	/* Of few, three may stand so that there are no words for them. */
	int is_impossible = -1;
	for (int attempt = 0; attempt < 2 && is_impossible; attempt++) {
		options.seed = synth_preset_seed(0, seed, attempt);
		synth_arrange(o, n, &table, preset, options.seed);
		if (synth_cameras_make(&c, &options, &table, &e))
			return;
		synth_viewpoint_reference(&v, o, n, &table, &c, 0);
		cameras_free(&c);
		synth_sentences_free(&list);
		is_impossible = synth_sentences_make(&list, &v, options.seed, 0, &e);
	}
	const struct synth_sentence *s = list.items;
	if (!CHECK(!is_impossible && (int)list.n == total, "%s", e.message)) {
		synth_sentences_free(&list);
		return;
	}
	for (int i = 0; i < total; i++) {
		int words = synth_count_words(s[i].text);
		t->sentences++;
		t->words += words;
		t->with_relation += s[i].clause_count > 0;
		t->arguable += sentence_judge(&s[i], &v, s[i].object) == 0;
		wrong += is_wrong(&s[i], &v);
		false_side += is_on_wrong_side(&s[i], &v);
		length +=
			words < SYNTH_MIN_WORDS || words > SYNTH_MAX_WORDS || strchr(s[i].text, '%') != NULL;
		for (int k = 0; k < i; k++) {
			same += !strcmp(s[i].ref, s[k].ref) ||
				(s[i].object == s[k].object && !strcmp(s[i].text, s[k].text));
			if (s[i].split == SPLIT_TEST && s[k].object == s[i].object)
				shared += shares_words(s[i].text, &s[k], &o[s[i].object]);
		}
		CHECK((s[i].split == SPLIT_TEST) == (i % SYNTH_SENTENCES == SYNTH_TRAIN_SENTENCES),
			"split of %s", s[i].ref);
	}
	CHECK(!wrong && !false_side && !same && !length && !shared,
		"seed %d, %d objects: %d wrong, %d on the wrong side, %d twice, %d too short or long, %d not new",
		(int)seed, n, wrong, false_side, same, length, shared);
	synth_sentences_free(&list);
}

static void sentences_are_as_people_write(void)
{
	struct tally all = {0};

	for (uint64_t seed = 1; seed <= SEEDS; seed++)
		for (size_t c = 0; c < sizeof counts / sizeof *counts; c++) {
			struct tally one = {0};
			sentences_of(seed, counts[c], &one);
			double mean = one.words / (double)one.sentences;
			CHECK(counts[c] < 8 || (mean > 13.2 && mean < 14.0), "seed %d, %d objects: %g words",
				(int)seed, counts[c], mean);
			all.sentences += one.sentences;
			all.with_relation += one.with_relation;
			all.arguable += one.arguable;
		}
	CHECK(all.with_relation > 0.8 * all.sentences && all.with_relation < all.sentences,
		"%d of %d sentences have a relation", all.with_relation, all.sentences);
	CHECK(all.arguable < 0.02 * all.sentences, "%d of %d sentences could be argued", all.arguable,
		all.sentences);
}

int main(void)
{
	relations_are_judged();
	stacks_are_judged();
	test_words_are_new();
	rows_are_known(0);
	rows_are_known(1);
	motion_is_said();
	sentences_are_as_people_write();
	return unit_end();
}
