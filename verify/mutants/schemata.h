/* SPDX-License-Identifier: GPL-3.0-or-later
 * Included before every source of a tree that generate.py has rewritten. Switches one of its
 * mutants on if the environment has SPHPROOF_MUTANT=NUMBER. If SPHPROOF_REACH names a file, no
 * mutant is switched on; instead the file gets one byte for each mutant: whether a process executed
 * it (1) and whether the mutant would have computed another value there (2). */
#pragma once

/* No headers are included here, because a source may define feature macros before it includes them;
 * and functions have names of their own, because headers give some of them other symbols.
 */
char *getenv(const char *name);
int atoi(const char *text);
int sphproof_open(const char *name, int flags, ...) __asm__("open");
int sphproof_close(int file) __asm__("close");
long sphproof_lseek(int file, long offset, int whence) __asm__("lseek");
void *sphproof_mmap(void *at, unsigned long size, int protection, int flags, int file,
                    long offset) __asm__("mmap");

#define SCHEMATA_GLOBAL __attribute__((weak, visibility("hidden")))

SCHEMATA_GLOBAL int sphproof_mutant; /* -1: records which mutants are reached */
SCHEMATA_GLOBAL char *sphproof_reach;

/* Uses shared memory, so that the marks of a process that is killed are kept. */
SCHEMATA_GLOBAL __attribute__((constructor(101))) void sphproof_schemata(void)
{
    const char *number = getenv("SPHPROOF_MUTANT"), *name = getenv("SPHPROOF_REACH");
    sphproof_mutant = number ? atoi(number) : 0;
    /* O_RDWR; SEEK_END; PROT_READ | PROT_WRITE, MAP_SHARED: as Linux has them */
    const int file = name ? sphproof_open(name, 2) : -1;
    if (file < 0) return;
    sphproof_reach = sphproof_mmap((void *)0, (unsigned long)sphproof_lseek(file, 0, 2), 3, 1, file, 0);
    if (sphproof_reach != (void *)-1) sphproof_mutant = -1;
    sphproof_close(file); /* so that a test that counts descriptors finds the usual number */
}

static inline int sphproof_seen(int n, int same)
{
    if (sphproof_reach[n] < 2) sphproof_reach[n] = same ? 1 : 2;
    return 0;
}

#define SCHEMATA_ON(n) (sphproof_mutant == (n) || (sphproof_mutant < 0 && sphproof_seen(n, 0)))
/* `is` is evaluated once, and first; `mutant` consists of numbers and names only. */
#define SCHEMATA_VALUE(n, mutant, is)                                                              \
    (__extension__({                                                                               \
        __auto_type is_##n = (is);                                                                 \
        if (sphproof_mutant < 0) sphproof_seen(n, (mutant) == is_##n);                             \
        sphproof_mutant == (n) ? (mutant) : is_##n;                                                \
    }))
