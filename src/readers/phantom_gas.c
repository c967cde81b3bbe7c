/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "phantom_gas.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { GAS = 1 };

static enum status check_header(const char *path, const struct phantom_header *header,
                                struct error *error)
{
    char mass[40] = "is no number", hfact[40] = "is no number";
    if (header->types) snprintf(mass, sizeof mass, "begins with %g", header->masses[0]);
    if (header->hfact.known) snprintf(hfact, sizeof hfact, "is %g", header->hfact.value);
    if (header->types && header->masses[0] > 0 && header->hfact.known && header->hfact.value > 0)
        return STATUS_OK;
    return error_set(error, STATUS_BAD_INPUT,
                     "%.200s: Phantom's density is m (hfact/h)^3: the header's massoftype %s, its "
                     "hfact %s; allowed: above 0",
                     path, mass, hfact);
}

/* Orders the rows: live gas first, then the other live particles. */
static void sort_rows(struct snapshot_file *file, const double *type, size_t *row, double *sorted)
{
    const double *h = file->column[SNAPSHOT_H];
    size_t n = 0;
    for (int pass = 0; pass < 2; pass++) {
        for (size_t i = 0; i < file->n; i++)
            if (!(h[i] <= 0) && (!type || fabs(type[i]) == GAS) == !pass) row[n++] = i;
        if (!pass) file->gas = n;
    }
    for (int c = 0; c < SNAPSHOT_COLUMNS; c++) {
        double *column = file->column[c];
        if (!column) continue;
        for (size_t k = 0; k < n; k++) sorted[k] = column[row[k]];
        memcpy(column, sorted, n * sizeof *column);
    }
    if (n < file->n) {
        char value[64];
        snprintf(value, sizeof value, "%zu of %zu rows left out", file->n - n, file->n);
        snapshot_note(&file->notes, "dead particles", value, "their h is not above 0");
    }
    file->n = n;
}

static void take_box(const struct phantom_header *header, struct snapshot_file *file)
{
    if (!header->boxed) return;
    for (int d = 0; d < 3; d++) {
        if (!isfinite(header->hi[d] - header->lo[d])) return;
        for (size_t i = 0; i < file->n; i++)
            if (!(file->column[d][i] >= header->lo[d] && file->column[d][i] <= header->hi[d]))
                return;
    }
    file->boxed = file->placed = true;
    for (int d = 0; d < 3; d++)
        file->corner[d] = header->lo[d], file->box[d] = header->hi[d] - header->lo[d];
}

enum status phantom_gas(const char *path, const struct phantom_header *header, const double *type,
                        struct snapshot_file *file, struct error *error)
{
    const bool lacks = !file->column[SNAPSHOT_RHO];
    if (check_header(path, header, error)) return error->status;
    size_t *row = malloc(file->n * sizeof *row);
    double *sorted = malloc(file->n * sizeof *sorted);
    const bool there = row && sorted && !snapshot_file_make(file, SNAPSHOT_M, path, error) &&
                       !(lacks && snapshot_file_make(file, SNAPSHOT_RHO, path, error));
    for (size_t i = 0; i < file->n && there; i++) {
        const double t = type ? fabs(type[i]) : GAS;
        const double m = t >= 1 && t <= header->types ? header->masses[(int)t - 1] : 0;
        file->column[SNAPSHOT_M][i] = m > 0 ? m : header->masses[0];
        if (lacks)
            file->column[SNAPSHOT_RHO][i] =
                file->column[SNAPSHOT_M][i] *
                pow(header->hfact.value / file->column[SNAPSHOT_H][i], 3);
    }
    if (there) sort_rows(file, type, row, sorted);
    free(row);
    free(sorted);
    if (!there) return error_set(error, STATUS_ENVIRONMENT, "no memory for %.200s", path);
    if (lacks)
        snapshot_note(&file->notes, "density", "m (hfact/h)^3", "the file stores none; hfact = %g",
                      header->hfact.value);
    file->time = header->time;
    file->gamma = header->gamma;
    if (file->gamma.known) snapshot_note(&file->notes, "gamma", "in the file", "its header");
    take_box(header, file);
    return STATUS_OK;
}
