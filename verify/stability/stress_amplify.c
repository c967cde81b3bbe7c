/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "stress_part.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#define MOVED "1e-13" /* in spacings: slightly more than the rounding of positions */

static enum status run_cell(const struct stress_cell *cell, const char *jitter,
                            struct run_result *result, struct error *error)
{
    struct run_settings settings = cell->settings;
    struct run run;
    char key[32], *arguments[] = {key};
    snprintf(key, sizeof key, "jitter=%s", jitter);
    if (settings_apply(&settings.settings, 1, arguments, error) ||
        run_resolve(&run, &settings, error))
        return error->status;
    return run_execute(&run, result, error);
}

static double change(const struct run_result *a, const struct run_result *b, enum field *of)
{
    double most = 0;
    for (enum field field = 0; field < FIELDS; field++) {
        const double pairs[][2] = {{a->errors[field].l1, b->errors[field].l1},
                                   {a->errors[field].l2, b->errors[field].l2}};
        for (size_t k = 0; k < sizeof pairs / sizeof *pairs; k++) {
            const double by = fabs(pairs[k][0] / pairs[k][1] - 1);
            if (isnan(by)) return by;
            if (by <= most) continue;
            most = by;
            *of = field;
        }
    }
    return most;
}

/* The growth of the change and its field; both runs must finish. */
static enum status measure(const struct stress_cell *cell, double *grown, enum field *of,
                           struct error *error)
{
    struct run_result still, moved;
    enum status status = run_cell(cell, "0", &still, error);
    if (status && status != STATUS_BROKE_DOWN) return status;
    if (!status) {
        status = run_cell(cell, MOVED, &moved, error);
        if (!status) *grown = change(&still, &moved, of) / strtod(MOVED, NULL);
        if (!status || status == STATUS_BROKE_DOWN) run_free(&moved);
    }
    run_free(&still);
    return status;
}

enum status stress_amplify(const struct stress_cell *cell, json_t **document, struct error *error)
{
    char reason[768] = "";
    enum field field = 0;
    double grown = (double)NAN;
    const char *known = cell->group->known, *outcome = "ok";
    const enum status status = measure(cell, &grown, &field, error);
    if (status && status != STATUS_BROKE_DOWN && status != STATUS_BAD_INPUT) return status;
    if (status) {
        outcome = status == STATUS_BROKE_DOWN ? "broke_down" : "refused";
        snprintf(reason, sizeof reason, "%s: %s", stress_outcome_breakdown(error->message),
                 error->message);
    } else if (!(grown <= cell->group->bound)) {
        outcome = "inaccurate";
        snprintf(reason, sizeof reason,
                 "moved by " MOVED " of the spacing, %.1e times that in an error of %s%s%s", grown,
                 field_family.members[field]->name, known ? "; known: " : "", known ? known : "");
    }
    *document = stress_outcome((double)NAN, grown, outcome, reason);
    return STATUS_OK;
}
