#include "cli/stop.h"

#include <stddef.h>

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
