/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "reactions.h"

#include <stdlib.h>
#include <string.h>

#include "lanes.h"
#include "pages.h"
#include "specialise.h"
#include "team.h"

#if SPHPROOF_CLONES && defined __x86_64__
#include <immintrin.h>
#endif

/* Size of a chunk, in slots: in small systems small enough that each thread gets some chunks, in
 * large ones so that a chunk's records and reactions stay in the second-level cache. In 3D chunks
 * are fewer, because thin slabs have many neighbours beyond the next chunk. */
enum { CHUNKS_2D = 32, CHUNKS_3D = 8, CHUNK_LEAST = 512, CHUNK_MOST = 8192 };

double reactions_bytes(int values)
{
    return 2 * values * (double)sizeof(double) + 1;
}

bool reactions_reserve(struct reactions *reactions, int each, size_t slots)
{
    const size_t values = (size_t)each, chunks = slots / CHUNK_LEAST + 2;
    free(reactions->of[0]);
    reactions->values = each;
    reactions->of[0] =
        pages_allocate(slots * (2 * values * sizeof(double) + 1) + chunks * sizeof(uint32_t) + 3);
    if (!reactions->of[0]) return false;
    reactions->of[1] = reactions->of[0] + slots * values;
    reactions->begin = (uint32_t *)(void *)(reactions->of[1] + slots * values);
    reactions->reach = (unsigned char *)(reactions->begin + chunks);
    return true;
}

void reactions_free(struct reactions *reactions)
{
    free(reactions->of[0]);
}

/* Cuts the slots into chunks of whole parts of the grid. */
static void cut_chunks(struct cells *cells)
{
    struct reactions *reactions = &cells->reactions;
    const uint32_t *begin;
    const size_t parts = grid_parts(cells->grid, &begin);
    const size_t wanted = cells->points / (cells->method.box.dim == 2 ? CHUNKS_2D : CHUNKS_3D);
    const size_t size = wanted < CHUNK_LEAST  ? CHUNK_LEAST
                        : wanted > CHUNK_MOST ? CHUNK_MOST
                                              : wanted;
    reactions->chunks = 0;
    reactions->begin[0] = 0;
    for (size_t p = 1; p <= parts; p++)
        if (begin[p] - reactions->begin[reactions->chunks] >= size || p == parts)
            reactions->begin[++reactions->chunks] = begin[p];
}

static void work(struct cells *cells, const struct cells_fields *fields, size_t c,
                 struct lanes *lanes, lanes_pass *pass)
{
    const struct reactions *reactions = &cells->reactions;
    const uint32_t *begin = reactions->begin;
    const size_t last = c + 2 < reactions->chunks ? c + 2 : reactions->chunks;
    const struct reactions_chunk chunk = {.before = begin[c > 0 ? c - 1 : 0],
                                          .begin = begin[c],
                                          .end = begin[c + 1],
                                          .beyond = begin[last],
                                          .of = reactions->of[c % 2]};
    const size_t values = (size_t)reactions->values;
    lanes->chunk = chunk;
    memset(chunk.of + chunk.begin * values, 0,
           (chunk.beyond - chunk.begin) * values * sizeof *chunk.of);
    for (size_t slot = chunk.begin; slot < chunk.end; slot++)
        if (reactions->reach[slot]) pass(cells, fields, slot, lanes);
    lanes->chunk.of = NULL;
}

void reactions_all(struct cells *cells, const struct cells_fields *fields, lanes_pass *pass)
{
    struct reactions *reactions = &cells->reactions;
    cut_chunks(cells);
    bool all = true;
#pragma omp parallel for num_threads(cells->team) reduction(&& : all) if (cells->team > 1)
    for (size_t slot = 0; slot < cells->points; slot++) {
        reactions->reach[slot] = cells->lists[slot].kept != NULL;
        all = all && reactions->reach[slot];
    }
    reactions->all = all;
    struct team_shares shares;
    team_share(&shares, cells->team, reactions->chunks);
#pragma omp parallel num_threads(cells->team) if (cells->team > 1)
    for (size_t c; team_next(&shares, &c);)
        work(cells, fields, c, &cells->lanes[team_thread()], pass);
}

/* The entries of a list whose pairs a slot computes: those that receive a reaction, and the others.
 * Both arrays have space for whole vectors beyond their ends. */
struct split {
    size_t slot, before, beyond;
    int32_t *reacting, *alone;
    int reacting_count, alone_count;
};

static void split_plainly(struct split *split, const unsigned char *reach, const int32_t *slots,
                          int count)
{
    const size_t slot = split->slot, before = split->before, beyond = split->beyond;
    int reacting = 0, alone = 0;
    for (int k = 0; k < count; k++) {
        const size_t other = (size_t)slots[k];
        const int later = (int)(other > slot) & reach[other], near = other < beyond;
        split->reacting[reacting] = split->alone[alone] = slots[k];
        reacting += later & near;
        alone += (later & !near) | (other < before) | !reach[other];
    }
    split->reacting_count = reacting;
    split->alone_count = alone;
}

#if SPHPROOF_CLONES && defined __x86_64__

/* Without optimisation gcc's header makes these calls macros, which convert their masks. */
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wsign-conversion"

/* As split_plainly. all: every slot has sums; otherwise `reach` is read up to three bytes beyond a
 * slot's own. */
__attribute__((target("avx512f,popcnt"), always_inline)) static inline void
split_vectors(bool all, struct split *split, const unsigned char *reach, const int32_t *slots,
              int count)
{
    const __m512i slot = _mm512_set1_epi32((int32_t)split->slot),
                  before = _mm512_set1_epi32((int32_t)split->before),
                  beyond = _mm512_set1_epi32((int32_t)split->beyond), byte = _mm512_set1_epi32(255);
    int reacting = 0, alone = 0;
    for (int k = 0; k < count; k += 16) {
        const __mmask16 there = (__mmask16)(count - k < 16 ? (1u << (count - k)) - 1 : 0xffffu);
        const __m512i other = _mm512_maskz_loadu_epi32(there, slots + k);
        __mmask16 has_sums = there;
        if (!all)
            has_sums = _mm512_mask_test_epi32_mask(
                there, _mm512_mask_i32gather_epi32(byte, there, other, reach, 1), byte);
        const __mmask16 later = _mm512_mask_cmpgt_epi32_mask(has_sums, other, slot),
                        near = _mm512_mask_cmplt_epi32_mask(later, other, beyond),
                        earlier = _mm512_mask_cmplt_epi32_mask(there, other, before),
                        far = (__mmask16)((later & ~near) | earlier | (there & ~has_sums));
        _mm512_storeu_si512(split->reacting + reacting, _mm512_maskz_compress_epi32(near, other));
        _mm512_storeu_si512(split->alone + alone, _mm512_maskz_compress_epi32(far, other));
        reacting += _mm_popcnt_u32(near);
        alone += _mm_popcnt_u32(far);
    }
    split->reacting_count = reacting;
    split->alone_count = alone;
}

__attribute__((target("avx512f,popcnt"))) static void
split_in_vectors(struct split *split, const struct reactions *reactions, const int32_t *slots,
                 int count)
{
    if (reactions->all)
        split_vectors(true, split, reactions->reach, slots, count);
    else
        split_vectors(false, split, reactions->reach, slots, count);
}

#pragma GCC diagnostic pop

#endif

static void split_list(struct split *split, const struct reactions *reactions, const int32_t *slots,
                       int count)
{
#if SPHPROOF_CLONES && defined __x86_64__
    if (__builtin_cpu_supports("avx512f")) {
        split_in_vectors(split, reactions, slots, count);
        return;
    }
#endif
    split_plainly(split, reactions->reach, slots, count);
}

struct lanes_list reactions_partners(const struct cells *cells, size_t slot, const int32_t *slots,
                                     int count, struct lanes *lanes)
{
    struct split split = {.slot = slot,
                          .before = lanes->chunk.before,
                          .beyond = lanes->chunk.beyond,
                          .reacting = lanes->slots,
                          .alone = lanes->slots + lanes->capacity / 2};
    split_list(&split, &cells->reactions, slots, count);
    const int reacting = split.reacting_count, kept = reacting + split.alone_count;
    memcpy(lanes->slots + reacting, split.alone, (size_t)split.alone_count * sizeof *split.alone);
    for (int k = kept; k < whole_vectors(kept); k++) lanes->slots[k] = (int32_t)cells->points;
    return (struct lanes_list){lanes->slots, kept, reacting};
}
