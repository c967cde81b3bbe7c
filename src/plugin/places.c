/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "places.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "list.h"

enum { DECIMALS = 1000, DENOMINATORS = 64, DIGITS_FROM = 6, DIGITS_TO = 16, FILE_MAX = 1 << 24 };

double places_random(uint64_t seed, uint64_t i)
{
    uint64_t z = seed + (i + 1) * 0x9e3779b97f4a7c15u;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    z ^= z >> 31;
    return (double)(z >> 11) * 0x1p-53;
}

/* Sorts, and removes duplicates. */
static int distinct(double *q, int n)
{
    int kept = 0;
    list_sort(q, (size_t)n);
    for (int i = 0; i < n; i++)
        if (kept == 0 || q[i] > q[kept - 1]) q[kept++] = q[i];
    return kept;
}

static int make_centres(const struct pieces *pieces, double *centre)
{
    const struct terms *terms = &pieces->terms;
    int n = 0;
    for (int i = 0; i <= pieces->n; i++) centre[n++] = pieces->edge[i];
    for (int i = 0; i < DECIMALS; i++) centre[n++] = (double)i / DECIMALS;
    for (int b = 2; b <= DENOMINATORS; b++)
        for (int a = 1; a < b; a++) centre[n++] = (double)a / b;
    for (int i = 0; i < terms->constant_count; i++) {
        centre[n++] = terms->constants[i];
        centre[n++] = 1 - terms->constants[i];
        centre[n++] = sqrt(terms->constants[i]);
    }
    return distinct(centre, n);
}

enum status places_find(struct pieces *pieces, struct error *error)
{
    const size_t capacity = (size_t)pieces->n + 1 + DECIMALS + DENOMINATORS * DENOMINATORS +
                            3 * (size_t)pieces->terms.constant_count;
    double off[DIGITS_TO - DIGITS_FROM + 1];
    const size_t digits = sizeof off / sizeof *off;
    double *centre = malloc(capacity * sizeof *centre);
    double *q = pieces->places = malloc(capacity * (1 + 2 * digits) * sizeof *q);
    const int centres = centre && q ? make_centres(pieces, centre) : 0;
    int n = 0, sorted = 0;
    for (size_t k = 0; k < digits; k++) off[k] = pow(10, -DIGITS_FROM - (double)k);
    for (int i = 0; i < centres; i++) {
        for (size_t k = 0; k < digits; k++) q[n++] = fabs(centre[i] - off[k]);
        q[n++] = centre[i];
        for (size_t k = digits; k-- > 0;) q[n++] = centre[i] + off[k];
        /* most centres have neighbours that are far from those of the next one: sorted already */
        if (i + 1 == centres || centre[i + 1] - centre[i] > 3 * off[0])
            n = sorted += distinct(q + sorted, n - sorted);
    }
    free(centre);
    if (!centres) return error_set(error, STATUS_ENVIRONMENT, "no memory for places");
    while (q[n - 1] >= 1) n--; /* 0 is the first */
    pieces->place_count = n;
    return STATUS_OK;
}

/* Stores the absolute value, since a compiler may add the negative of what the source subtracts. */
static int keep(double value, double *list, int n)
{
    const double q = fabs(value);
    if (!(q > 1e-9 && q < 1) || n == PLACES_CONSTANTS_MAX) return n;
    list[n] = q;
    return n + 1;
}

/* First aligned numbers, which compilers put into the section for constants, then any others, such
 * as operands of instructions. */
static int scan(const unsigned char *bytes, size_t size, double *list)
{
    int n = 0;
    for (int aligned = 1; aligned >= 0; aligned--)
        for (size_t i = 0; i + sizeof(double) <= size; i++) {
            double value;
            float single;
            if ((i % 8 == 0) != aligned) continue;
            memcpy(&value, bytes + i, sizeof value);
            memcpy(&single, bytes + i, sizeof single);
            n = keep(value, list, n);
            if (i % 4 == 0) n = keep((double)single, list, n);
        }
    return distinct(list, n);
}

int places_constants(const char *path, double **constants)
{
    unsigned char *bytes = malloc(FILE_MAX);
    FILE *file = fopen(path, "rb");
    int n = 0;
    *constants = malloc(PLACES_CONSTANTS_MAX * sizeof **constants);
    if (bytes && file && *constants) n = scan(bytes, fread(bytes, 1, FILE_MAX, file), *constants);
    if (file) fclose(file);
    free(bytes);
    return n;
}
