/* SPDX-License-Identifier: GPL-3.0-or-later
 * The state of a simulation, carried out of it or back into one that was created of the same scene.
 * Each part hands its memory over in the same order both ways, so that what is kept and what is
 * restored cannot come apart. */
#ifndef SPHPROOF_CARRIER_H
#define SPHPROOF_CARRIER_H

#include <stdbool.h>
#include <stddef.h>

struct carrier {
    bool (*bytes)(void *context, void *bytes, size_t n); /* takes them, or fills them in */
    void *context;
    bool back;   /* into the simulation */
    bool failed; /* something could not be carried: what follows is left as it is */
};

static inline void carry(struct carrier *carrier, void *bytes, size_t n)
{
    if (!carrier->failed && n) carrier->failed = !carrier->bytes(carrier->context, bytes, n);
}

/* Anything that has an address and no pointers in it. */
#define CARRY(carrier, thing) carry(carrier, &(thing), sizeof(thing))

#endif
