/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "point_cloud.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static enum status find_columns(const char *path, int dim, struct point_cloud *pc,
                                struct error *error)
{
    static const char *const header[] = {"x,volume", "x,y,volume", "x,y,z,volume"};
    static const char *const axes[] = {"x", "y", "z"};
    const struct csv *csv = &pc->csv;
    for (int a = 0; a <= dim; a++) {
        const char *wanted = a < dim ? axes[a] : "volume";
        const char *found = (size_t)a < csv->columns ? csv->names[a] : "nothing";
        if (strcmp(wanted, found) != 0)
            return error_set(
                error, STATUS_BAD_INPUT,
                "%.200s: column %d is '%.40s'; with --dim %d the columns begin with %s", path,
                a + 1, found, dim, header[dim - 1]);
        if (a < dim) pc->cloud.points.x[a] = csv->values[a];
    }
    pc->cloud.volume = csv->values[dim];
    for (size_t c = (size_t)dim + 1; c < csv->columns; c++) {
        if (strcmp(csv->names[c], "h") == 0) continue;
        pc->field[pc->fields] = csv->values[c];
        pc->name[pc->fields++] = csv->names[c];
    }
    return STATUS_OK;
}

enum status point_cloud_read(const char *path, int dim, double eta, double h,
                             struct point_cloud *pc, struct error *error)
{
    *pc = (struct point_cloud){0};
    enum status status = csv_read(path, &pc->csv, error);
    if (status) return status;
    const struct csv *csv = &pc->csv;
    if (csv->rows == 0)
        return error_set(error, STATUS_BAD_INPUT, "%.200s: no points after the column names", path);
    if ((status = find_columns(path, dim, pc, error))) return status;
    const int column = csv_column(csv, "h");
    if (column < 0 && !(h > 0) && !(eta > 0))
        return error_set(error, STATUS_BAD_INPUT,
                         "%.200s: no support radius: give --eta or --h, or a column h", path);
    if (!(pc->h = malloc(csv->rows * sizeof *pc->h)))
        return error_set(error, STATUS_ENVIRONMENT, "no memory for %zu points", csv->rows);
    for (size_t i = 0; i < csv->rows; i++) {
        if (!(pc->cloud.volume[i] > 0))
            return error_set(error, STATUS_BAD_INPUT, "%.200s:%zu: volume %g; it must be positive",
                             path, csv->line[i], pc->cloud.volume[i]);
        pc->h[i] = column >= 0 ? csv->values[column][i]
                   : h > 0     ? h
                               : eta * pow(pc->cloud.volume[i], 1. / dim);
        if (!(pc->h[i] > 0 && isfinite(pc->h[i])))
            return error_set(error, STATUS_BAD_INPUT,
                             "%.200s:%zu: support radius h = %g; it must be positive", path,
                             csv->line[i], pc->h[i]);
    }
    pc->cloud.points.dim = dim;
    pc->cloud.points.n = csv->rows;
    pc->cloud.h = pc->h;
    return STATUS_OK;
}

void point_cloud_free(struct point_cloud *pc)
{
    csv_free(&pc->csv);
    free(pc->h);
    *pc = (struct point_cloud){0};
}
