/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "list.h"

#include <stdint.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* From SMALL items on, the capacity doubles whenever count is a power of two, so that no
 * capacity has to be stored. Shorter lists have no spare item: its memory would hide a step beyond
 * the end from the sanitizers. */
enum { SMALL = 64 };

bool list_grow(void *list, size_t count, size_t size)
{
    void *old, *grown;
    const size_t capacity = count < SMALL ? count + 1 : 2 * count;
    if (count > SMALL && count & (count - 1)) return true;
    if (capacity < count || capacity > SIZE_MAX / size) return false;
    memcpy(&old, list, sizeof old); /* memcpy, as the type of the caller's pointer is unknown */
    grown = realloc(old, capacity * size);
    if (grown) memcpy(list, &grown, sizeof grown);
    return grown;
}

static int ascending(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

void list_sort(double *values, size_t n)
{
    for (size_t i = 1; i < n; i++)
        if (!(values[i - 1] <= values[i])) {
            qsort(values, n, sizeof *values, ascending);
            return;
        }
}

void list_range(const double *values, size_t n, double *low, double *high)
{
    for (size_t i = 0; values && i < n; i++) {
        if (!isfinite(values[i])) continue;
        *low = fmin(*low, values[i]);
        *high = fmax(*high, values[i]);
    }
}
