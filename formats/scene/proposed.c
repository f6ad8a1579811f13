#include "formats/scene/proposed.h"

#include "base/mem.h"
#include "formats/arrays/arrays_in.h"
#include "formats/arrays/arrays_out.h"

enum { VERSION_READ = 2 };

void regions_file_free(struct regions_file *r)
{
	region_tree_free(&r->tree);
	mem_free_strings(r->classes, r->class_count);
	mem_free_all(r->score, r->chosen, r->votes);
	*r = (struct regions_file){0};
}

/* Nodes stand with their subtrees: a node's parent is the node before it or one of those above that. */
static int check_tree(const struct region_tree *t, const char *path, struct err *e)
{
	for (int32_t i = 0; i < t->n; i++) {
		int32_t above = i - 1;
		while (above >= 0 && above > t->parent[i])
			above = t->parent[above];
		if (t->parent[i] != above)
			return err_file(e, path,
				"tensor 'parent': node %d is not below the one before it or one above that",
				i);
	}
	for (size_t i = 0; i < t->gaussians; i++)
		if (t->node[i] < -1 || t->node[i] >= t->n)
			return err_file(
				e, path, "tensor 'node': item %zu is %d, of %d nodes", i, t->node[i], t->n);
	return 0;
}

/* Which regions are likely things, and what they may be. */
static void read_chosen(struct regions_file *r, struct arrays_in *in)
{
	size_t rows;

	r->chosen = arrays_in_vector(in, "chosen", ST_I32, -1, &r->chosen_count);
	for (size_t k = 0; k < r->chosen_count && !in->bad; k++)
		if (r->chosen[k] < 0 || r->chosen[k] >= r->tree.n)
			in->bad = err_file(in->e, in->st->path,
				"tensor 'chosen': item %zu is %d, of %d nodes", k, r->chosen[k], r->tree.n);
	if (in->bad || !safetensors_meta(in->st, "classes"))
		return;
	const int classes = arrays_in_width(in, "votes", ST_F32, &rows);
	r->votes = arrays_in_floats(in, "votes", r->chosen_count, classes);
	r->classes = arrays_in_list(in, "classes", (size_t)classes, "columns of 'votes'");
	r->class_count = r->classes ? (size_t)classes : 0;
	arrays_in_check_names(in, r->classes, r->class_count, 0, "classes");
	arrays_in_check_unique(in, r->classes, r->class_count, "classes");
}

int regions_file_read(struct regions_file *r, const char *path, struct err *e)
{
	SCOPED_BY(safetensors_close) struct safetensors st = {0};
	struct arrays_in in;
	size_t nodes;

	*r = (struct regions_file){0};
	if (safetensors_open(&st, path, e))
		return -1;
	arrays_in_begin(&in, &st, "refer.regions", VERSION_READ, e);
	in.bad = in.bad || fingerprint_read(&r->scene, &st, "scene", e);
	r->tree.parent = arrays_in_vector(&in, "parent", ST_I32, -1, &nodes);
	r->tree.node = arrays_in_vector(&in, "node", ST_I32, -1, &r->tree.gaussians);
	r->score = in.bad ? NULL : mem_alloc(nodes, sizeof *r->score, "regions", e);
	r->tree.end = in.bad ? NULL : mem_alloc(nodes, sizeof *r->tree.end, "regions", e);
	in.bad = in.bad || !r->score || !r->tree.end;
	if (!in.bad)
		arrays_in_fill(&in, "score", r->score, nodes);
	r->tree.n = in.bad ? 0 : (int32_t)nodes;
	read_chosen(r, &in);
	if (in.bad || check_tree(&r->tree, st.path, e))
		return -1;
	region_tree_span(&r->tree);
	return 0;
}

int regions_file_write(const struct regions_file *r, const char *path, const char *options, struct err *e)
{
	struct arrays_out out;

	arrays_out_begin(&out, path, "refer.regions", "2", "pseudomask-propose", options, 0, e);
	arrays_out_text(&out, "scene", fingerprint_text(&r->scene));
	arrays_out_put(&out, st_vector("parent", ST_I32, r->tree.n, r->tree.parent));
	arrays_out_put(&out, st_vector("score", ST_F32, r->tree.n, r->score));
	arrays_out_list(&out, "classes", r->class_count ? r->classes : NULL, r->class_count);
	arrays_out_put(&out, st_vector("chosen", ST_I32, (int64_t)r->chosen_count, r->chosen));
	if (r->class_count)
		arrays_out_put(&out, st_matrix("votes", ST_F32, (int64_t)r->chosen_count,
					     (int64_t)r->class_count, r->votes));
	arrays_out_put(&out, st_vector("node", ST_I32, (int64_t)r->tree.gaussians, r->tree.node));
	return arrays_out_end(&out);
}
