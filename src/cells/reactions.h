/* SPDX-License-Identifier: GPL-3.0-or-later
 * Half loops over pairs: each pair is computed once, at the earlier slot, and the later slot
 * receives the reaction. Slots are cut into chunks, which threads share. Each chunk writes the
 * reactions of its own slots and of the next chunk's slots to one of two arrays, alternately, so
 * that no two chunks write to the same place; pairs of chunks farther apart are computed from both
 * sides. The order of every sum depends on the points alone. */
#ifndef SPHPROOF_REACTIONS_H
#define SPHPROOF_REACTIONS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

struct cells;
struct cells_fields;
struct lanes;
struct lanes_list;

struct reactions {
    int values; /* per slot: force, energy, largest signal speed; then by shifting: momentum,
                   energy, mass, gradient of a constant */
    size_t chunks;
    double *of[2];        /* of even and of odd chunks; of[0] owns the memory of all arrays */
    uint32_t *begin;      /* first slot of each chunk, and the end */
    unsigned char *reach; /* per slot: 1 if it has sums of its own */
    bool all;             /* every slot has sums */
};

/* The chunk that a thread works on. */
struct reactions_chunk {
    size_t before, begin, end, beyond; /* slots: previous begin; begin, end; next end */
    double *of;                        /* NULL: pairs are computed from both sides */
};

/* Memory for each slot, in bytes. */
double reactions_bytes(int values);

/* Allocates for this number of slots; discards the old values. false: no memory. */
bool reactions_reserve(struct reactions *reactions, int values, size_t slots);
void reactions_free(struct reactions *reactions);

/* lanes_all with half loops: the pass must call reactions_partners for its pairs and add
 * reactions_received of its slot. */
void reactions_all(struct cells *cells, const struct cells_fields *fields,
                   void pass(struct cells *, const struct cells_fields *, size_t, struct lanes *));

/* The entries of a slot's list whose pairs the slot computes, those that receive a reaction first.
 */
struct lanes_list reactions_partners(const struct cells *cells, size_t slot, const int32_t *slots,
                                     int count, struct lanes *lanes);

/* The sum of reactions from earlier slots of the chunk, complete when it is the slot's turn. */
static inline const double *reactions_received(const struct reactions *reactions,
                                               const struct reactions_chunk *chunk, size_t slot)
{
    return chunk->of + slot * (size_t)reactions->values;
}

/* The sum of reactions that a slot has received from the previous chunk, valid after all chunks;
 * NULL: there is none, or the slot has no sums. */
static inline const double *reactions_spilled(const struct reactions *reactions, size_t chunk,
                                              size_t slot)
{
    if (chunk == 0 || !reactions->reach[slot]) return NULL;
    return reactions->of[(chunk - 1) % 2] + slot * (size_t)reactions->values;
}

#endif
