/* SPDX-License-Identifier: GPL-3.0-or-later
 * The state of a simulation, carried out of it or back into one that was created of the same setup.
 * Each part hands its memory over in the same order both ways, so that what is kept and what is
 * restored cannot come apart. */
#ifndef SPHPROOF_SERIALISER_H
#define SPHPROOF_SERIALISER_H

#include <stdbool.h>
#include <stddef.h>

struct serialiser {
    bool (*bytes)(void *context, void *bytes, size_t n); /* takes them, or fills them in */
    void *context;
    bool back;   /* into the simulation */
    bool failed; /* something could not be carried: what follows is left as it is */
};

static inline void serialise(struct serialiser *serialiser, void *bytes, size_t n)
{
    if (!serialiser->failed && n)
        serialiser->failed = !serialiser->bytes(serialiser->context, bytes, n);
}

/* Anything that has an address and no pointers in it. */
#define SERIALISE(serialiser, thing) serialise(serialiser, &(thing), sizeof(thing))

#endif
