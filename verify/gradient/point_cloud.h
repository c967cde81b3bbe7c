/* SPDX-License-Identifier: GPL-3.0-or-later
 * Reads a point cloud from a CSV file: columns x[,y,z],volume first, then one column for each
 * field, and anywhere among these an optional column h, the support radius. */
#pragma once

#include "csv.h"
#include "operator.h"

struct point_cloud {
    struct csv csv;
    struct cloud cloud; /* points into csv and h */
    double *h;
    size_t fields;
    const double *field[CSV_COLUMNS_MAX]; /* into csv */
    const char *name[CSV_COLUMNS_MAX];
};

/* eta, h: the user's values, 0 if not given; a column h takes precedence, then h for all points,
 * then h = eta volume^(1/dim). STATUS_BAD_INPUT: the message names file, line and column. Call
 * point_cloud_free even after a failure. */
enum status point_cloud_read(const char *path, int dim, double eta, double h,
                             struct point_cloud *cloud, struct error *error);
void point_cloud_free(struct point_cloud *cloud);
