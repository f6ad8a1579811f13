#include "formats/encoders/pretrained.h"

#include "base/file.h"
#include "base/half.h"
#include "base/mem.h"
#include "formats/records/json.h"

#include <dirent.h>
#include <math.h>
#include <stdio.h>

int pretrained_int(
	const cJSON *config, const char *key, int max, int usual, int *out, const char *path, struct err *e)
{
	const cJSON *item = json_get(config, key);
	double v = cJSON_IsNumber(item) ? item->valuedouble : item ? 0 : usual;

	if (!(v >= 1 && v <= max) || v != floor(v))
		return err_file(e, path, "key '%s' is not a whole number from 1 to %d", key, max);
	*out = (int)v;
	return 0;
}

int pretrained_is(const cJSON *config, const char *key, const char *wanted, const char *path, struct err *e)
{
	const cJSON *item = json_get(config, key);

	if (!item || json_is(item, wanted))
		return 0;
	return err_file(e, path, "key '%s' is not \"%s\"", key, wanted);
}

int pretrained_activation(const cJSON *config, const struct pretrained_activation *known, size_t n,
	const char *list, const char *usual, enum transformer_activation *out, const char *path,
	struct err *e)
{
	const cJSON *item = json_get(config, "hidden_act");
	const char *name = cJSON_IsString(item) ? item->valuestring : !item && usual ? usual : "";

	for (size_t i = 0; i < n; i++)
		if (!strcmp(known[i].name, name)) {
			*out = known[i].activation;
			return 0;
		}
	return err_file(e, path, "key 'hidden_act' is '%s', not %s", name, list);
}

int pretrained_eps(const cJSON *config, double usual, double *out, const char *path, struct err *e)
{
	const cJSON *eps = json_get(config, "layer_norm_eps");

	*out = eps ? eps->valuedouble : usual;
	if ((eps && !cJSON_IsNumber(eps)) || !(*out >= 0 && *out <= 1))
		return err_file(e, path, "key 'layer_norm_eps' is not a number from 0 to 1");
	return 0;
}

int pretrained_sizes(const struct transformer *t, int positions, const char *const names[3], const char *path,
	struct err *e)
{
	if (t->width % t->heads)
		return err_file(
			e, path, "%s %d is not a multiple of %s %d", names[0], t->width, names[1], t->heads);
	if (positions < 3)
		return err_file(e, path, "%s %d leaves no room for words", names[2], positions);
	return 0;
}

/* The path of the weights: DIR/model.safetensors or the only *.safetensors. NULL with *e set. */
static char *find_weights(const char *dir, struct err *e)
{
	static const char ending[] = ".safetensors";
	char *path = file_join(dir, "model.safetensors", "", e), *only = NULL;
	size_t count = 0;
	struct dirent *entry;

	if (!path || file_exists(path))
		return path;
	free(path);
	DIR *list = opendir(dir);
	if (!list) {
		err_errno(e, "%s", dir);
		return NULL;
	}
	while ((entry = readdir(list))) {
		size_t len = strlen(entry->d_name);
		if (len < sizeof ending || strcmp(entry->d_name + len - (sizeof ending - 1), ending) ||
			count++)
			continue;
		only = file_join(dir, entry->d_name, "", e);
		if (!only)
			break;
	}
	closedir(list);
	if (count == 1)
		return only;
	free(only);
	if (count)
		err_file(e, dir, "has %zu *.safetensors files and none is model.safetensors", count);
	else
		err_set(e, ERR_SYSTEM, "%s: has no *.safetensors file", dir);
	return NULL;
}

int pretrained_open(struct safetensors *st, const char *dir, const char *first, struct err *e)
{
	SCOPED char *path = first ? file_join(dir, first, "", e) : NULL;

	if (!path || !file_exists(path)) {
		free(path);
		path = find_weights(dir, e);
	}
	return !path || safetensors_open(st, path, e) ? -1 : 0;
}

const struct st_tensor *pretrained_need(
	const struct safetensors *st, const char *name, int rows, int columns, struct err *e)
{
	const int64_t shape[2] = {rows, columns};
	const struct st_tensor *t = safetensors_find(st, name);
	const int is_other = t && (t->dtype == ST_F16 || t->dtype == ST_BF16 || t->dtype == ST_F64);

	return safetensors_need(
		st, name, is_other ? t->dtype : ST_F32, rows ? 2 : 1, rows ? shape : shape + 1, e);
}

/* count numbers of the tensor from place `first` on. */
static int load(
	const struct pretrained *from, const struct st_tensor *t, size_t first, size_t count, float *out)
{
	struct st_tensor part = *t;

	if (!out)
		return 0;
	part.data = (const char *)t->data + first * st_dtype_size(t->dtype);
	part.bytes = count * st_dtype_size(t->dtype);
	if (safetensors_to_float(&part, out, count, from->e))
		return -1;
	for (size_t i = 0; i < count; i++)
		if (!isfinite(out[i]))
			return err_file(from->e, from->st.path, "tensor '%s': item %zu is not finite",
				t->name, first + i);
	return 0;
}

enum { NAME = 256 };

/* The tensor `at``name``part`, (of,columns), or (of) where columns is 0. */
static const struct st_tensor *find_part(
	struct pretrained *from, const char *at, const char *name, const char *part, int of, int columns)
{
	char full[NAME];

	snprintf(full, sizeof full, "%s%s%s%s", from->prefix, at, name, part);
	return pretrained_need(&from->st, full, columns ? of : 0, columns ? columns : of, from->e);
}

/* Its next `rows` from `first` on. */
static int load_part(struct pretrained *from, const char *at, const char *name, const char *part, float *out,
	int of, int first, int rows, int columns)
{
	const size_t each = columns ? (size_t)columns : 1;
	const struct st_tensor *t = find_part(from, at, name, part, of, columns);

	return t ? load(from, t, (size_t)first * each, (size_t)rows * each, out) : -1;
}

/* The same of weights, of which half floats stay where they are. */
static int load_weight(struct pretrained *from, const char *at, const char *name, const char *part,
	struct linear_weight *w, int of, int first, int rows, int columns)
{
	const size_t skip = (size_t)first * (size_t)columns, count = (size_t)rows * (size_t)columns;
	const struct st_tensor *t = find_part(from, at, name, part, of, columns);

	if (!t || w->halves)
		return t ? 0 : -1;
	if (t->dtype != ST_F16)
		return load(from, t, skip, count, (float *)(size_t)w->floats);
	w->halves = (const char *)t->data + skip * sizeof(uint16_t);
	const size_t finite = half_count_finite(w->halves, count);
	return finite == count ? 0
			       : err_file(from->e, from->st.path, "tensor '%s': item %zu is not finite",
					 t->name, skip + finite);
}

int pretrained_load(struct pretrained *from, const char *name, float *out, int rows, int columns)
{
	return rows ? load_part(from, "", name, "", out, rows, 0, rows, columns)
		    : load_part(from, "", name, "", out, columns, 0, columns, 0);
}

static int load_linear(struct pretrained *from, const char *at, const char *name,
	struct transformer_linear *l, int in, int out)
{
	return -(load_weight(from, at, name, ".weight", &l->weight, out, 0, out, in) ||
		 load_part(from, at, name, ".bias", l->bias, out, 0, out, 0));
}

static int load_norm(struct pretrained *from, const char *at, const char *name,
	const struct transformer_norm *n, int width)
{
	return -(load_part(from, at, name, from->scale, n->scale, width, 0, width, 0) ||
		 load_part(from, at, name, from->shift, n->shift, width, 0, width, 0));
}

/* Query, key and value: thirds of a tensor, or three. */
static int load_attention(struct pretrained *from, const char *at, struct transformer_layer *l, int width)
{
	struct transformer_linear *const parts[] = {&l->query, &l->key, &l->value};
	const char *const *names = from->names->attention;
	int bad = 0;

	for (int i = 0; i < 3 && !bad; i++)
		if (names[2])
			bad = load_linear(from, at, names[i], parts[i], width, width);
		else
			bad = load_weight(from, at, names[0], "", &parts[i]->weight, 3 * width, i * width,
				      width, width) ||
			      load_part(
				      from, at, names[1], "", parts[i]->bias, 3 * width, i * width, width, 0);
	return bad;
}

static int load_layer(struct pretrained *from, const struct text_tower *t, int i)
{
	struct transformer_layer *l = &t->body.layers[i];
	const struct pretrained_names *n = from->names;
	const int width = t->body.width, inner = t->body.inner;
	char at[64];

	snprintf(at, sizeof at, "%s%d.", n->layer, i);
	const int is_first = t->body.is_norm_first;
	return -((is_first && load_norm(from, at, n->attention_norm, &l->attention_norm, width)) ||
		 load_attention(from, at, l, width) ||
		 load_linear(from, at, n->attention_out, &l->attention_out, width, width) ||
		 (!is_first && load_norm(from, at, n->attention_norm, &l->attention_norm, width)) ||
		 load_linear(from, at, n->inner, &l->inner, width, inner) ||
		 load_linear(from, at, n->outer, &l->outer, inner, width) ||
		 load_norm(from, at, n->feed_norm, &l->norm, width));
}

int pretrained_tower(struct pretrained *from, struct text_tower *t)
{
	const struct pretrained_names *n = from->names;
	const int width = t->body.width;

	if (load_weight(from, "", n->word, "", &t->word, t->words, 0, t->words, width) ||
		pretrained_load(from, n->position, t->position, t->positions, width) ||
		(n->type && pretrained_load(from, n->type, t->type, t->types, width)) ||
		load_norm(from, "", n->norm, &t->norm, width))
		return -1;
	for (int i = 0; i < t->body.layer_count; i++)
		if (load_layer(from, t, i))
			return -1;
	return 0;
}

static void close_map(void *map)
{
	file_unmap(map);
	free(map);
}

int pretrained_close(struct pretrained *from, struct text_tower *t)
{
	struct file_map *map = mem_alloc(1, sizeof *map, "encoder", from->e);

	if (map) {
		*map = from->st.map;
		from->st.is_borrowed = 1;
		t->file = map;
		t->close = close_map;
	}
	safetensors_close(&from->st);
	return map ? 0 : -1;
}
