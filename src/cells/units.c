/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "units.h"

#include <math.h>
#include <stdlib.h>

bool units_ordinary(size_t n, const double *values)
{
    const double most = 0x1p128, least = 0x1p-128;
    for (size_t i = 0; i < n; i++) {
        const double size = fabs(values[i]);
        if (size > most || (size > 0 && size < least)) return false;
    }
    return true;
}

int units_exponent(size_t n, const double *values)
{
    double largest = 0;
    int e = 0;
    for (size_t i = 0; i < n; i++)
        if (isfinite(values[i])) largest = fmax(largest, fabs(values[i]));
    frexp(largest, &e);
    return e;
}

double *units_copy(size_t n, const double *values, int e)
{
    double *copy = malloc((n + 1) * sizeof *copy);
    for (size_t i = 0; copy && i < n; i++) copy[i] = ldexp(values[i], -e);
    return copy;
}

bool units_points(const struct points *points, int e, struct points *copy)
{
    bool sound = true;
    *copy = *points;
    for (int a = 0; a < points->dim; a++) {
        copy->x[a] = units_copy(points->n, points->x[a], e);
        sound = sound && copy->x[a];
        copy->lo[a] = ldexp(points->lo[a], -e);
        copy->hi[a] = ldexp(points->hi[a], -e);
    }
    if (!sound) units_points_free(copy);
    return sound;
}

void units_points_free(struct points *copy)
{
    for (int a = 0; a < copy->dim; a++) {
        free((void *)copy->x[a]);
        copy->x[a] = NULL;
    }
}
