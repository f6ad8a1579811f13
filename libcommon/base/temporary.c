/* The list of temporary files can be read by a signal's handler at any time, on any thread: entries are never
 * taken out of it, only marked as free. While a file is made, renamed or removed its entry is busy and its
 * thread takes no signals, so a handler that waits until no entry is busy knows all files. */
#include "base/temporary.h"

#include "base/mem.h"

#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <poll.h>
#include <pthread.h>
#include <signal.h>
#include <stdio.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

enum state { FREE, TAKEN, BUSY, NAMED };

enum {
	NUMBERS = 10000, /* runs that write one output at a time */
	GAP = 4,	 /* numbers without a file after which no leftover is looked for */
	PATIENCE = 1000, /* milliseconds that a handler waits for a busy entry: a file server may hang */
};

struct temporary {
	struct temporary *next;
	int state; /* by atomic operations only */
	int is_shared;
	char name[PATH_MAX];
};

static struct temporary *first; /* by atomic operations only, as is_ending */
static int is_ending;

static int get_state(const struct temporary *t)
{
	return __atomic_load_n(&t->state, __ATOMIC_SEQ_CST);
}

static void set_state(struct temporary *t, enum state state)
{
	__atomic_store_n(&t->state, (int)state, __ATOMIC_SEQ_CST);
}

/* Marks an entry as busy. Where the process is about to end, the thread waits for that. */
static void enter(struct temporary *t, sigset_t *signals)
{
	const int was = get_state(t);
	sigset_t all;

	sigfillset(&all);
	pthread_sigmask(SIG_BLOCK, &all, signals);
	set_state(t, BUSY);
	if (!__atomic_load_n(&is_ending, __ATOMIC_SEQ_CST))
		return;
	set_state(t, (enum state)was);
	for (;;)
		pause();
}

static void leave(struct temporary *t, enum state state, const sigset_t *signals)
{
	set_state(t, state);
	pthread_sigmask(SIG_SETMASK, signals, NULL);
}

/* A free entry, else a new one. */
static struct temporary *take(struct err *e)
{
	struct temporary *t = __atomic_load_n(&first, __ATOMIC_SEQ_CST);

	for (; t; t = t->next) {
		int is_free = FREE;
		if (__atomic_compare_exchange_n(
			    &t->state, &is_free, TAKEN, 0, __ATOMIC_SEQ_CST, __ATOMIC_SEQ_CST))
			return t;
	}
	t = mem_zalloc(1, sizeof *t, "temporary file", e);
	if (!t)
		return NULL;
	t->state = TAKEN;
	t->next = __atomic_load_n(&first, __ATOMIC_SEQ_CST);
	while (!__atomic_compare_exchange_n(&first, &t->next, t, 0, __ATOMIC_SEQ_CST, __ATOMIC_SEQ_CST))
		;
	return t;
}

/* 1 where the open file is the one of that name. */
static int is_at(int fd, const char *name)
{
	struct stat own, named;

	return !fstat(fd, &own) && !lstat(name, &named) && own.st_dev == named.st_dev &&
	       own.st_ino == named.st_ino;
}

/* Removes a file that no run has locked: 1 where it is gone, 0 where it stays, -1 where there was none.
 * *is_locked gets 1 where a run has. */
static int remove_leftover(const char *name, int *is_locked)
{
	int fd = open(name, O_RDWR | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC), is_gone = 0;
	struct stat st;

	if (fd < 0)
		return errno == ENOENT ? -1 : 0;
	if (!fstat(fd, &st) && S_ISREG(st.st_mode)) {
		if (!flock(fd, LOCK_EX | LOCK_NB))
			is_gone = !is_at(fd, name) || !unlink(name);
		else
			*is_locked |= errno == EWOULDBLOCK;
	}
	close(fd);
	return is_gone;
}

/* Makes and locks the file of that name, or -1 with errno: EEXIST where it is a living run's. A file system
 * without locks makes no difference but that leftovers stay. */
static int make_locked(const char *name, int *is_shared)
{
	for (;;) {
		int fd = open(name, O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0600);
		if (fd >= 0) {
			(void)flock(fd, LOCK_EX);
			if (is_at(fd, name))
				return fd;
			close(fd); /* another run took it for a leftover before it was locked */
		} else if (errno != EEXIST) {
			return -1;
		} else if (!remove_leftover(name, is_shared)) {
			errno = EEXIST;
			return -1;
		}
	}
}

static int set_name(char name[PATH_MAX], const char *path, int number)
{
	return snprintf(name, PATH_MAX, "%s.tmp.refersplat%d", path, number) < PATH_MAX ? 0 : -1;
}

static void remove_leftovers(const char *path, int from)
{
	char name[PATH_MAX];
	int is_locked = 0;

	for (int i = from, end = from + GAP; i < end && !set_name(name, path, i); i++)
		if (remove_leftover(name, &is_locked) >= 0)
			end = i + 1 + GAP;
}

/* The descriptor, or -1 with errno. */
static int make_numbered(struct temporary *t, const char *path)
{
	t->is_shared = 0;
	for (int i = 0; i < NUMBERS; i++) {
		if (set_name(t->name, path, i)) {
			errno = ENAMETOOLONG;
			return -1;
		}
		int fd = make_locked(t->name, &t->is_shared);
		if (fd >= 0)
			remove_leftovers(path, i + 1);
		if (fd >= 0 || errno != EEXIST)
			return fd;
	}
	return -1;
}

int temporary_make(struct temporary **t, const char *path, const char *called, struct err *e)
{
	sigset_t signals;

	*t = take(e);
	if (!*t)
		return -1;
	enter(*t, &signals);
	int fd = make_numbered(*t, path), why = errno;
	leave(*t, fd < 0 ? FREE : NAMED, &signals);
	if (fd >= 0)
		return fd;
	*t = NULL;
	errno = why;
	return err_errno(e, "%s", called);
}

int temporary_is_shared(const struct temporary *t)
{
	return t->is_shared;
}

int temporary_rename(struct temporary *t, const char *path)
{
	sigset_t signals;

	enter(t, &signals);
	int bad = rename(t->name, path), why = errno;
	leave(t, bad ? NAMED : TAKEN, &signals);
	errno = why;
	return bad;
}

void temporary_end(struct temporary *t)
{
	sigset_t signals;

	if (!t)
		return;
	const int is_there = get_state(t) == NAMED;
	enter(t, &signals);
	if (is_there)
		unlink(t->name);
	leave(t, FREE, &signals);
}

void temporary_remove_all(void)
{
	__atomic_store_n(&is_ending, 1, __ATOMIC_SEQ_CST);
	for (struct temporary *t = __atomic_load_n(&first, __ATOMIC_SEQ_CST); t; t = t->next) {
		for (int i = 0; i < PATIENCE && get_state(t) == BUSY; i++)
			poll(NULL, 0, 1);
		if (get_state(t) == NAMED)
			unlink(t->name);
	}
}
