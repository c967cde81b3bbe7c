/* SPDX-License-Identifier: GPL-3.0-or-later
 * Included before every source of a tree that generate.py has rewritten: how one of its mutants is
 * switched on by the environment, SPHPROOF_MUTANT=number. With SPHPROOF_REACH defined nothing is
 * switched; a file named by SPHPROOF_REACH then tells for every mutant, one byte each, whether a
 * process came by (1) and whether the mutant would have made a difference there (2). */
#ifndef SPHPROOF_SCHEMATA_H
#define SPHPROOF_SCHEMATA_H

/* No headers: a source may yet have to say which of their functions it wants. */
char *getenv(const char *name);
int atoi(const char *text);

#define SCHEMATA_GLOBAL __attribute__((weak, visibility("hidden")))

SCHEMATA_GLOBAL int sphproof_mutant;

#ifndef SPHPROOF_REACH

SCHEMATA_GLOBAL __attribute__((constructor(101))) void sphproof_schemata(void)
{
    const char *number = getenv("SPHPROOF_MUTANT");
    sphproof_mutant = number ? atoi(number) : 0;
}

#define SCHEMATA_ON(n)                (sphproof_mutant == (n))
#define SCHEMATA_VALUE(n, mutant, is) (SCHEMATA_ON(n) ? (mutant) : (is))

#else

int open(const char *name, int flags, ...);
void *mmap(void *at, unsigned long size, int protection, int flags, int file, long offset);

SCHEMATA_GLOBAL char sphproof_nowhere[SPHPROOF_REACH];
SCHEMATA_GLOBAL char *sphproof_reach = sphproof_nowhere;

/* Shared memory: also what is told by a process that is killed arrives. */
SCHEMATA_GLOBAL __attribute__((constructor(101))) void sphproof_schemata(void)
{
    const char *name = getenv("SPHPROOF_REACH");
    /* O_RDWR; PROT_READ | PROT_WRITE, MAP_SHARED: as Linux has them */
    const int file = name && sphproof_reach == sphproof_nowhere ? open(name, 2) : -1;
    void *map = file < 0 ? (void *)-1 : mmap((void *)0, SPHPROOF_REACH, 3, 1, file, 0);
    if (map != (void *)-1) sphproof_reach = map;
}

#define SCHEMATA_ON(n) ((sphproof_reach[n] = 2), 0)
#define SCHEMATA_VALUE(n, mutant, is)                                                              \
    (__extension__({                                                                               \
        __auto_type is_##n = (is);                                                                 \
        if (sphproof_reach[n] < 2) sphproof_reach[n] = (mutant) == is_##n ? 1 : 2;                 \
        is_##n;                                                                                    \
    }))

#endif
#endif
