#include "cmd/train/training.h"

#include "base/mem.h"
#include "base/names.h"
#include "cmd/lift/left_out.h"
#include "formats/records/masks.h"
#include "formats/scene/lifted.h"
#include "formats/scene/model.h"
#include "mask/bits.h"

#include <stdio.h>
#include <zlib.h>

/* An object is known by the first training sentence that names it. */
static int number_objects(struct training *t, struct err *e)
{
	SCOPED_BY(names_free) struct names names = {0};

	if (names_make(&names, t->object_names, sizeof *t->object_names, 0, t->sentences, e))
		return -1;
	for (size_t k = 0; k < t->sentences; k++)
		t->objects[k] = (int)names_find(&names, t->object_names[k]);
	return 0;
}

/* What stands for the text's sentences. */
static int read_query(struct training *t, const char *path, enum refer_query query, struct err *e)
{
	SCOPED_BY(parser_weights_free) struct parser_weights weights = {0};

	t->width = t->text.width;
	if (query == REFER_WORDS)
		return 0;
	t->width = query_width(t->text.width);
	return parser_weights_default(&weights, e) || text_query(&t->text, path, &weights, &t->query, e);
}

/* The training sentences of the text, packed. */
static int pack_sentences(struct training *t, struct err *e)
{
	const struct text *text = &t->text;
	const int64_t *offsets = t->query.words ? t->query.offsets : text->offsets;
	const float *words = t->query.words ? t->query.words : text->words;
	const size_t width = (size_t)t->width;

	t->offsets = mem_zalloc(text->n + 1, sizeof *t->offsets, "sentences", e);
	t->words = mem_alloc((size_t)offsets[text->n], width * sizeof(float), "words", e);
	t->objects = mem_alloc(text->n, sizeof *t->objects, "sentences", e);
	t->refs = mem_alloc(text->n, sizeof *t->refs, "sentences", e);
	t->object_names = mem_alloc(text->n, sizeof *t->object_names, "sentences", e);
	if (!t->offsets || !t->words || !t->objects || !t->refs || !t->object_names)
		return -1;
	for (size_t r = 0; r < text->n; r++) {
		const int64_t from = offsets[r], count = offsets[r + 1] - from;
		if (text->splits[r] != SPLIT_TRAIN)
			continue;
		if (!count) {
			t->left_out++;
			continue;
		}
		const size_t k = t->sentences++;
		t->refs[k] = text->refs[r];
		t->object_names[k] = text->objects[r];
		memcpy(t->words + (size_t)t->offsets[k] * width, words + (size_t)from * width,
			sizeof(float) * (size_t)count * width);
		t->offsets[k + 1] = t->offsets[k] + count;
	}
	return number_objects(t, e);
}

static uint32_t add_checksum(uint32_t sum, const void *data, size_t bytes)
{
	return (uint32_t)crc32_z(sum, data, bytes);
}

static void make_checksum(struct training *t)
{
	uint32_t sum = 0;

	sum = add_checksum(sum, t->scene.splats.means, sizeof(float) * 3 * t->scene.splats.n);
	sum = add_checksum(
		sum, t->words, sizeof(float) * (size_t)t->offsets[t->sentences] * (size_t)t->width);
	sum = add_checksum(sum, t->offsets, sizeof *t->offsets * (t->sentences + 1));
	sum = add_checksum(sum, t->objects, sizeof *t->objects * t->sentences);
	for (size_t v = 0; v < t->views.n; v++) {
		const struct train_view *view = &t->views.views[v];
		const struct training_view *read = &t->views.read[v];
		sum = (uint32_t)crc32_combine(sum, read->sum, (z_off_t)read->bytes);
		sum = add_checksum(sum, view->sentences, sizeof(int) * (size_t)view->count);
		for (int i = 0; i < view->count; i++)
			sum = add_checksum(sum, view->masks[i], bits_bytes(view->weights.pixels));
	}
	for (size_t o = 0; o < t->lifted.objects; o++) /* all of them with the 0 that ends them */
		sum = add_checksum(sum, t->lifted.names[o], strlen(t->lifted.names[o]) + 1);
	if (t->lifted.objects) {
		const size_t shares = (size_t)t->lifted.indptr[t->lifted.objects];
		sum = add_checksum(sum, t->lifted.indptr, sizeof(int64_t) * (t->lifted.objects + 1));
		sum = add_checksum(sum, t->lifted.index, sizeof(int32_t) * shares);
		sum = add_checksum(sum, t->lifted.share, sizeof(float) * shares);
	}
	t->checksum = sum;
}

/* What a warm start is fitted to. */
static int read_lifted(struct training *t, const struct training_files *from, struct err *e)
{
	struct origin origin;
	SCOPED_BY(names_free) struct names names = {0};
	size_t r;

	if (!from->lifted)
		return 0;
	if (lifted_read(&t->lifted, &origin, from->lifted, e) ||
		scene_check(&t->scene, file_name(from->lifted), t->lifted.gaussians, &origin.scene, e) ||
		names_make(&names, t->lifted.names, sizeof *t->lifted.names, 0, t->lifted.objects, e))
		return -1;
	for (r = 0; r < t->sentences; r++)
		if (names_find(&names, t->object_names[r]) != NAMES_NONE)
			break;
	return r < t->sentences ? 0
				: err_set(e, ERR_FORMAT, "%s: has no object of a training sentence of %s",
					  file_name(from->lifted), file_name(from->text));
}

/* What an object's first mask shows in a view. */
static int lift_view(struct training *t, struct lift_objects *l, size_t v, struct err *e)
{
	const struct camera *c = &t->views.cameras[v];
	const struct train_view *view = &t->views.views[v];
	const size_t n = (size_t)view->count, pixels = view->weights.pixels;
	const struct view_source from = training_views_source(&t->views);
	struct view_matrix w = {.height = c->height, .width = c->width, .gaussians = l->gaussians};
	SCOPED struct mask *shown = mem_zalloc(n, sizeof *shown, "masks", e);
	SCOPED struct lift_mask *masks = mem_alloc(n, sizeof *masks, "masks", e);
	SCOPED uint8_t *bytes = mem_alloc(pixels, 1, "masks", e);
	size_t count = 0;
	int bad = !shown || !masks || !bytes;

	/* An object has the number of its first sentence, and later sentences do not rise. */
	for (size_t k = 0; k < n && !bad; k++) {
		const size_t object = (size_t)t->objects[view->sentences[k]];
		if (count && masks[count - 1].object >= object)
			continue;
		bits_expand(view->masks[k], 0, pixels, bytes);
		bad = rle_encode(&shown[count].rle, bytes, c->height, c->width, e);
		masks[count] = (struct lift_mask){&shown[count], object};
		count += !bad;
	}
	if (!bad && count && !(bad = from.open(from.context, v, &w.rows, e))) {
		bad = lift_objects_view(l, v, &w, masks, count, e);
		from.close(from.context, v);
	}
	while (count)
		rle_free(&shown[--count].rle);
	return bad;
}

/* Hours of training on masks that show no one scene would come to nothing. */
static int check_masks(
	struct training *t, const struct training_files *from, const struct report *to, struct err *e)
{
	SCOPED_BY(lift_objects_free) struct lift_objects l = {0};

	int bad = lift_objects_init(&l, t->scene.splats.n, t->sentences, t->views.n, e);
	for (size_t v = 0; v < t->views.n && !bad; v++)
		bad = lift_view(t, &l, v, e);
	return -(bad || left_out_check(&l, t->sentences, from->masks, from->scene, to, e));
}

static int read_all(struct training *t, const struct training_files *from, const struct trainer_options *o,
	const struct report *to, struct err *e)
{
	if (scene_read(&t->scene, from->scene, e))
		return -1;
	splats_keep_means(&t->scene.splats);
	if (text_read(&t->text, from->text, e) || read_query(t, from->text, o->query, e) ||
		pack_sentences(t, e))
		return -1;
	if (!t->sentences)
		return err_set(e, ERR_FORMAT, "%s: no training sentence with words", file_name(from->text));
	if (training_read_masks(t, from->weights, from->masks, to, e) ||
		masks_check_refs(&t->masks.masks, from->masks, t->text.refs, t->text.objects, t->text.n, e) ||
		supervision_link(
			&t->masks, t->refs, t->object_names, t->sentences, t->views.views, t->views.n, e))
		return -1;
	for (size_t v = 0; v < t->views.n; v++)
		t->pairs += (size_t)t->views.views[v].count;
	if (!t->pairs)
		return err_set(e, ERR_FORMAT,
			"%s: no mask of a training view is of a training sentence of %s",
			file_name(from->masks), file_name(from->text));
	if (check_masks(t, from, to, e) || read_lifted(t, from, e))
		return -1;
	make_checksum(t);
	return 0;
}

int training_read(struct training *t, const struct training_files *from, const struct trainer_options *o,
	const struct report *to, struct err *e)
{
	*t = (struct training){0};
	int bad = read_all(t, from, o, to, e);
	return bad;
}

struct trainer_source training_source(struct training *t, const struct row_views_room *room)
{
	return (struct trainer_source){.means = t->scene.splats.means,
		.cameras = t->views.cameras,
		.scene_gaussians = t->scene.splats.n,
		.text_width = t->width,
		.sentences = t->sentences,
		.offsets = t->offsets,
		.words = t->words,
		.objects = t->objects,
		.views = training_views_source(&t->views),
		.pixels = t->views.pixels,
		.weight = t->views.weight,
		.room = *room,
		.lifted = t->lifted.objects ? &t->lifted : NULL,
		.object_names = t->object_names};
}

/* The scene and the encoder that it is of. */
static struct origin origin_of(const struct training *t)
{
	return (struct origin){t->scene.fingerprint, t->text.encoder};
}

struct checkpoint_of training_identity(
	const struct training *t, const struct training_files *from, const struct trainer_options *o)
{
	struct checkpoint_of of = {
		.origin = origin_of(t), .scene_path = from->scene, .text_path = file_name(from->text)};

	checkpoint_identity(of.identity, o, t->checksum);
	return of;
}

int training_write(const struct training *t, const struct trainer *learned, const struct trainer_options *o,
	enum precision precision, const char *path, const char *options, long long seed, struct err *e)
{
	const float *values = learned->state.values;
	const struct model m = {.layout = learned->layout,
		.similarity = o->similarity,
		.query = o->query,
		.blend = learned->warm_steps && learned->state.iteration <= learned->warm_steps
				 ? REFER_SHARES
				 : REFER_LOGITS,
		.precision = precision,
		.origin = origin_of(t),
		.scene_gaussians = t->scene.splats.n,
		.n = learned->rows.n,
		.has_leaves = learned->octree.n > 0,
		.learning = learned->learning,
		.ids = learned->ids,
		.octree = learned->octree,
		.features = trainer_features(learned, values, e),
		.parameters = (float *)values, /* a model that is read owns them */
		.low = {learned->low[0], learned->low[1], learned->low[2]},
		.high = {learned->high[0], learned->high[1], learned->high[2]}};
	char text[CHECKPOINT_IDENTITY + 64];

	if (!m.features)
		return -1;
	snprintf(text, sizeof text, "--iterations %ld --precision %s %s", learned->state.iteration,
		precision_name(precision), options);
	int bad = model_write(&m, path, text, seed, e);
	free(m.features);
	return bad;
}

void training_free(struct training *t)
{
	if (t->views.views)
		supervision_unlink(t->views.views, t->views.n);
	training_views_free(&t->views);
	supervision_free(&t->masks);
	lifted_free(&t->lifted);
	scene_free(&t->scene);
	text_free(&t->text);
	query_free(&t->query);
	mem_free_all(t->offsets, t->words, t->objects, t->refs, t->object_names);
	*t = (struct training){0};
}
