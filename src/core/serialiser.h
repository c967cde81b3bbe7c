/* SPDX-License-Identifier: GPL-3.0-or-later
 * Saves the state of a simulation, or restores it to one created from the same setup. Each part
 * passes its memory in the same order in both directions, so that saving and restoring cannot
 * disagree. */
#ifndef SPHPROOF_SERIALISER_H
#define SPHPROOF_SERIALISER_H

#include <stdbool.h>
#include <stddef.h>

struct serialiser {
    bool (*bytes)(void *context, void *bytes, size_t n); /* saves or fills in n bytes */
    void *context;
    bool back;   /* direction: true restores the simulation */
    bool failed; /* a call of bytes failed; later calls do nothing */
};

static inline void serialise(struct serialiser *serialiser, void *bytes, size_t n)
{
    if (!serialiser->failed && n)
        serialiser->failed = !serialiser->bytes(serialiser->context, bytes, n);
}

/* For objects without pointers. */
#define SERIALISE(serialiser, thing) serialise(serialiser, &(thing), sizeof(thing))

#endif
