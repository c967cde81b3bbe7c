/* SPDX-License-Identifier: GPL-3.0-or-later
 * Lists that grow, for everything whose number follows a family or what a user asks for, and sorted
 * numbers. */
#pragma once

#include <stdbool.h>
#include <stddef.h>

/* Makes room for one item more behind the count items of size bytes each that a pointer points to;
 * list: that pointer's address. An empty list is NULL; free it with free. A list may move when it
 * grows. False: no memory, and the list is as it was. */
bool list_grow(void *list, size_t count, size_t size);

/* Sorts n numbers, the least first. */
void list_sort(double *values, size_t n);
