#include "cmd/feature/feature_lifting.h"

#include "base/half.h"
#include "base/mem.h"
#include "formats/scene/weights.h"

#include <stdio.h>

#define MEBIBYTE 1048576.0

/* A view's labels become votes. */
static int add_labels(struct feature_lifting *l, struct err *e)
{
	return lift_labels_add(&l->votes, &l->weights, l->sources.label, e);
}

/* A view's features of the block are added. */
static int add_features(struct feature_lifting *l, size_t view, struct err *e)
{
	const size_t n = l->sources.count;
	size_t count;

	if (mem_size(n, l->block, &count))
		return err_set(e, ERR_SYSTEM, "features do not fit in memory");
	if (mem_room((void **)&l->table, &l->table_room, count, sizeof *l->table, "features", e) ||
		mem_room((void **)&l->factor, &l->factor_room, n, sizeof *l->factor, "features", e))
		return -1;
	if (feature_maps_features(&l->maps, &l->sources, l->first, l->block, l->table, l->factor, e)) {
		char of[600];
		snprintf(of, sizeof of, "%s: view '%s'",
			l->options->maps.folder ? l->options->maps.folder : l->options->maps.masks,
			l->scene.cameras.views[view].name);
		return e->code == ERR_FORMAT ? err_prefix(e, of) : -1;
	}
	lift_features_add(&l->features, l->block, &l->weights, l->table, l->factor, !l->first);
	return 0;
}

static int add_view(struct feature_lifting *l, size_t view, const struct weights *w, struct err *e)
{
	const struct view_weights blend = weights_view(w);

	if (feature_maps_view(&l->maps, view, w->height, w->width, &l->sources, e) ||
		source_weights_make(&l->weights, &blend, l->sources.source, l->sources.count, e))
		return -1;
	return l->maps.channels ? add_features(l, view, e) : add_labels(l, e);
}

/* Those that have weights; these are read only where there are features or labels too. */
static int all_views(struct feature_lifting *l, struct err *e)
{
	const struct cameras *c = &l->scene.cameras;
	const char *folder = l->options->weights;
	SCOPED char *has_weights = mem_alloc(c->n, 1, "views", e);
	size_t missing = 0;

	if (!has_weights || weights_mark(folder, c, has_weights, &missing, e))
		return -1;
	for (size_t v = 0; v < c->n; v++) {
		SCOPED_BY(weights_close) struct weights w = {0};
		if (has_weights[v])
			report_step(l->to, (double)++l->done, c->views[v].name);
		if (has_weights[v] && l->maps.is_there[v] &&
			(weights_open(&w, folder, &l->scene, v, e) || add_view(l, v, &w, e)))
			return -1;
	}
	if (missing && !l->first)
		report_warn(l->to, "%s: %zu training views have no weights, and their features do not count",
			folder, missing);
	return 0;
}

/* The block's means into their columns. */
static void take_block(struct feature_lifting *l)
{
	const size_t n = l->scene.splats.n, channels = l->maps.channels, block = l->block;
	float *single = l->values;
	uint16_t *half = l->values;

	lift_features_end(&l->features, block);
#pragma omp parallel for schedule(static)
	for (size_t i = 0; i < n; i++) {
		const float *from = l->features.sum + i * block;
		const size_t at = i * channels + l->first;
		if (l->options->is_single)
			memcpy(single + at, from, block * sizeof *from);
		else
			for (size_t c = 0; c < block; c++)
				half[at + c] = half_of_float(from[c]);
	}
}

/* As many channels as there is memory for. */
static size_t block_width(const struct feature_lifting *l)
{
	const double row = (double)l->scene.splats.n * sizeof(float);
	const double most = (double)l->options->memory * MEBIBYTE / (row > 0 ? row : 1);

	return most >= (double)l->maps.channels ? l->maps.channels : most < 1 ? 1 : (size_t)most;
}

static int lift_features(struct feature_lifting *l, struct err *e)
{
	const size_t n = l->scene.splats.n, channels = l->maps.channels, width = block_width(l);
	const size_t blocks = (channels + width - 1) / width;
	size_t bytes;

	if (mem_size(channels, l->options->is_single ? sizeof(float) : sizeof(uint16_t), &bytes) ||
		!(l->values = mem_alloc(n, bytes, "features", e)) ||
		lift_features_init(&l->features, n, width, e))
		return -1;
	report_start(l->to, "views", (double)(l->scene.cameras.n * blocks));
	for (l->first = 0; l->first < channels; l->first += width) {
		l->block = width < channels - l->first ? width : channels - l->first;
		lift_features_begin(&l->features, l->block);
		if (all_views(l, e))
			return -1;
		take_block(l);
	}
	lift_features_reliability(&l->features, l->reliability);
	for (size_t i = 0; i < n; i++)
		l->weight[i] = (float)l->features.weight[i];
	return 0;
}

static int lift_labels(struct feature_lifting *l, struct err *e)
{
	l->labels = mem_alloc(l->scene.splats.n, sizeof *l->labels, "labels", e);
	if (!l->labels || lift_labels_init(&l->votes, l->scene.splats.n, e))
		return -1;
	report_start(l->to, "views", (double)l->scene.cameras.n);
	if (all_views(l, e))
		return -1;
	lift_labels_end(&l->votes, l->labels, l->reliability, l->weight);
	return 0;
}

/* Gaussians of little reliability become unseen. */
static void prune(struct feature_lifting *l)
{
	const size_t row = l->maps.channels * (l->options->is_single ? sizeof(float) : sizeof(uint16_t));

	for (size_t i = 0; i < l->scene.splats.n; i++) {
		if (!(l->weight[i] > 0))
			continue;
		if ((double)l->reliability[i] >= l->options->prune) {
			l->seen++;
			continue;
		}
		l->pruned++;
		l->reliability[i] = l->weight[i] = 0;
		if (l->labels)
			l->labels[i] = LABEL_NONE;
		else
			memset((char *)l->values + i * row, 0, row);
	}
}

static struct features as_features(const struct feature_lifting *l)
{
	return (struct features){.gaussians = l->scene.splats.n,
		.channels = l->maps.channels,
		.values = l->values,
		.is_half = !l->options->is_single,
		.labels = l->labels,
		.reliability = l->reliability,
		.weight = l->weight,
		.scene = l->scene.fingerprint};
}

int feature_lifting_make(struct feature_lifting *l, const struct feature_lifting_options *options,
	const struct report *to, struct err *e)
{
	l->options = options;
	l->to = to;
	if (scene_read(&l->scene, options->scene, e) ||
		feature_maps_find(&l->maps, &options->maps, &l->scene, to, e))
		return -1;
	l->reliability = mem_alloc(l->scene.splats.n, sizeof *l->reliability, "Gaussians", e);
	l->weight = mem_alloc(l->scene.splats.n, sizeof *l->weight, "Gaussians", e);
	if (!l->reliability || !l->weight)
		return -1;
	const int bad = l->maps.channels ? lift_features(l, e) : lift_labels(l, e);
	report_end(to);
	if (bad)
		return -1;
	prune(l);
	return 0;
}

int feature_lifting_write(const struct feature_lifting *l, const char *path, struct err *e)
{
	const struct feature_lifting_options *o = l->options;
	const struct features f = as_features(l);
	char options[128];
	int used = snprintf(options, sizeof options, "--prune %.15g", o->prune);

	if (l->maps.kind == MAPS_SEGMENTS)
		used += snprintf(
			options + used, sizeof options - (size_t)used, " --level %lld", o->maps.level);
	if (l->maps.channels)
		snprintf(options + used, sizeof options - (size_t)used, " --precision %s --uncovered %s",
			o->is_single ? "f32" : "f16", o->maps.is_zero ? "zero" : "skip");
	return features_write(&f, path, options, e);
}

void feature_lifting_free(struct feature_lifting *l)
{
	scene_free(&l->scene);
	feature_maps_free(&l->maps);
	mem_free_all(l->values, l->labels, l->reliability, l->weight);
	feature_sources_free(&l->sources);
	source_weights_free(&l->weights);
	lift_features_free(&l->features);
	lift_labels_free(&l->votes);
	mem_free_all(l->table, l->factor);
}
