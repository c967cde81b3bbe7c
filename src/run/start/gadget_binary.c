/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "gadget_binary.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "output.h"

enum { HEADER = 256, TYPES = 6, GAS_MOST = INT32_MAX / 12 };

static void put_record(FILE *to, const char *name, const void *bytes, size_t size)
{
    const uint32_t eight = 8, count = (uint32_t)size, behind = count + 8;
    if (name) {
        fwrite(&eight, sizeof eight, 1, to);
        fwrite(name, 1, 4, to);
        fwrite(&behind, sizeof behind, 1, to);
        fwrite(&eight, sizeof eight, 1, to);
    }
    fwrite(&count, sizeof count, 1, to);
    fwrite(bytes, 1, size, to);
    fwrite(&count, sizeof count, 1, to);
}

/* BoxSize is a single number; 0 if the sides differ. */
static double side_of(const struct domain *box)
{
    for (int d = 1; d < box->dim; d++)
        if (domain_length(box, d) != domain_length(box, 0)) return 0;
    return domain_length(box, 0);
}

static void put_header(FILE *to, const char *name, const struct run_result *result)
{
    const uint32_t n = (uint32_t)result->n, files = 1;
    const double side = side_of(&result->problem.domain), hubble = 1;
    const struct {
        size_t at, size;
        const void *value;
    } entries[] = {{0, sizeof n, &n},         {72, sizeof result->time, &result->time},
                   {96, sizeof n, &n},        {124, sizeof files, &files},
                   {128, sizeof side, &side}, {152, sizeof hubble, &hubble}};
    unsigned char bytes[HEADER] = {0};
    for (size_t k = 0; k < sizeof entries / sizeof *entries; k++)
        memcpy(bytes + entries[k].at, entries[k].value, entries[k].size);
    put_record(to, name, bytes, sizeof bytes);
}

/* Position in [0, L), also after rounding to single precision. */
static float position(const struct domain *box, int d, double x)
{
    const double from = domain_offset(box, d, x), length = domain_length(box, d);
    const float rounded = (float)from;
    return from < length && (double)rounded >= length ? nextafterf(rounded, 0) : rounded;
}

static void put_blocks(FILE *to, bool named, const struct run_result *result, float *numbers)
{
    const struct snapshot *s = &result->snapshot;
    const struct domain *box = &result->problem.domain;
    const size_t n = s->n;
    for (size_t i = 0; i < 3 * n; i++) {
        const int d = (int)(i % 3);
        numbers[i] = d < box->dim ? position(box, d, s->x[d][i / 3]) : 0;
    }
    put_record(to, named ? "POS " : NULL, numbers, 3 * n * sizeof *numbers);
    for (size_t i = 0; i < 3 * n; i++)
        numbers[i] = (int)(i % 3) < box->dim ? (float)s->v[i % 3][i / 3] : 0;
    put_record(to, named ? "VEL " : NULL, numbers, 3 * n * sizeof *numbers);
    for (uint32_t i = 0; i < n; i++) {
        const uint32_t id = i + 1;
        memcpy(numbers + i, &id, sizeof id);
    }
    put_record(to, named ? "ID  " : NULL, numbers, n * sizeof *numbers);
    const struct {
        const char *name;
        const double *values;
    } scalars[] = {{"MASS", s->m}, {"U   ", s->u}, {"RHO ", s->rho}, {"HSML", s->h}};
    for (size_t k = 0; k < sizeof scalars / sizeof *scalars; k++) {
        for (size_t i = 0; i < n; i++) numbers[i] = (float)scalars[k].values[i];
        put_record(to, named ? scalars[k].name : NULL, numbers, n * sizeof *numbers);
    }
}

enum status gadget_binary_write(const struct run_result *result, const char *path, bool named,
                                struct error *error)
{
    struct output output;
    if (result->n > GAS_MOST)
        return error_set(error, STATUS_BAD_INPUT,
                         "%.200s: %zu particles; a binary of GADGET has room for %d", path,
                         result->n, GAS_MOST);
    float *numbers = malloc(3 * result->n * sizeof *numbers);
    if (!numbers) return error_set(error, STATUS_ENVIRONMENT, "no memory for %.200s", path);
    enum status status = output_open(&output, path, error);
    if (!status) {
        put_header(output.stream, named ? "HEAD" : NULL, result);
        put_blocks(output.stream, named, result, numbers);
        status = output_close(&output, error);
    }
    free(numbers);
    return status;
}

GADGET_BINARY(gadget_binary, "1", false);
