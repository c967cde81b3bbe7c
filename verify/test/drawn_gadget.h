/* SPDX-License-Identifier: GPL-3.0-or-later
 * Writes GADGET binaries with random particles, and tests what their reader finds. Include after
 * test.h. */
#pragma once

#include <float.h>

#include "draw.h"
#include "expected_snapshot.h"

enum { TYPES = 6, MOST = 40, BYTES = 1 << 16 };
enum { POS, VEL, ID, MASS, U, RHO, HSML, ACCE, BLOCKS };
static const char *const tags[BLOCKS] = {"POS ", "VEL ", "ID  ", "MASS",
                                         "U   ", "RHO ", "HSML", "ACCE"};
static const int columns[BLOCKS] = {SNAPSHOT_X, SNAPSHOT_VX,  -1,         SNAPSHOT_M,
                                    SNAPSHOT_U, SNAPSHOT_RHO, SNAPSHOT_H, SNAPSHOT_AX};

static inline double uniform(double lo, double hi)
{
    return lo + (hi - lo) * drawn(1u << 20) / (1u << 20); /* exact in single precision */
}

struct binary {
    bool tagged, swapped;
    int dim;
    uint32_t count[TYPES], parts;
    double table[TYPES], time, redshift, box;
    bool there[BLOCKS];
    int width[BLOCKS];
    double value[BLOCKS][3 * MOST];
    size_t extra; /* the code's own records between ID and MASS */
    size_t rows[BLOCKS];
};

static bool is_vector(int block)
{
    return block == POS || block == VEL || block == ACCE;
}

/* Gas of density 1 to 2 in a box of 64 along each direction, and particles of other types. Widths
 * are so much larger than densities that they cannot be mistaken for them. */
enum { SIDE = 64 };

static inline struct binary made(int dim)
{
    struct binary b = {.tagged = true, .dim = dim, .parts = 1, .time = 0.375, .box = SIDE};
    size_t all = 0, massive = 0;
    for (int t = 0; t < TYPES; t++) {
        b.count[t] = t == 0 ? 8 + drawn(5) : drawn(3);
        b.table[t] = drawn(2) ? 0 : 0.5 + t;
        all += b.count[t];
        massive += b.table[t] > 0 ? 0 : b.count[t];
    }
    const double share = pow(SIDE, dim) / b.count[0]; /* the volume per particle */
    if (b.table[0] > 0) b.table[0] = (double)(float)(1.5 * share);
    for (int k = 0; k < BLOCKS; k++) {
        b.there[k] = true, b.width[k] = k == ID ? 4 : drawn(2) ? 4 : 8;
        b.rows[k] = k <= ID ? all : k == MASS ? massive : b.count[0];
        for (size_t i = 0; i < b.rows[k]; i++)
            for (int c = 0; c < 3; c++) {
                double *to = &b.value[k][is_vector(k) ? 3 * i + (size_t)c : i];
                *to = k == POS    ? (c < dim ? uniform(0, SIDE) : uniform(0, SIDE * 0x1p-20))
                      : k == MASS ? (double)(float)uniform(1.4 * share, 1.6 * share)
                      : k == RHO  ? uniform(1, 2)
                      : k == HSML ? (double)(float)(uniform(1, 3) * pow(share, 1. / dim))
                      : k == U    ? uniform(2, 3)
                                  : uniform(-4, 4);
            }
    }
    for (int c = 0; c < dim; c++) b.value[POS][c] = 0, b.value[POS][3 + c] = SIDE;
    b.there[MASS] = massive > 0;
    return b;
}

static unsigned char bytes[BYTES];

static size_t put_word(size_t at, const struct binary *b, const void *word, size_t size)
{
    const unsigned char *from = word;
    for (size_t k = 0; k < size; k++) bytes[at + k] = from[b->swapped ? size - 1 - k : k];
    return at + size;
}

static size_t put_count(size_t at, const struct binary *b, uint32_t count)
{
    return put_word(at, b, &count, sizeof count);
}

static size_t put_real(size_t at, const struct binary *b, double value, int width)
{
    const float half = (float)value;
    return width == 4 ? put_word(at, b, &half, 4) : put_word(at, b, &value, 8);
}

static size_t put_tag(size_t at, const struct binary *b, const char *tag, uint32_t size)
{
    if (!b->tagged) return at;
    at = put_count(at, b, 8);
    memcpy(bytes + at, tag, 4);
    at = put_count(at + 4, b, size + 8);
    return put_count(at, b, 8);
}

static size_t put_header(const struct binary *b)
{
    size_t at = put_count(put_tag(0, b, "HEAD", 256), b, 256);
    const size_t h = at;
    memset(bytes + at, 0, 256);
    for (int t = 0; t < TYPES; t++) {
        put_count(h + 4 * (size_t)t, b, b->count[t]);
        put_real(h + 24 + 8 * (size_t)t, b, b->table[t], 8);
    }
    put_real(h + 72, b, b->time, 8);
    put_real(h + 80, b, b->redshift, 8);
    put_count(h + 124, b, b->parts);
    put_real(h + 128, b, b->box, 8);
    return put_count(h + 256, b, 256);
}

static size_t put_block(size_t at, const struct binary *b, int k)
{
    const size_t n = b->rows[k] * (is_vector(k) ? 3 : 1);
    const uint32_t size = (uint32_t)(n * (size_t)b->width[k]);
    at = put_count(put_tag(at, b, tags[k], size), b, size);
    for (size_t i = 0; i < n; i++)
        at = k == ID ? put_count(at, b, (uint32_t)i) : put_real(at, b, b->value[k][i], b->width[k]);
    return put_count(at, b, size);
}

static inline size_t put_all(const struct binary *b)
{
    size_t at = put_header(b);
    for (int k = 0; k < BLOCKS; k++) {
        if (k == MASS) /* records of 4 bytes, a length that no block has */
            for (size_t e = 0; e < b->extra; e++) {
                at = put_count(put_tag(at, b, "MINE", 4), b, 4);
                at = put_count(put_count(at, b, 77), b, 4);
            }
        if (b->there[k]) at = put_block(at, b, k);
    }
    return at;
}

static inline enum status read_bytes(size_t size, struct snapshot_file *file, struct error *error)
{
    static const struct snapshot_options plain = {0};
    put_bytes("a.gadget", bytes, size);
    return read_gas("a.gadget", &plain, file, error);
}

static void is_noted(const struct binary *b, const struct snapshot_file *file)
{
    char words[80], value[80];
    size_t records = 1 + b->extra;
    for (int k = 0; k < BLOCKS; k++) records += b->there[k];
    snprintf(words, sizeof words, "%s byte order, %zu records",
             b->swapped ? "the other" : "this machine's", records);
    noted(file, "format", b->tagged ? "2" : "1", words);
    snprintf(value, sizeof value, "%.9g", b->table[0]);
    noted(file, "masses", b->table[0] > 0 ? "from the header's table" : NULL, value);
    noted(file, "positions", file->precision[0] < file->precision[1] ? "float64" : NULL,
          "24 bytes a particle");
    snprintf(value, sizeof value, "%s from record %zu on", b->there[MASS] ? "masses" : "energies",
             4 + b->there[ID] + b->extra);
    snprintf(words, sizeof words, "of %zu records only these", records);
    noted(file, "blocks", b->tagged ? NULL : value, words);
    if (b->tagged) return;
    const char *evidence = "";
    for (size_t k = 0; k < file->notes.count; k++)
        if (strcmp(file->notes.note[k].what, "blocks") == 0)
            evidence = file->notes.note[k].evidence;
    snprintf(words, sizeof words, "of the volume %.4g, and",
             pow(b->box > 0 && b->box < 2 * SIDE ? b->box : SIDE, b->dim));
    assert_non_null(strstr(evidence, words));
    assert_true(!strstr(evidence, "the records before them are the code's own") == !b->extra);
}

static inline void is_read(const struct binary *b, const char *what)
{
    struct snapshot_file file;
    struct error error;
    double precision[2] = {0, 0};
    if (read_bytes(put_all(b), &file, &error)) fail_msg("%s: %s", what, error.message);
    assert_int_equal(file.n, b->count[0]);
    assert_int_equal(file.gas, b->count[0]);
    assert_int_equal(file.dim, b->dim);
    assert_true(file.time.known && file.time.value == b->time && !file.gamma.known);
    assert_true(file.boxed == (b->box > 0 && b->box < (double)INFINITY) && file.parts == 1);
    for (int d = 0; d < 3; d++) assert_true(file.box[d] == (file.boxed ? b->box : 0));
    for (int k = 0; k < BLOCKS; k++) {
        if (columns[k] < 0) continue;
        const bool table = k == MASS && b->table[0] > 0;
        if (!b->there[k] && !table) {
            assert_null(file.column[columns[k]]);
            continue;
        }
        const double coarse = (b->width[k] == 4 ? (double)FLT_EPSILON : DBL_EPSILON) / 2;
        if (!table) precision[k != POS] = fmax(precision[k != POS], coarse);
        for (size_t i = 0; i < b->count[0]; i++)
            for (int c = 0; c < (is_vector(k) ? 3 : 1); c++) {
                const double want = table          ? b->table[0]
                                    : is_vector(k) ? b->value[k][3 * i + (size_t)c]
                                                   : b->value[k][i];
                if (file.column[columns[k] + c][i] != want)
                    fail_msg("%s: %s of %zu: %g, not %g", what, tags[k], i,
                             file.column[columns[k] + c][i], want);
            }
    }
    for (int k = 0; k < 2; k++) assert_true(file.precision[k] == precision[k]);
    is_noted(b, &file);
    snapshot_file_free(&file);
}

static inline void refuses(size_t size, const char *what, const char *says)
{
    static const struct snapshot_options plain = {0};
    put_bytes("a.gadget", bytes, size);
    is_refused("a.gadget", &plain, what, says);
}
