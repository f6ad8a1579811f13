#include "cmd/ask/asking.h"

#include "base/file.h"
#include "base/mem.h"
#include "formats/cameras/camerafile.h"
#include "lang/closed.h"
#include "lang/question_kinds.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* A model of nothing, of this scene and encoder. */
static int make_nameless(struct asking *a, struct err *e)
{
	struct anymodel *m = &a->model;
	const struct lifted none = {.gaussians = a->scene.splats.n, .width = encoder_width(&a->encoder)};

	*m = (struct anymodel){.is_lifted = 1, .lifted = none};
	m->origin = (struct origin){a->scene.fingerprint, a->encoder.fingerprint};
	m->lifted.indptr = mem_zalloc(1, sizeof *m->lifted.indptr, "objects", e);
	m->lifted.offsets = mem_zalloc(1, sizeof *m->lifted.offsets, "sentences", e);
	m->lifted.middle = mem_zalloc(1, sizeof *m->lifted.middle, "words", e);
	return m->lifted.indptr && m->lifted.offsets && m->lifted.middle
		       ? parser_weights_default(&m->weights, e)
		       : -1;
}

static int check_fit(const struct asking *a, const struct anymodel *m, const char *model, struct err *e)
{
	const struct run_folder *f = &a->files;
	const struct lifted *l = &m->lifted;

	if (anymodel_check_scene(m, model, &a->scene, e))
		return -1;
	if (l->width != encoder_width(&a->encoder))
		return err_set(e, ERR_FORMAT, "%s: is of sentences of width %d, the encoder %s makes %d",
			model, l->width, f->encoder, encoder_width(&a->encoder));
	return parser_weights_need_middle(&m->weights, model, l->middle, &m->origin.encoder, e) ||
	       fingerprint_check(
		       "encoder", model, &m->origin.encoder, f->encoder, &a->encoder.fingerprint, e);
}

static int read_model(const struct asking *a, struct anymodel *m, const char *path, struct err *e)
{
	if (anymodel_read(m, path, e))
		return -1;
	if (!m->is_lifted)
		return err_set(e, ERR_FORMAT, "%s: is a %s; questions need one of refer-lift", path,
			m->is_selection ? "selection" : "trained model");
	return check_fit(a, m, path, e);
}

static int read_all(struct asking *a, struct err *e)
{
	const struct run_folder *f = &a->files;
	SCOPED_BY(anymodel_free) struct anymodel labels = {0};

	if (run_folder_find(&a->files, a->options->run, &a->options->given, a->options->may_be_nameless, e) ||
		scene_read(&a->scene, f->scene, e) || scene_move(&a->scene, a->options->time, e) ||
		encoder_read(&a->encoder, f->encoder, 0, e))
		return -1;
	if (f->model ? read_model(a, &a->model, f->model, e) : make_nameless(a, e))
		return -1;
	if (!f->labels)
		return 0;
	return read_model(a, &labels, f->labels, e) || lifted_add(&a->model.lifted, &labels.lifted, e) ? -1
												       : 0;
}

int asking_read_camera(struct asking *a, const char *path, struct err *e)
{
	SCOPED_BY(cameras_free) struct cameras read = {0};

	if (camerafile_read(&read, path, e) || camerafile_need_pinholes(&read, path, NULL, e))
		return -1;
	if (read.n > 1)
		return err_set(
			e, ERR_FORMAT, "%s: has %zu views; --camera takes one", file_name(path), read.n);
	cameras_shift(&read, a->scene.offset);
	const struct cameras earlier = a->given;
	a->given = read;
	read = earlier;
	return 0;
}

static int find_viewpoint(struct asking *a, struct err *e)
{
	const char *text = a->options->viewpoint;

	a->from = (struct viewpoint){.kind = VIEWPOINT_USUAL};
	if (!text && a->given.n)
		a->from = (struct viewpoint){.kind = VIEWPOINT_CAMERA, .camera = a->given.views};
	if (text && viewpoint_read(&a->from, text, &a->scene.cameras, a->scene.offset))
		return err_set(e, ERR_USAGE, "--viewpoint: '%s' is no view and no x,y,z", text);
	return 0;
}

static int make_chooser(struct asking *a, struct err *e)
{
	struct list_name name;
	unsigned parts;

	if (choose_without(a->options->without, &parts, &name))
		return err_set(e, ERR_USAGE, "--without: no part '%.*s'", (int)name.length, name.text);
	a->parser = (struct parser){.weights = &a->model.weights, .encoder = a->encoder.fingerprint.hex};
	a->of = (struct choose_scene){&a->model.lifted, &a->scene.splats, &a->scene.cameras, &a->parser, 1,
		a->model.tracks.times ? &a->model.tracks : NULL};
	a->chooser = chooser_make(&a->of, parts, e);
	return a->chooser ? 0 : -1;
}

int asking_open(struct asking *a, const struct asking_options *options, struct err *e)
{
	a->options = options;
	return read_all(a, e) || (options->camera && asking_read_camera(a, options->camera, e)) ||
			       find_viewpoint(a, e) || anymodel_place(&a->model, &a->scene, e) ||
			       anymodel_track(&a->model, &a->scene, e) || make_chooser(a, e)
		       ? -1
		       : 0;
}

void asking_close(struct asking *a)
{
	chooser_free(a->chooser);
	encoding_free(&a->ahead);
	encoder_free(&a->encoder);
	anymodel_free(&a->model);
	cameras_free(&a->given);
	scene_free(&a->scene);
	run_folder_free(&a->files);
}

/* An anchor's noun that is known, and how well another thing fits for which it may be meant as well. */
static const double known_anchor = 0.5, as_likely = 0.8;

/* What the choice's watch gets to. */
struct watched {
	struct asking_answer *answer;
	const char *question;
	const struct asking_options *options;
	int is_out_of_memory;
};

/* The least of the target's parts for each object; of "the red mugs and the bowl" nothing is told. */
static void find_holds(const struct meaning *m, double *holds)
{
	for (size_t o = 0; o < m->arrangement->n; o++) {
		holds[o] = 1;
		for (size_t k = 0; k < m->part_count && !m->sentence->parse->phrases[0].also.n; k++)
			if (!m->parts[k].phrase && m->parts[k].kind != MEANING_NOUN &&
				m->parts[k].value[o] < holds[o])
				holds[o] = m->parts[k].value[o];
	}
}

/* "The box", "my red box", but not "a box". */
static int is_definite(const struct parse *p, const struct parse_phrase *f)
{
	static const char articles[] = "the|that|this|my|your|our";
	int w = f->noun.n ? f->noun.item[0] : -1;

	while (w > 0 && (parse_list_has(&f->attributes, w - 1) || closed_class_of(p, w - 1) == CLOSED_SIZE))
		w--;
	return parse_word_is(p, w - 1, articles);
}

/* Whether a phrase that a place is told by is nothing that is known here. */
static int is_unknown(const struct meaning *m, int phrase)
{
	if (m->sentence->parse->phrases[phrase].viewer || meaning_is_scene(m, phrase))
		return 0;
	return fmin(m->known[phrase], largest(there_of(m, phrase), m->arrangement->n)) < known_anchor;
}

/* What is known of the anchors of a clause; and the two likeliest things that the only one may be, "the box"
 * among boxes, where one is as likely as the other. */
static void find_anchor(const struct meaning *m, struct asking_answer *answer)
{
	const struct parse *p = m->sentence->parse;
	const struct parse_list *clauses = &p->phrases[0].clauses;

	for (int k = 0; k < clauses->n; k++) {
		const struct parse_clause *c = &p->clauses[clauses->item[k]];
		const int i = c->anchors.n == 1 ? c->anchors.item[0] : -1;
		for (int j = 0; j < c->anchors.n && c->relation < PARSE_WITH && !c->negated; j++)
			if (is_unknown(m, c->anchors.item[j])) {
				answer->is_anchor_unknown = 1;
				if (c->relation ==
					PARSE_BETWEEN) /* what is by the other end is not between */
					memset(answer->holds, 0, m->arrangement->n * sizeof *answer->holds);
			}
		if (i < 0 || p->phrases[i].viewer || meaning_is_scene(m, i) || is_unknown(m, i) ||
			p->phrases[i].count != PARSE_ONE || !is_definite(p, &p->phrases[i]))
			continue;
		const double *fit = fit_of(m, i);
		const size_t best = best_of(fit, m->arrangement->n);
		for (size_t o = 0; o < m->arrangement->n; o++)
			if (o != best && fit[o] > as_likely * fit[best] &&
				there_of(m, i)[o] >= known_anchor) {
				answer->unclear[0] = best;
				answer->unclear[1] = o;
			}
	}
}

static void watch(void *data, size_t i, const struct meaning *m)
{
	struct watched *w = data;

	(void)i;
	find_holds(m, w->answer->holds);
	find_anchor(m, w->answer);
	w->answer->places = m->arrangement;
	w->answer->words = m->vocabulary;
	w->answer->unknown = m->unknown;
	for (size_t o = 0; o < m->arrangement->n; o++)
		memcpy(w->answer->centres[o], m->arrangement->objects[o].centre,
			sizeof w->answer->centres[o]);
	const struct explained x = {m, m->sentence->parse, w->question};
	explain_refusal(&x, w->answer->reason);
	if (w->options->is_explained && !(w->answer->explained = explain_meaning(&x, w->options->is_json)))
		w->is_out_of_memory = 1;
}

int asking_answer_make(struct asking_answer *answer, size_t objects, struct err *e)
{
	*answer = (struct asking_answer){.runner_up = ASKING_NONE, .unclear = {ASKING_NONE, ASKING_NONE}};
	answer->things = mem_alloc(objects, sizeof *answer->things, "answer", e);
	answer->probability = mem_zalloc(objects, sizeof *answer->probability, "answer", e);
	answer->centres = mem_zalloc(objects, sizeof *answer->centres, "answer", e);
	answer->holds = mem_zalloc(objects, sizeof *answer->holds, "answer", e);
	return answer->things && answer->probability && answer->centres && answer->holds ? 0 : -1;
}

void asking_answer_free(struct asking_answer *answer)
{
	mem_free_all(answer->things, answer->probability, answer->centres, answer->holds, answer->explained);
	*answer = (struct asking_answer){0};
}

/* Whether object o is told before another: the likelier one, and of two as likely by name. */
static int is_before(const struct asking_answer *answer, char *const *names, size_t o, size_t other)
{
	const double own = answer->probability[o], theirs = answer->probability[other];

	return own > theirs || (own == theirs && strcmp(names[o], names[other]) < 0);
}

/* The chosen objects, likeliest first, and the likeliest of the others. */
static void sort_things(struct asking_answer *answer, char *const *names, const char *chosen, size_t objects)
{
	for (size_t o = 0; o < objects; o++) {
		if (!chosen[o]) {
			if (answer->runner_up == ASKING_NONE ||
				is_before(answer, names, o, answer->runner_up))
				answer->runner_up = o;
			continue;
		}
		size_t k = answer->count++;
		for (; k && is_before(answer, names, o, answer->things[k - 1]); k--)
			answer->things[k] = answer->things[k - 1];
		answer->things[k] = o;
	}
}

struct choose_sentence asking_sentence(const struct text *t, size_t r, struct viewpoint from)
{
	return (struct choose_sentence){.text = t->texts[r],
		.pieces = t->pieces ? t->pieces[r] : NULL,
		.vectors = t->words + (size_t)t->offsets[r] * (size_t)t->width,
		.middle = text_middle(t, r),
		.words = (size_t)(t->offsets[r + 1] - t->offsets[r]),
		.from = from};
}

/* By sentence r of the text. */
static int choose_answer(
	struct asking *a, const struct text *t, size_t r, int is_all, struct watched *w, struct err *e)
{
	const size_t objects = a->model.lifted.objects;
	struct choose_sentence sentence = asking_sentence(t, r, a->from);
	const struct choose_watch watching = {w, watch};
	SCOPED float *probability = mem_alloc(objects, sizeof *probability, "answer", e);
	SCOPED char *chosen = mem_alloc(objects, 1, "answer", e);
	struct choice choice;

	sentence.is_all = is_all;
	if (!probability || !chosen ||
		choose_with(a->chooser, &sentence, 1, &choice, probability, chosen, &watching, e))
		return -1;
	w->answer->there = choice.there;
	w->answer->is_by_purpose = choice.is_by_purpose;
	w->answer->is_motion = choice.is_motion;
	w->answer->motion = choice.motion;
	memcpy(w->answer->when, choice.when, sizeof choice.when);
	for (size_t o = 0; o < objects; o++)
		w->answer->probability[o] = choice.there * (double)probability[o];
	w->answer->is_guess = choice.there < a->options->least;
	if (w->answer->is_guess && (is_all || !a->options->is_always))
		memset(chosen, 0, objects);
	sort_things(w->answer, a->model.lifted.names, chosen, objects);
	return 0;
}

/* What all are told without a sentence; and what is expected already. */
static int is_expected(const struct encoding *x, const struct question_asked *q, const char *text)
{
	size_t i = 0;

	while (i < x->sentences.n && strcmp(x->sentences.items[i].text, text) != 0)
		i++;
	return q->kind == QUESTION_LIST || i < x->sentences.n;
}

void asking_expect(struct asking *a, const char *const *questions, size_t n)
{
	struct err e;
	char ref[32];
	int bad = 0;

	encoding_free(&a->ahead);
	a->ahead = (struct encoding){0};
	for (size_t i = 0; i < n && !bad; i++) {
		struct question_asked q;
		question_read(&q, questions[i], 0);
		for (int k = 0; k < 3 && !bad; k++) {
			snprintf(ref, sizeof ref, "%zu.%d", i, k);
			bad = *q.text[k] && !is_expected(&a->ahead, &q, q.text[k]) &&
			      sentences_add(&a->ahead.sentences, ref, "?", q.text[k], &e);
		}
	}
	if (!a->ahead.sentences.n || (!bad && !encode(&a->ahead, &a->encoder, &report_silent, &e)))
		return;
	encoding_free(&a->ahead);
	a->ahead = (struct encoding){0};
}

/* The sentence of a->ahead that the question is; their number where there is none, or where the encoder may
 * have cut it, which is said when it is encoded alone. */
static size_t find_ahead(const struct asking *a, const char *question)
{
	const struct text *t = &a->ahead.text;
	size_t r = 0;

	while (r < t->n && strcmp(t->texts[r], question) != 0)
		r++;
	if (r < t->n && (size_t)(t->offsets[r + 1] - t->offsets[r]) + 2 >= encoder_positions(&a->encoder))
		return t->n;
	return r;
}

int asking_ask(struct asking *a, const char *question, int is_all, struct asking_answer *answer,
	const struct report *to, struct err *e)
{
	struct watched w = {.answer = answer, .question = question, .options = a->options};
	SCOPED_BY(encoding_free) struct encoding alone = {0};
	const struct text *text = &a->ahead.text;
	size_t r = find_ahead(a, question);

	if (asking_answer_make(answer, a->model.lifted.objects, e))
		return -1;
	if (r == text->n) {
		text = &alone.text;
		r = 0;
		if (sentences_add(&alone.sentences, "1", "?", question, e) ||
			encode(&alone, &a->encoder, to, e))
			return -1;
	}
	snprintf(answer->reason, sizeof answer->reason, "the %s",
		text->offsets[r + 1] > text->offsets[r] ? "model has no objects" : "question has no words");
	if (choose_answer(a, text, r, is_all, &w, e))
		return -1;
	return w.is_out_of_memory ? err_set(e, ERR_SYSTEM, "explanation: out of memory") : 0;
}

const struct camera *asking_view(const struct asking *a, const char *name)
{
	const struct camera *view = cameras_find(&a->scene.cameras, name);

	return view ? view : cameras_find(&a->given, name);
}
