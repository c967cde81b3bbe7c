/* SPDX-License-Identifier: GPL-3.0-or-later
 * Growing lists, for items whose number depends on a family or on the user; order and range of
 * numbers. */
#pragma once

#include <stdbool.h>
#include <stddef.h>

/* Ensures capacity for one more item after the `count` items of `size` bytes of a list; list:
 * address of the pointer to its items. An empty list is NULL; free it with free. The list may move.
 * False: no memory, and the list is unchanged. */
bool list_grow(void *list, size_t count, size_t size);

/* Sorts n numbers in ascending order. */
void list_sort(double *values, size_t n);

/* Widens low..high so that it contains all finite values of n; values may be NULL. */
void list_range(const double *values, size_t n, double *low, double *high);
