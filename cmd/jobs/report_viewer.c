#include "cmd/jobs/report_viewer.h"

int report_viewer_put(FILE *out, const struct report_run *r, const struct report *to, struct err *e)
{
	(void)out, (void)r, (void)to, (void)e;
	return 0;
}
