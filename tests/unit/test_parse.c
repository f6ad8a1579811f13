#include "tests/unit/default_parser.h"
#include "unit.h"

#include "base/rng.h"
#include "lang/analysis.h"
#include "lang/closed.h"
#include "formats/encoders/parser_weights.h"
#include "lang/marked.h"
#include "lang/parser.h"
#include "lang/parser_learn.h"
#include "lang/purpose.h"

static void words(const char *text, const char *expected)
{
	struct tokens t;
	char got[1024] = "";

	tokens_take(&t, text, NULL, NULL, 0);
	for (int i = 0; i < t.n; i++) {
		strcat(got, i ? " " : "");
		strcat(got, t.word[i].text);
	}
	CHECK(!strcmp(got, expected), "'%s': got '%s', expected '%s'", text, got, expected);
}

static void tokenises(void)
{
	words("The Red MUG.", "the red mug");
	words("it isn't the penguin's", "it is n't the penguin 's");
	words("wheres the one that isnt green", "where 's the one that is n't green");
	words("it isn\xe2\x80\x99t here", "it is n't here");
	words("left-hand T-shirt", "left hand t-shirt");
	words("the mug w/ dots w/o a lid, w/out w w/", "the mug with dots without a lid with out w with");
	words("teh box behnid it", "the box behind it");
	words("", "");
	words(" ,.;- ", "");
	words("\xff\xfe\x80", "\xff\xfe\x80");
}

static void closed_table_fits(void)
{
	CHECK(closed_count <= CLOSED_MOST, "%d closed words", closed_count);
	for (int i = 0; i < closed_count; i++) {
		CHECK(closed_find(closed_words[i].text) == i, "'%s' is twice in the table",
			closed_words[i].text);
		CHECK(strlen(closed_words[i].text) < TOKEN_LENGTH, "'%s' is too long", closed_words[i].text);
		int has = closed_words[i].class == CLOSED_PLACE || closed_words[i].class == CLOSED_SIZE;
		CHECK(has == (closed_words[i].relation >= 0), "'%s'", closed_words[i].text);
	}
}

static void lemmas(void)
{
	static const char *const pairs[][2] = {{"boxes", "box"}, {"shelves", "shelf"}, {"mice", "mouse"},
		{"glass", "glass"}, {"berries", "berry"}, {"bus", "bus"}, {"cups", "cup"},
		{"dishes", "dish"}};
	char out[TOKEN_LENGTH];

	for (size_t i = 0; i < sizeof pairs / sizeof *pairs; i++) {
		token_lemma(pairs[i][0], out);
		CHECK(!strcmp(out, pairs[i][1]), "%s gives %s", pairs[i][0], out);
	}
}

/* Whatever comes in, a parse comes out whose indices are all within it and whose phrases make no circle. */
static int depth_of(const struct parse *p, int phrase, int depth)
{
	if (depth > p->phrase_count)
		return depth;
	for (int i = 0; i < p->phrases[phrase].clauses.n; i++) {
		int c = p->phrases[phrase].clauses.item[i];
		if (c < 0 || c >= p->clause_count)
			return 1 << 20;
		for (int k = 0; k < p->clauses[c].anchors.n; k++) {
			int a = p->clauses[c].anchors.item[k];
			int below = a <= 0 || a >= p->phrase_count ? 1 << 20 : depth_of(p, a, depth + 1);
			if (below > p->phrase_count)
				return below;
		}
	}
	return depth;
}

static void check_whole(const struct parse *p, const char *text)
{
	int length = (int)strlen(text);

	CHECK(p->phrase_count >= 1, "'%s' has no target", text);
	CHECK(depth_of(p, 0, 0) <= p->phrase_count, "'%s' has a circle or a wrong index", text);
	for (int i = 0; i < p->word_count; i++)
		CHECK(p->words[i].span.begin >= 0 && p->words[i].span.begin < p->words[i].span.end &&
				p->words[i].span.end <= length,
			"'%s': word %d", text, i);
	CHECK(p->confidence >= 0 && p->confidence <= 1, "confidence %g", p->confidence);
}

static void parse_any(const struct parser *parser, const char *text, const struct parser_vectors *v)
{
	struct parse p;
	struct err e = {0};

	if (CHECK(!parse_sentence(&p, parser, text, v, &e), "%s", e.message))
		check_whole(&p, text);
	parse_free(&p);
}

static void takes_anything(void)
{
	static char text[20000];
	struct parser_weights w;
	struct parser grammar = default_parser(), learnt = {.weights = &w};
	struct err e = {0};
	struct rng r;
	static float vectors[600 * 8];

	rng_seed(&r, 3, 1);
	CHECK(!parser_weights_make(&w, 8, &e), "%s", e.message);
	for (int trial = 0; trial < 400; trial++) {
		struct parser_vectors v = {.pieces = "a b c", .vectors = vectors, .count = 3, .width = 8};
		int n = 0, count = (int)rng_below(&r, trial % 50 ? 40 : 900);
		parser_weights_begin(&w, &r);
		for (int i = 0; i < 24; i++)
			vectors[i] = (float)rng_normal(&r) * 4;
		for (int i = 0; i < count; i++) {
			if (rng_below(&r, 6))
				n += sprintf(text + n, "%s ",
					closed_words[rng_below(&r, (uint32_t)closed_count)].text);
			else
				text[n++] = (char)(1 + rng_below(&r, 255));
		}
		text[n] = 0;
		parse_any(&grammar, text, NULL);
		parse_any(&learnt, text, &v);
	}
	parser_weights_free(&w);
}

/* Phrases, clauses, what is left and how sure: of parses that are the same. */
static int is_same_parse(const struct parse *a, const struct parse *b)
{
	return a->phrase_count == b->phrase_count && a->clause_count == b->clause_count &&
	       a->unexplained.n == b->unexplained.n && a->confidence == b->confidence;
}

/* Vectors of another encoder, as wide, are not read; those of the same or of an unknown one are. */
static void other_encoder(void)
{
	static const char text[] = "the small red mug on the plate";
	static float vectors[7 * 8];
	struct parser_weights w;
	struct parser grammar = default_parser(), learnt = {.weights = &w};
	const struct parser_vectors v = {"the small red mug on the plate", vectors, 7, 8};
	struct parse by_grammar, p;
	struct err e = {0};
	struct rng r;

	rng_seed(&r, 5, 1);
	for (int i = 0; i < 7 * 8; i++)
		vectors[i] = (float)rng_normal(&r);
	CHECK(!parser_weights_make(&w, 8, &e), "%s", e.message);
	parser_weights_begin(&w, &r);
	w.grammar = grammar.weights->grammar;
	CHECK(!parse_sentence(&by_grammar, &grammar, text, &v, &e), "%s", e.message);
	static const struct {
		const char *weights, *vectors;
		int is_read;
	} pairs[] = {{"00000000000000aa", "00000000000000aa", 1}, {"00000000000000aa", "00000000000000ab", 0},
		{"", "00000000000000ab", 1}, {"00000000000000aa", "", 1}, {"00000000000000aa", NULL, 1}};
	for (size_t i = 0; i < sizeof pairs / sizeof *pairs; i++) {
		snprintf(w.encoder, sizeof w.encoder, "%s", pairs[i].weights);
		learnt.encoder = pairs[i].vectors;
		CHECK(!parse_sentence(&p, &learnt, text, &v, &e), "%s", e.message);
		CHECK(is_same_parse(&p, &by_grammar) != pairs[i].is_read, "pair %zu", i);
		parse_free(&p);
	}
	parse_free(&by_grammar);
	w.grammar = NULL;
	parser_weights_free(&w);
}

/* The program's own weights say which encoder they are of. */
static void default_has_encoder(void)
{
	struct parser_weights w;
	struct err e = {0};

	CHECK(!parser_weights_default(&w, &e), "%s", e.message);
	CHECK(strlen(w.encoder) == 16, "'%s'", w.encoder);
	parser_weights_free(&w);
}

/* Spaces, capitals and a stop at the end change nothing but offsets. */
static void indifferent_to_dress(void)
{
	static const char *const pairs[][2] = {
		{"the red cup left of the box", "The  Red   CUP left of the box."},
		{"the cup that is not on the plate", "THE CUP that is not on the plate!"}};
	const struct parser parser = default_parser();
	struct err e;

	for (size_t i = 0; i < sizeof pairs / sizeof *pairs; i++) {
		struct parse a, b;
		CHECK(!parse_sentence(&a, &parser, pairs[i][0], NULL, &e) &&
				!parse_sentence(&b, &parser, pairs[i][1], NULL, &e),
			"parses");
		CHECK(a.clause_count == b.clause_count && a.phrase_count == b.phrase_count, "%s",
			pairs[i][1]);
		for (int c = 0; c < a.clause_count && c < b.clause_count; c++)
			CHECK(a.clauses[c].relation == b.clauses[c].relation &&
					a.clauses[c].negated == b.clauses[c].negated,
				"%s: clause %d", pairs[i][1], c);
		parse_free(&a);
		parse_free(&b);
	}
}

/* What is said with one relation's word is said with another's too: for each pair of a word and its opposite,
 * the turned form swaps them. */
static void turned_round(void)
{
	static const struct {
		const char *text;
		enum parse_relation relation;
		int negated;
	} cases[] = {
		{"the wug left of the dax", PARSE_LEFT, 0},
		{"the wug right of the dax", PARSE_RIGHT, 0},
		{"the wug with the dax on its left", PARSE_RIGHT, 0},
		{"the wug with the dax on its right", PARSE_LEFT, 0},
		{"the wug with the dax behind it", PARSE_FRONT, 0},
		{"the wug with the dax in front of it", PARSE_BEHIND, 0},
		{"the wug that has the dax on it", PARSE_SUPPORTS, 0},
		{"the wug with the dax under it", PARSE_ABOVE, 0},
		{"the wug on the dax", PARSE_ON, 0},
		{"the wug not on the dax", PARSE_ON, 1},
		{"the wug with nothing on it", PARSE_SUPPORTS, 1},
	};
	const struct parser parser = default_parser();
	struct err e;

	for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
		struct parse p;
		if (!CHECK(!parse_sentence(&p, &parser, cases[i].text, NULL, &e), "%s", e.message))
			continue;
		CHECK(p.phrases[0].noun.n == 1 && !strcmp(p.words[p.phrases[0].noun.item[0]].text, "wug"),
			"'%s': target", cases[i].text);
		CHECK(p.phrases[0].clauses.n == 1 && p.clauses[0].relation == cases[i].relation &&
				p.clauses[0].negated == cases[i].negated,
			"'%s': %d clauses, %s", cases[i].text, p.phrases[0].clauses.n,
			p.clause_count ? parse_relation_name(p.clauses[0].relation) : "none");
		parse_free(&p);
	}
}

static void counts_and_orders(void)
{
	const struct parser parser = default_parser();
	struct parse p;
	struct err e;

	CHECK(!parse_sentence(&p, &parser, "the third wug from the right", NULL, &e), "parses");
	CHECK(p.phrases[0].ordinal == 3 && p.phrases[0].from == PARSE_RIGHT && !p.clause_count,
		"ordinal %d, %d clauses", p.phrases[0].ordinal, p.clause_count);
	parse_free(&p);
	CHECK(!parse_sentence(&p, &parser, "all the wugs", NULL, &e) && p.phrases[0].count == PARSE_ALL,
		"all");
	parse_free(&p);
	CHECK(!parse_sentence(&p, &parser, "the larger of the two wugs", NULL, &e), "parses");
	CHECK(p.phrases[0].count == PARSE_ONE && p.phrases[0].group == 2, "count %d group %d",
		p.phrases[0].count, p.phrases[0].group);
	parse_free(&p);
}

enum { WIDTH = 12 };

/* The loss of a batch, and its gradient where dw is given. */
static double loss_of(const struct parser_weights *w, struct parser_weights *dw, struct parser_batch *b,
	const struct analysis_word *const *right, struct parser_batch *scratch, struct parser_weights *spare)
{
	struct parser_weights *to = dw ? dw : spare;

	parser_forward(w, b);
	scratch->rows = b->rows;
	return parser_backward(w, to, b, right, scratch);
}

/* A member that is the same as the first changes nothing; another one does, and the order of the two does not
 * matter much. */
static void members_are_averaged(void)
{
	struct parser_weights w[2];
	struct parser_batch one, two;
	struct parser_features features[2][5] = {{{0}}};
	float vectors[5 * WIDTH];
	struct err e = {0};
	struct rng r;
	double same = 0, other = 0, swapped = 0;

	rng_seed(&r, 3, 1);
	for (int i = 0; i < 5 * WIDTH; i++)
		vectors[i] = (float)rng_normal(&r);
	for (int k = 0; k < 2; k++) {
		CHECK(!parser_weights_make(&w[k], WIDTH, &e), "%s", e.message);
		parser_weights_begin(&w[k], &r);
	}
	struct parser_weights again = w[0], joined = w[0], turned = w[1];
	again.next = &w[0];
	joined.next = &w[1];
	turned.next = &w[0];
	CHECK(!parser_batch_make(&one, 5, 1, &w[0], &e) && !parser_batch_make(&two, 5, 1, &joined, &e), "%s",
		e.message);
	parser_batch_add(&one, features[0], vectors, 5, WIDTH);
	parser_batch_add(&two, features[1], vectors, 5, WIDTH);
	parser_forward(&w[0], &one);
	const struct parser_weights *const pair[3] = {&again, &joined, &turned};
	double *const far[3] = {&same, &other, &swapped};
	float first[6], scores[3][6];
	parser_arcs(&w[0], &one, 0, 2, first);
	for (int k = 0; k < 3; k++) {
		parser_forward(pair[k], &two);
		for (int i = 0; i < 5 * NET_OUT; i++)
			*far[k] = fmax(*far[k], fabs((double)(two.out[i] - one.out[i])));
		parser_arcs(pair[k], &two, 0, 2, scores[k]);
	}
	CHECK(same == 0 && other > 0.01 && fabs(other - swapped) < 1e-5, "%g %g %g", same, other, swapped);
	for (int j = 0; j < 6; j++) {
		CHECK(scores[0][j] == first[j], "arc %d: %g", j, (double)(scores[0][j] - first[j]));
		CHECK(fabs((double)(scores[1][j] - scores[2][j])) < 1e-5, "arc %d, turned: %g", j,
			(double)(scores[1][j] - scores[2][j]));
	}
	parser_batch_free(&one);
	parser_batch_free(&two);
	for (int k = 0; k < 2; k++)
		parser_weights_free(&w[k]);
}

/* Central differences at random parameters, in single precision: the largest wrong share of the gradient's
 * size. */
static void gradient_is_right(void)
{
	struct parser_weights w, dw, spare;
	struct parser_batch b, scratch;
	struct parser_sample samples[3];
	const struct analysis_word *right[3];
	static const char *const marked[3] = {
		"the small/P1:smaller mug/T on/P2:!on the big/P3:larger@2 tea/n tray/A2.",
		"two red/a cans/T between/P1:between a box/A1 and the blue/a@1b chair/A1, not the old/a@X one/X",
		"Facing the door/V you see a lamp/A1; I want what is left/P1:left of it, a cup/T and a bowl/S"};
	static struct marked m;
	static struct tokens t;
	static struct analysis a;
	struct err e = {0};
	struct rng r;
	double worst = 0, size = 0;

	rng_seed(&r, 5, 2);
	CHECK(!parser_weights_make(&w, WIDTH, &e) && !parser_weights_make(&dw, WIDTH, &e) &&
			!parser_weights_make(&spare, WIDTH, &e) && !parser_batch_make(&b, 200, 3, &w, &e) &&
			!parser_scratch_make(&scratch, 200, 3, &w, &e),
		"%s", e.message);
	parser_weights_begin(&w, &r);
	for (int k = 0; k < 3; k++) {
		CHECK(!marked_take(&m, marked[k], &e), "%s", e.message);
		tokens_take(&t, m.text, NULL, NULL, 0);
		CHECK(!marked_analyse(&m, &t, &a, &e) &&
				!parser_sample_make(&samples[k], &t, &a, NULL, 0, WIDTH, &e),
			"%s", e.message);
		for (int i = 0; i < t.n * WIDTH; i++)
			samples[k].vectors[i] = (float)rng_normal(&r);
		right[k] = samples[k].right;
		parser_batch_add(&b, samples[k].features, samples[k].vectors, samples[k].n, WIDTH);
	}
	loss_of(&w, &dw, &b, right, &scratch, &spare);
	for (size_t i = 0; i < w.count; i++)
		size += (double)dw.slab[i] * dw.slab[i];
	size = sqrt(size);
	/* along random directions within each part, the largest steps that single precision resolves */
	struct parser_part parts[PARSER_PARTS];
	size_t at = 0;
	parser_parts(WIDTH, parts);
	for (int k = 0; k < PARSER_PARTS; k++) {
		size_t n = parts[k].rows * (parts[k].columns ? parts[k].columns : 1);
		double sum = 0, step = 2e-3, along = 0, loss[2];
		float *direction = malloc(n * sizeof *direction);
		for (size_t i = 0; i < n; i++) {
			direction[i] =
				(float)rng_normal(&r) + 5 * dw.slab[at + i] / (float)(size / sqrt((double)n));
			sum += (double)direction[i] * direction[i];
		}
		for (size_t i = 0; i < n; i++)
			along += direction[i] * (double)dw.slab[at + i] / sqrt(sum);
		for (int side = 0; side < 2; side++) {
			for (size_t i = 0; i < n; i++)
				w.slab[at + i] += (float)((side ? -2 : 1) * step * direction[i] / sqrt(sum));
			loss[side] = loss_of(&w, NULL, &b, right, &scratch, &spare);
		}
		for (size_t i = 0; i < n; i++)
			w.slab[at + i] += (float)(step * direction[i] / sqrt(sum));
		double wrong = fabs((loss[0] - loss[1]) / (2 * step) - along);
		CHECK(wrong < 0.02 * fabs(along) + 2e-3 * size, "%s: %g, by differences %g", parts[k].name,
			along, (loss[0] - loss[1]) / (2 * step));
		worst = wrong > worst ? wrong : worst;
		free(direction);
		at += n;
	}
	CHECK(size > 1e-3, "gradient %g", size);
	for (int k = 0; k < 3; k++)
		parser_sample_free(&samples[k]);
	parser_batch_free(&b);
	parser_batch_free(&scratch);
	parser_weights_free(&w);
	parser_weights_free(&dw);
	parser_weights_free(&spare);
}

/* Whether a sentence says what a thing is for, by its form. */
static void purposes_are_told(void)
{
	static const char *const yes[] = {"what you slice bread with", "something to sew with",
		"for digging holes", "the one used for fishing", "how would I shave?", "where the eggs go",
		"let's cook some rice", "I need to saw this plank", "people sail across the lake on it",
		"the thing for soup"};
	static const char *const no[] = {"the saw", "a saw left of the plank", "where is the saw?",
		"could you lift it", "what stands by the wall", "I mean the saw", "where did I leave it",
		"the saw with a plank on it", "the plank is under it", "it has a plank on it", "", "it",
		"how many planks stand by it"};
	const struct parser parser = default_parser();
	struct parse p = {0};
	struct err e;

	for (size_t i = 0; i < sizeof yes / sizeof *yes; i++) {
		CHECK(!parse_sentence(&p, &parser, yes[i], NULL, &e) && purpose_is_said(&p), "%s", yes[i]);
		parse_free(&p);
	}
	for (size_t i = 0; i < sizeof no / sizeof *no; i++) {
		CHECK(!parse_sentence(&p, &parser, no[i], NULL, &e) && !purpose_is_said(&p), "%s", no[i]);
		parse_free(&p);
	}
}

/* A jar of tea is a jar, whatever the networks take for its head; a roof of a house is left as it is. */
static void content_says_which(void)
{
	static const char *const cases[][2] = {
		{"the jar of tea", "jar"}, {"the cans of soup", "can"}, {"the roof of house", "house"}};
	const struct parser parser = default_parser();
	struct parse p = {0};
	struct err e;

	for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
		if (!CHECK(!parse_sentence(&p, &parser, cases[i][0], NULL, &e), "%s", e.message))
			continue;
		int head[] = {3}, said[] = {1};
		struct parse_phrase *f = &p.phrases[0];
		const struct parse_phrase kept = *f;
		f->noun = (struct parse_list){1, head};
		f->attributes = (struct parse_list){1, said};
		f->clauses.n = f->except.n = 0;
		CHECK(!parse_apply_rules(&p, 0, &e) && !strcmp(p.words[head[0]].lemma, cases[i][1]), "%s: %s",
			cases[i][0], p.words[head[0]].lemma);
		CHECK(head[0] + said[0] == 4, "both words are kept");
		*f = kept;
		parse_free(&p);
	}
}

int main(void)
{
	content_says_which();
	purposes_are_told();
	tokenises();
	closed_table_fits();
	lemmas();
	takes_anything();
	other_encoder();
	default_has_encoder();
	indifferent_to_dress();
	turned_round();
	counts_and_orders();
	members_are_averaged();
	gradient_is_right();
	return unit_end();
}
