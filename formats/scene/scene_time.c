/* A scene's splats at one time: means and rotations of their own, and the rest the scene's. */
#include "base/mem.h"
#include "formats/scene/scene.h"

static float *copy(const float *from, size_t n, struct err *e)
{
	float *to = mem_alloc(n, sizeof *to, "splats", e);

	return to ? memcpy(to, from, n * sizeof *to) : NULL;
}

static int need_time(const struct scene *s, const struct camera *view, struct err *e)
{
	return view->has_time
		       ? 0
		       : err_set(e, ERR_FORMAT,
				 "%s: the scene moves, and view '%s' has no time: gs-import takes it from the key 'time' of a camera, or one for all with --time",
				 s->path, view->name);
}

int scene_splats_at(struct splats *to, const struct scene *s, const struct camera *view, struct err *e)
{
	const struct splats *from = &s->splats;

	*to = *from;
	if (!s->motion.times)
		return 0;
	if (need_time(s, view, e))
		return -1;
	to->means = copy(from->means, 3 * from->n, e);
	to->quats = to->means ? copy(from->quats, 4 * from->n, e) : NULL;
	if (to->quats && s->motion.scales)
		to->scales = copy(from->scales, 3 * from->n, e);
	if (to->means && to->quats && to->scales && !motion_set(&s->motion, view->time, to, e))
		return 0;
	scene_splats_release(to, s);
	return -1;
}

void scene_splats_release(struct splats *at, const struct scene *s)
{
	float *const own[] = {at->means, at->quats, at->scales}, *const others[] = {s->splats.means,
									 s->splats.quats, s->splats.scales};

	for (int k = 0; k < 3; k++)
		if (own[k] != others[k])
			free(own[k]);
	*at = (struct splats){0};
}

int scene_splats_shown(struct splats *to, const struct scene *s, const struct camera *view, struct err *e)
{
	*to = s->splats;
	return view->has_time ? scene_splats_at(to, s, view, e) : 0;
}

struct render_view *scene_prepare(const struct scene *s, const struct camera *view, struct err *e)
{
	struct splats shown;

	if (scene_splats_shown(&shown, s, view, e))
		return NULL;
	struct render_view *v = render_prepare(&shown, view, e);
	scene_splats_release(&shown, s);
	return v;
}

int scene_move(struct scene *s, const double *t, struct err *e)
{
	if (!t)
		return 0;
	if (!s->motion.times)
		return err_set(e, ERR_USAGE, "--time: %s is still: it has no motion.safetensors", s->path);
	return motion_set(&s->motion, *t, &s->splats, e);
}

int scene_move_to_view(struct scene *s, const struct camera *view, struct err *e)
{
	return need_time(s, view, e) || motion_set(&s->motion, view->time, &s->splats, e) ? -1 : 0;
}
