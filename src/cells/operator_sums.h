/* SPDX-License-Identifier: GPL-3.0-or-later
 * Private to the gradient operators: the sums over the neighbours of every point (operator_sums.c),
 * for a sorted cloud in ordinary units (operator.c). */
#ifndef SPHPROOF_OPERATOR_SUMS_H
#define SPHPROOF_OPERATOR_SUMS_H

#include "operator.h"
#include "shapes.h"

struct operator_task {
    const struct operator_settings *settings;
    const struct neighbours *neighbours;
    struct shapes shapes;
    size_t fields;
    double *sorted;           /* (2 + fields) * n: volume, h, fields, in sorted order */
    const double *volume, *h; /* into sorted */
    double *const *gradient;
    struct operator_point *point;
};

/* Fills task->gradient, and task->point unless NULL; pairs: receives their number, or NULL. */
enum status operator_sums(const struct operator_task *task, uint64_t *pairs, struct error *error);

#endif
