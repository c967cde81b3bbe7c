/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "claims.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "result.h"
#include "run_job.h"
#include "value.h"

enum { ROWS_MAX = 6, COMMAND_TEXT = 512 };

/* Errors that differ by less than this factor count as equal. */
static const double matters = 1.25;

static const struct claim {
    const char *name, *text, *case_name;
    const char *day, *night;        /* sizes */
    const char *without, *with;     /* the claim: `with` is better */
    const char *figure;             /* name of a functional */
    const char *rows[ROWS_MAX + 1]; /* keys of both */
} claims_made[] = {
    {"ia_shear",
     "The gradient ia follows the growing mode of a shear layer more closely than the standard "
     "gradient does, at equal viscosity.",
     "kelvin_helmholtz_mode",
     "n=20^2",
     "n=64^2",
     "gradient=standard",
     "gradient=ia",
     "growth_rate",
     {"kernel=cubic_spline viscosity=constant", "kernel=cubic_spline viscosity=constant balsara=on",
      "kernel=cubic_spline viscosity=projected", "kernel=wendland_c4 viscosity=constant",
      "kernel=wendland_c4 viscosity=constant balsara=on",
      "kernel=wendland_c4 viscosity=projected"}},
    {"ia_stratified",
     "The gradient ia follows the growing mode of dense gas over thin gas more closely than the "
     "standard gradient does, at equal viscosity.",
     "rayleigh_taylor_mode",
     "n=512 t_end=1.2",
     "n=8192",
     "gradient=standard",
     "gradient=ia",
     "growth_rate",
     {"kernel=cubic_spline viscosity=constant", "kernel=cubic_spline viscosity=projected",
      "kernel=wendland_c4 viscosity=constant", "kernel=wendland_c4 viscosity=projected"}},
    {"energy_square",
     "The volume element energy keeps a square of dense gas at rest in gas of the same pressure "
     "better than the volume element mass does.",
     "square",
     "n=20^2 t_end=0.3",
     "n=64^2",
     "volume_element=mass",
     "volume_element=energy",
     "velocity_rms",
     {"jitter=0.05 gradient=standard", "jitter=0.05 gradient=ia",
      "equal_masses=yes gradient=standard", "equal_masses=yes gradient=ia"}},
    {"blended_square",
     "The gradient blended keeps a square of equal masses at rest better than the gradient ia "
     "does.",
     "square",
     "n=32^2",
     "n=64^2",
     "gradient=ia",
     "gradient=blended",
     "velocity_rms",
     {"equal_masses=yes", "equal_masses=yes jitter=0.05"}},
};
enum { CLAIMS = sizeof claims_made / sizeof *claims_made };

enum status claim_run_add(struct claim_run *of, const char *case_name, struct pool *pool,
                          struct error *error)
{
    struct run_settings settings;
    if (run_prepare(&settings, case_name, 0, NULL, error) ||
        settings_apply_words(&settings.settings, of->keys, error) ||
        run_resolve(&of->run, &settings, error))
        return error->status;
    return run_job_add(pool, &of->run, &of->job, error);
}

enum status claims_plan(struct claims *claims, bool nightly, struct pool *pool, struct error *error)
{
    claims->runs = calloc((size_t)2 * CLAIMS * ROWS_MAX, sizeof *claims->runs);
    if (!claims->runs) return error_set(error, STATUS_ENVIRONMENT, "no memory for claims");
    for (size_t c = 0; c < CLAIMS; c++) {
        const struct claim *claim = &claims_made[c];
        const char *size = nightly ? claim->night : claim->day;
        for (const char *const *row = claim->rows; *row; row++)
            for (int side = 0; side < 2; side++) {
                struct claim_run *of = &claims->runs[claims->count++];
                snprintf(of->keys, sizeof of->keys, "%s %s %s", size, *row,
                         side ? claim->with : claim->without);
                if (claim_run_add(of, claim->case_name, pool, error)) return error->status;
            }
    }
    return STATUS_OK;
}

/* Error of a run's figure; infinite if the run broke down, NaN if it has no such figure. */
static double error_of(const struct claim *claim, const struct claim_run *run,
                       const struct pool *pool)
{
    const json_t *document = pool->jobs[run->job].document;
    if (!document || strcmp(value_text(document, "status"), "ok") != 0) return (double)INFINITY;
    const json_t *entry = value_named(json_object_get(document, "functionals"), claim->figure);
    const double value = value_member(entry, "value"), exact = value_member(entry, "reference");
    return exact != 0 ? fabs(value / exact - 1) : fabs(value);
}

enum answer { HOLDS, SAME, FAILS, NOTHING, ANSWERS };

static enum answer compare(double without, double with)
{
    if (isnan(with) || isnan(without) || (isinf(with) && isinf(without))) return NOTHING;
    if (isinf(with)) return FAILS;
    return with * matters < without ? HOLDS : with > without * matters ? FAILS : SAME;
}

static json_t *row_json(const struct claim *claim, const char *row, const struct claim_run *runs,
                        const struct pool *pool, size_t counts[ANSWERS])
{
    static const char *const words[] = {"holds", "no difference", "does not hold",
                                        "nothing to compare"};
    const double without = error_of(claim, &runs[0], pool), with = error_of(claim, &runs[1], pool);
    const enum answer answer = compare(without, with);
    char command[COMMAND_TEXT];
    snprintf(command, sizeof command, "sphproof run %s %s", claim->case_name, runs[1].keys);
    counts[answer]++;
    json_t *of = json_object();
    result_add(of, "label=%s figure=%s without=%g with=%g verdict=%s reproduce=%s", row,
               claim->figure, without, with, words[answer], command);
    return of;
}

json_t *claims_judge(const struct claims *claims, const struct pool *pool)
{
    const struct claim_run *runs = claims->runs;
    json_t *list = json_array();
    for (size_t c = 0; c < CLAIMS; c++) {
        const struct claim *claim = &claims_made[c];
        size_t counts[ANSWERS] = {0}, all = 0;
        char verdict[96];
        json_t *rows = json_array(), *of = json_object();
        for (const char *const *row = claim->rows; *row; row++, runs += 2, all++)
            json_array_append_new(rows, row_json(claim, *row, runs, pool, counts));
        if (counts[HOLDS] == all)
            snprintf(verdict, sizeof verdict, "holds");
        else if (counts[NOTHING] == all)
            snprintf(verdict, sizeof verdict, "not shown: nothing to compare");
        else if (counts[HOLDS] == 0)
            snprintf(verdict, sizeof verdict, "does not hold");
        else
            snprintf(verdict, sizeof verdict, "holds in %zu of %zu, the opposite in %zu",
                     counts[HOLDS], all, counts[FAILS]);
        result_add(of, "name=%s claim=%s without=%s with=%s verdict=%s rows=%p", claim->name,
                   claim->text, claim->without, claim->with, verdict, (void *)rows);
        json_array_append_new(list, of);
    }
    return list;
}

void claims_free(struct claims *claims)
{
    free(claims->runs);
    *claims = (struct claims){0};
}
