#include "base/scratch.h"

#include "base/temporary.h"

#include <errno.h>
#include <fcntl.h>
#include <unistd.h>

/* It loses its name at once, so that nothing is left even where the process is killed. */
static int make(struct scratch *s, struct err *e)
{
	struct temporary *t;
	const int fd = temporary_make(&t, s->path, s->path, e);

	if (fd < 0)
		return -1;
	temporary_end(t);
	s->fd = fd;
	s->is_open = 1;
	return 0;
}

static int write_all(const struct scratch *s, const struct scratch_piece *piece, size_t at, struct err *e)
{
	const char *data = piece->data;

	for (size_t done = 0; done < piece->bytes;) {
		const ssize_t put = pwrite(s->fd, data + done, piece->bytes - done, (off_t)(at + done));
		if (put < 0 && errno == EINTR)
			continue;
		if (put < 0)
			return err_errno(e, "%s", s->path);
		done += (size_t)put;
	}
	return 0;
}

int scratch_more(struct scratch *s, const void *data, size_t bytes, struct scratch_part *part, struct err *e)
{
	const size_t page = (size_t)sysconf(_SC_PAGESIZE);

	if (write_all(s, &(struct scratch_piece){data, bytes}, part->at + part->bytes, e))
		return -1;
	part->bytes += bytes;
	s->end = part->at + (part->bytes + page - 1) / page * page;
	return 0;
}

int scratch_put(struct scratch *s, const struct scratch_piece *pieces, size_t n, struct scratch_part *part,
	struct err *e)
{
	if (!s->is_open && make(s, e))
		return -1;
	*part = (struct scratch_part){.at = s->end};
	for (size_t k = 0; k < n; k++)
		if (scratch_more(s, pieces[k].data, pieces[k].bytes, part, e))
			return -1;
	return 0;
}

void scratch_ahead(const struct scratch *s, const struct scratch_part *part)
{
	/* where the system does not, the part is read when it is needed */
	(void)posix_fadvise(s->fd, (off_t)part->at, (off_t)part->bytes, POSIX_FADV_WILLNEED);
}

int scratch_map(const struct scratch *s, const struct scratch_part *part, struct file_map *map, struct err *e)
{
	return file_map_part(s->fd, s->path, part->at, part->bytes, map, e);
}

void scratch_close(struct scratch *s)
{
	if (s->is_open)
		close(s->fd);
	*s = (struct scratch){.path = s->path};
}
