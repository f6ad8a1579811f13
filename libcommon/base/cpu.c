#define _DEFAULT_SOURCE /* syscall */

#include "base/cpu.h"

#include <stdlib.h>
#include <string.h>

#if defined __x86_64__
#include <cpuid.h>
#include <sys/syscall.h>
#include <unistd.h>

/* Which __builtin_cpu_supports does not know everywhere. */
static int has_half_floats(void)
{
	unsigned a, b, c, d;

	return __get_cpuid(1, &a, &b, &c, &d) && c & bit_F16C;
}
#endif

static enum cpu_level of_machine(void)
{
#if defined __x86_64__
	if (!__builtin_cpu_supports("avx2") || !__builtin_cpu_supports("fma") ||
		!__builtin_cpu_supports("bmi") || !__builtin_cpu_supports("popcnt") || !has_half_floats())
		return CPU_PLAIN;
	if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
		__builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512vl"))
		return CPU_AVX512;
	return CPU_AVX2;
#else
	return CPU_PLAIN;
#endif
}

/* No more than what the environment asks for. */
static enum cpu_level find_level(void)
{
	const char *wanted = getenv("REFERSPLAT_CPU");
	const enum cpu_level most = of_machine();

	if (wanted && !strcmp(wanted, "plain"))
		return CPU_PLAIN;
	return wanted && !strcmp(wanted, "avx2") && most > CPU_AVX2 ? CPU_AVX2 : most;
}

enum cpu_level cpu_level(void)
{
	static int known = -1; /* by atomic operations only */
	int level = __atomic_load_n(&known, __ATOMIC_RELAXED);

	if (level < 0) {
		level = (int)find_level();
		__atomic_store_n(&known, level, __ATOMIC_RELAXED);
	}
	return (enum cpu_level)level;
}

/* AMX with bfloat16, which the system gives to who asks for it, and AVX-512's instructions for that. */
static int find_amx(void)
{
#if defined __x86_64__ && defined __linux__
	enum { ASK = 0x1023, TILES = 18 }; /* ARCH_REQ_XCOMP_PERM, XFEATURE_XTILEDATA */
	unsigned a, b, c, d, more;

	return cpu_level() == CPU_AVX512 && !getenv("REFERSPLAT_CPU") &&
	       __get_cpuid_count(7, 0, &a, &b, &c, &d) && d >> 22 & 1 && d >> 24 & 1 &&
	       __get_cpuid_count(7, 1, &more, &b, &c, &d) && more >> 5 & 1 &&
	       !syscall(SYS_arch_prctl, ASK, TILES);
#else
	return 0;
#endif
}

int cpu_has_amx(void)
{
	static int known = -1; /* by atomic operations only */
	int has = __atomic_load_n(&known, __ATOMIC_RELAXED);

	if (has < 0) {
		has = find_amx();
		__atomic_store_n(&known, has, __ATOMIC_RELAXED);
	}
	return has;
}
