#include "cli/signals.h"

#include "base/err.h"
#include "base/file.h"
#include "base/temporary.h"

#include <signal.h>
#include <string.h>
#include <unistd.h>

static const char *tool_name;

/* The signal's own action is in place again, and ends the process with the status that belongs to it. */
static void end_by_signal(int number)
{
	temporary_remove_all();
	raise(number);
}

static void say(const char *text)
{
	size_t n = strlen(text);

	while (n) {
		const ssize_t put = write(STDERR_FILENO, text, n);
		if (put <= 0)
			return;
		text += put;
		n -= (size_t)put;
	}
}

/* A page of a mapped file that cannot be read is an error like others. The first thread ends the process. */
static void on_bus_error(int number, siginfo_t *info, void *context)
{
	static int is_ending;
	const char *name = file_at(info->si_addr);

	(void)context;
	if (!name) {
		signal(number, SIG_DFL);
		end_by_signal(number);
		return;
	}
	while (__atomic_exchange_n(&is_ending, 1, __ATOMIC_SEQ_CST))
		pause();
	temporary_remove_all();
	say(tool_name);
	say(": ");
	say(name);
	say(": it cannot be read, or was cut short meanwhile\n");
	_exit(ERR_SYSTEM);
}

void signals_catch(const char *tool)
{
	static const int numbers[] = {SIGABRT, SIGALRM, SIGBUS, SIGFPE, SIGHUP, SIGILL, SIGINT, SIGPIPE,
		SIGPROF, SIGQUIT, SIGSEGV, SIGSYS, SIGTERM, SIGTRAP, SIGUSR1, SIGUSR2, SIGVTALRM, SIGXCPU};
	struct sigaction was, own = {.sa_handler = end_by_signal, .sa_flags = SA_RESETHAND | SA_NODEFER};

	tool_name = tool;
	sigemptyset(&own.sa_mask);
	for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++)
		if (!sigaction(numbers[i], NULL, &was) && was.sa_handler == SIG_DFL)
			sigaction(numbers[i], &own, NULL);
	if (!sigaction(SIGBUS, NULL, &was) && was.sa_handler == end_by_signal) {
		own.sa_sigaction = on_bus_error;
		own.sa_flags = SA_SIGINFO | SA_NODEFER;
		sigaction(SIGBUS, &own, NULL);
	}
	signal(SIGXFSZ, SIG_IGN);
}

static volatile sig_atomic_t caught;
static struct sigaction before[2];
static const int numbers[2] = {SIGINT, SIGTERM};

static void note(int number)
{
	caught = number;
	for (int i = 0; i < 2; i++)
		sigaction(numbers[i], &before[i], NULL);
}

const volatile sig_atomic_t *cli_stop_catch(void)
{
	struct sigaction own = {.sa_handler = note, .sa_flags = SA_RESTART};

	sigemptyset(&own.sa_mask);
	sigaddset(&own.sa_mask, SIGINT);
	sigaddset(&own.sa_mask, SIGTERM);
	for (int i = 0; i < 2; i++)
		if (!sigaction(numbers[i], NULL, &before[i]) && before[i].sa_handler != SIG_IGN)
			sigaction(numbers[i], &own, NULL);
	return &caught;
}

void cli_stop_end(void)
{
	if (caught)
		raise(caught);
}
