/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "snapshot_csv.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "conventions.h"
#include "text.h"

static enum status scale_widths(struct snapshot_file *file, char why[200], struct error *error)
{
    const struct width_meaning unknown = {0};
    struct conventions found;
    double box[3] = {0};
    for (int d = 0; d < file->dim; d++) box[d] = snapshot_period(file, d);
    if (conventions_find(file, box, NULL, &unknown, &found, error)) return error->status;
    snprintf(why, 200, "%s", found.why);
    if (!file->column[SNAPSHOT_H]) return STATUS_OK;
    if (!found.known) {
        free(file->column[SNAPSHOT_H]);
        file->column[SNAPSHOT_H] = NULL;
        return STATUS_OK;
    }
    for (size_t i = 0; i < file->n; i++) file->column[SNAPSHOT_H][i] *= found.candidate[0].ratio;
    return STATUS_OK;
}

enum status snapshot_csv_named(const char *path, struct snapshot_file *said, struct csv *csv,
                               char unknown[200], struct error *error)
{
    unknown[0] = '\0';
    if (csv_read(path, csv, error) || csv_comments(path, said, error)) return error->status;
    for (size_t k = 0; k < csv->columns; k++) {
        const int column = snapshot_column_of(csv->names[k]);
        const char *ours = column < 0 ? NULL : snapshot_column_names[column];
        if (!ours) text_add(unknown, 200, "%s%s", *unknown ? " " : "", csv->names[k]);
        if (!ours || csv_column(csv, ours) >= 0) continue;
        free(csv->names[k]);
        if (!(csv->names[k] = strdup(ours)))
            return error_set(error, STATUS_ENVIRONMENT, "no memory for %.200s", path);
    }
    return STATUS_OK;
}

enum status snapshot_csv(const char *path, struct snapshot_file *file, struct csv *csv,
                         char why[200], struct error *error)
{
    const struct snapshot_options plain = {0};
    *csv = (struct csv){0};
    if (snapshot_read(path, &plain, file, error) || snapshot_check_gas(path, file, error) ||
        scale_widths(file, why, error))
        return error->status;
    csv->line = calloc(file->gas, sizeof *csv->line);
    if (!csv->line) return error_set(error, STATUS_ENVIRONMENT, "no memory for %.200s", path);
    csv->rows = csv->capacity = file->gas;
    for (size_t i = 0; i < file->gas; i++) csv->line[i] = i + 1;
    for (int c = 0; c < SNAPSHOT_COLUMNS; c++) {
        if (!file->column[c] || (c < SNAPSHOT_M && c % 3 >= file->dim)) continue;
        if (!(csv->names[csv->columns] = strdup(snapshot_column_names[c])))
            return error_set(error, STATUS_ENVIRONMENT, "no memory for %.200s", path);
        csv->values[csv->columns++] = file->column[c];
        file->column[c] = NULL;
    }
    return STATUS_OK;
}
