/* What a synthetic benchmark has besides where its scene moves: frames, cameras with times, sentences of
 * motion. */
#include "cmd/synth/benchmark.h"

#include "base/mem.h"
#include "formats/splats/ply.h"

static void put_transforms(FILE *out, const void *folder)
{
	const struct synth_folder *f = folder;
	const struct cameras *c = &f->scene->cameras;
	const char *comma = "";

	fprintf(out,
		"{\"w\":%d,\"h\":%d,\"fl_x\":%.17g,\"fl_y\":%.17g,\"cx\":%.17g,\"cy\":%.17g,\"frames\":[",
		c->views[0].width, c->views[0].height, c->views[0].fx, c->views[0].fy, c->views[0].cx,
		c->views[0].cy);
	for (size_t i = 0; i < c->n; i++) {
		const struct camera *v = &c->views[i];
		double at[3];
		camera_centre(v, at);
		fprintf(out, "%s\n{\"file_path\":\"images/%s.png\",\"time\":%.17g,\"transform_matrix\":[",
			i ? "," : "", v->name, v->time);
		for (int r = 0; r < 3; r++)
			fprintf(out, "[%.17g,%.17g,%.17g,%.17g],", v->world_to_camera[0][r],
				-v->world_to_camera[1][r], -v->world_to_camera[2][r], at[r]);
		fputs("[0,0,0,1]]}", out);
	}
	fputs("],\n\"test_filenames\":[", out);
	for (size_t i = 0; i < c->n; i++)
		if (c->views[i].split == SPLIT_TEST) {
			fprintf(out, "%s\"images/%s.png\"", comma, c->views[i].name);
			comma = ",";
		}
	fputs("]}\n", out);
}

static void put_said(FILE *out, const struct synth_folder *f, const struct synth_moving_sentences *said)
{
	for (size_t i = 0; i < said->n; i++) {
		const struct synth_moving_sentence *x = &said->items[i];
		const char *kind = !x->objects	   ? "motion-absent"
				   : x->is_several ? "motion-several"
						   : synth_motion_name(x->kind);
		char ref[64];
		snprintf(ref, sizeof ref, "%s-%zu", kind, i + 1);
		synth_put_sentence(out, f, ref, x->objects, x->text, kind);
		if (x->objects && !x->is_several)
			fprintf(out, ",\"when\":[%.17g,%.17g]", synth_moves_time(f->moves->times, x->first),
				synth_moves_time(f->moves->times, x->last));
		fputs("}\n", out);
	}
}

static void put_moving(FILE *out, const void *folder)
{
	put_said(out, folder, ((const struct synth_folder *)folder)->moving);
}

static void put_moving_kept(FILE *out, const void *folder)
{
	put_said(out, folder, ((const struct synth_folder *)folder)->moving + 1);
}

int synth_moving_write(const struct synth_folder *f, struct err *e)
{
	static const double offset[3] = {0};
	SCOPED char *frames = file_join(f->dir, "frames", "", e);
	char name[32];

	if (!frames || (f->moves->times > 1 && file_make_dir(frames, e)))
		return -1;
	for (int t = 0; t < f->moves->times && f->moves->times > 1; t++) {
		snprintf(name, sizeof name, "time_%05d.ply", t);
		SCOPED char *path = file_join(frames, name, "", e);
		synth_moves_set(f->moves, t);
		if (!path || ply_write(&f->scene->splats, offset, path, e))
			return -1;
	}
	return -(synth_put_file(f, "transforms.json", put_transforms, e) ||
		 synth_put_file(f, "moving.jsonl", put_moving, e) ||
		 synth_put_file(f, "moving-kept-back.jsonl", put_moving_kept, e));
}
