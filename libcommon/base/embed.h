/* Files that are part of the program. */
#pragma once

/* Puts a file's bytes between name_begin and name_end, both to be declared: extern const unsigned char
 * name_begin[], name_end[]. A 0 follows. The file is named from where the compiler runs. */
#define EMBED(name, file)                                                                                    \
	__asm__(".section .rodata\n"                                                                         \
		".balign 64\n"                                                                               \
		".globl " #name "_begin\n.hidden " #name "_begin\n" #name "_begin:\n"                        \
		".incbin \"" file "\"\n"                                                                     \
		".globl " #name "_end\n.hidden " #name "_end\n" #name "_end:\n"                              \
		".byte 0\n"                                                                                  \
		".previous\n")
