/* SPDX-License-Identifier: GPL-3.0-or-later
 * Fuzzes CSV files as point clouds in 1, 2 and 3 dimensions. For accepted ones every operator must
 * give numbers, or a state that says why not. */
#include <math.h>
#include <stdlib.h>

#include "fuzz.h"
#include "point_cloud.h"

enum { POINTS_MAX = 256, FIELDS_MAX = 4 };

static void apply(const struct point_cloud *pc, const struct operator_form *form)
{
    struct kernel kernel;
    struct error error = {0};
    const size_t n = pc->cloud.points.n, fields = pc->fields < FIELDS_MAX ? pc->fields : FIELDS_MAX;
    const size_t dim = (size_t)pc->cloud.points.dim;
    double *gradient[3 * FIELDS_MAX];
    struct operator_point *point = calloc(n, sizeof *point);
    double *storage = calloc(3 * FIELDS_MAX * n, sizeof *storage);
    if (!point || !storage) exit(STATUS_ENVIRONMENT);
    for (size_t k = 0; k < 3 * FIELDS_MAX; k++) gradient[k] = storage + k * n;
    FUZZ_PROMISE(!kernel_select(&kernel, "wendland_c2", 0, &error));
    const struct operator_settings settings = {.form = form, .kernel = &kernel, .threads = 1};
    const enum status status =
        operator_apply(&settings, &pc->cloud, fields, pc->field, gradient, point, NULL, &error);
    if (status)
        fuzz_refused(status, &error);
    else
        for (size_t i = 0; i < n; i++)
            for (size_t k = 0; k < fields * dim; k++)
                FUZZ_PROMISE(!isnan(gradient[k][i]) || point[i].state != OPERATOR_OK);
    free(point);
    free(storage);
}

void fuzz_one(const uint8_t *bytes, size_t size)
{
    const char *path = fuzz_file(bytes, size);
    for (int dim = 1; dim <= 3; dim++) {
        struct point_cloud pc;
        struct error error = {0};
        const enum status status = point_cloud_read(path, dim, 2, 0, &pc, &error);
        if (status)
            fuzz_refused(status, &error);
        else if (pc.cloud.points.n <= POINTS_MAX)
            for (size_t k = 0; k < operator_family.n; k++)
                apply(&pc, (const struct operator_form *)operator_family.members[k]);
        point_cloud_free(&pc);
    }
}
