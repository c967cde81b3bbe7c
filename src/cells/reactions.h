/* SPDX-License-Identifier: GPL-3.0-or-later
 * Half loops over pairs: what two particles do to each other is worked out once, at the earlier
 * slot, and the later one receives the reaction. Slots are cut into chunks, which threads share. A
 * chunk writes reactions of its own slots and of those of the next chunk into one of two arrays,
 * by turns, so that no two chunks write to one place; pairs of chunks farther apart are worked out
 * from both sides. Every sum is added up in an order that depends on the points alone. */
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
    int values; /* of each slot: force, energy, the largest signal speed; what shifting gives */
    size_t chunks;
    double *of[2];        /* of even and of odd chunks; all arrays are in the first one's block */
    uint32_t *begin;      /* of each chunk, and the end */
    unsigned char *reach; /* of each slot: has it sums of its own? */
    bool all;             /* every slot has */
};

/* The chunk that a thread works on. */
struct reactions_chunk {
    size_t before, begin, end, beyond; /* slots: of the chunk before, its own, the next one's end */
    double *of;                        /* NULL: pairs are worked out from both sides */
};

/* Bytes for each slot. */
double reactions_bytes(int values);

/* Memory for so many slots, in place of what there was. false: none. */
bool reactions_reserve(struct reactions *reactions, int values, size_t slots);
void reactions_free(struct reactions *reactions);

/* lanes_all with half loops: the pass asks reactions_partners for its pairs, and adds what
 * reactions_received has for its slot. */
void reactions_all(struct cells *cells, const struct cells_fields *fields,
                   void pass(struct cells *, const struct cells_fields *, size_t, struct lanes *));

/* Of a slot's list those that the slot works out, the ones that get a reaction first. */
struct lanes_list reactions_partners(const struct cells *cells, size_t slot, const int32_t *slots,
                                     int count, struct lanes *lanes);

/* What a slot has received from the earlier ones of its chunk, once it is its turn. */
static inline const double *reactions_received(const struct reactions *reactions,
                                               const struct reactions_chunk *chunk, size_t slot)
{
    return chunk->of + slot * (size_t)reactions->values;
}

/* When all chunks are done: what a slot of a chunk has received from the chunk before; NULL: there
 * is none, or the slot has no sums. */
static inline const double *reactions_spilled(const struct reactions *reactions, size_t chunk,
                                              size_t slot)
{
    if (chunk == 0 || !reactions->reach[slot]) return NULL;
    return reactions->of[(chunk - 1) % 2] + slot * (size_t)reactions->values;
}

#endif
