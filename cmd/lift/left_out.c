#include "cmd/lift/left_out.h"

#include "base/file.h"
#include "formats/cameras/dataparser.h"

int left_out_check(struct lift_objects *l, size_t named, const char *masks, const char *scene,
	const struct report *to, struct err *e)
{
	size_t n;
	double fit;

	if (lift_left_out(l, named, &fit, &n, e))
		return -1;
	report_note(to, 2, "each of %zu masks is by %.2f what those of other views lifted", n, fit);
	if (!(fit < LIFT_LEFT_OUT_FINE))
		return 0;
	err_set(e, ERR_FORMAT,
		"%s: what masks show in one view is not where those of other views show it (by %.2f, at least %.2g is right): are they of other views, or of turned photographs, or are the cameras of %s in another frame than its splats? " DATAPARSER_WAY_OUT,
		file_name(masks), fit, LIFT_LEFT_OUT_FINE, scene);
	if (fit < (n < LIFT_LEFT_OUT_SURE ? LIFT_LEFT_OUT_FEW_LEAST : LIFT_LEFT_OUT_LEAST))
		return -1;
	report_warn(to, "%s", e->message);
	return 0;
}
