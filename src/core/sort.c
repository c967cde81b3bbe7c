/* SPDX-License-Identifier: GPL-3.0-or-later
 * Natural merge sort: Knuth 1998, The Art of Computer Programming 3, section 5.2.4. */
#include "sort.h"

#include <string.h>

/* The end of the sorted run that begins at first. */
static size_t stretch_end(const double *x, size_t n, const size_t *order, size_t first)
{
    size_t end = first + 1;
    while (end < n && !(x[order[end - 1]] > x[order[end]])) end++;
    return end;
}

/* Merges two adjacent sorted runs, first..middle and middle..end of from, into to. Returns the
 * number of comparisons. */
static size_t merge(const double *x, const size_t *from, size_t first, size_t middle, size_t end,
                    size_t *to)
{
    size_t left = first, right = middle, next = first;
    while (left < middle && right < end)
        to[next++] = x[from[left]] > x[from[right]] ? from[right++] : from[left++];
    const size_t compared = next - first;
    memcpy(to + next, from + left, (middle - left) * sizeof *to);
    next += middle - left;
    memcpy(to + next, from + right, (end - right) * sizeof *to);
    return compared;
}

size_t sort_indices(const double *x, size_t n, size_t *order, size_t *other)
{
    size_t *from = order, *to = other, compared = 0;
    while (n > 0) {
        size_t end = stretch_end(x, n, from, 0);
        compared += end;
        if (end == n) break;
        for (size_t first = 0; first < n; first = end) {
            const size_t middle = first > 0 ? stretch_end(x, n, from, first) : end;
            end = middle < n ? stretch_end(x, n, from, middle) : n;
            compared += end - first + merge(x, from, first, middle, end, to);
        }
        size_t *const sorted = to;
        to = from;
        from = sorted;
    }
    if (from != order) memcpy(order, from, n * sizeof *order);
    return compared;
}
