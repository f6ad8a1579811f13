/* Which of the instruction sets that the vector kernels are built for this machine has. */
#pragma once

enum cpu_level {
	CPU_PLAIN,  /* whatever the compiler assumes: SSE2 on x86-64 */
	CPU_AVX2,   /* AVX2, FMA, F16C, BMI and POPCNT */
	CPU_AVX512, /* AVX-512 F, DQ, BW and VL as well */
	CPU_LEVELS
};

/* The most that this machine has or, with REFERSPLAT_CPU=plain, =avx2 or =avx512 in the environment of the
 * process, no more than that: to compare the kernels. */
enum cpu_level cpu_level(void);

/* Whether it may use AMX's products of bfloat16 besides. */
int cpu_has_amx(void);
