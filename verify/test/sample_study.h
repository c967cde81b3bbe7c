/* SPDX-License-Identifier: GPL-3.0-or-later
 * Studies of made-up runs, whose errors and functionals fall with the spacing by known orders. A
 * test may change them before they are judged. Include after test.h. */
#pragma once

#include "problem_list.h"
#include "study.h"

enum { LEVELS = 4 };
static size_t ladder[CASE_LADDER_MAX] = {40, 80, 160, 320}, level_count = LEVELS;

/* Spacing and error of the run at a level and replicate. */
static inline double spacing_of(size_t l, size_t r)
{
    return 2. / (double)ladder[l] * (1 + 0.02 * (double)r);
}

/* Errors of order 1 + f/10 + m/100, with a factor for each replicate. */
static inline double error_at(int f, int m, size_t l, size_t r)
{
    static const double scatter[] = {1, 1.1, 0.95, 1.02};
    return (0.01 + 0.001 * m) * pow(spacing_of(l, r), 1 + 0.1 * f + 0.01 * m) * scatter[r] *
           (1 + 0.01 * (double)(l % 2));
}

static inline json_t *norms(int f, size_t l, size_t r)
{
    json_t *object = json_object();
    for (int m = 0; m < NORMS; m++)
        json_object_set_new(object, field_norm_family.members[m]->name,
                            json_real(error_at(f, m, l, r)));
    return object;
}

static inline double functional_at(size_t l, size_t r)
{
    return 0.5 + 0.3 * pow(spacing_of(l, 0), 2) * (l == 0 ? 1.25 : 1) + 0.001 * (double)r;
}

static inline json_t *run_document(const struct study *study, size_t l, size_t r)
{
    const struct problem *problem = problem_of(&study->settings.settings);
    json_t *errors = json_object(), *functionals = json_array();
    for (int f = 0; f < FIELDS; f++)
        json_object_set_new(errors, field_family.members[f]->name, norms(f, l, r));
    json_object_set_new(errors, "binned_density_l1", json_real(error_at(7, 0, l, r)));
    if (problem->circular == CIRCULAR_ROUND) {
        json_object_set_new(errors, "azimuthal", norms(4, l, r));
        json_object_set_new(errors, "radial", norms(5, l, r));
    }
    for (int i = 0; problem->functionals[i]; i++)
        json_array_append_new(functionals,
                              json_pack("{s:s, s:f, s:o}", "name", problem->functionals[i]->name,
                                        "value", functional_at(l, r) + i, "reference",
                                        i == 2 ? json_null() : json_real(0.5 + i)));
    json_t *budget = json_null();
    if (problem->regions) {
        budget = json_pack("{s:f}", "still", 1e-6 * (double)(l + 1));
        for (int k = 0; problem->regions->names[k]; k++) {
            json_t *fields = json_object();
            for (int f = 0; f < FIELDS; f++)
                json_object_set_new(
                    fields, field_family.members[f]->name,
                    json_real(k == 1 && l == 2 ? 0 : (k + 1) * error_at(f, 0, l, r)));
            json_object_set_new(budget, problem->regions->names[k], fields);
        }
    }
    static const int away[] = {0, 4, -4, 2};
    return json_pack(
        "{s:I, s:f, s:f, s:o, s:{s:f}, s:o, s:o, s:s}", "n", (json_int_t)ladder[l] + away[r],
        "spacing", spacing_of(l, r), "h", 3 * spacing_of(l, r), "errors", errors, "cost", "cpu_s",
        10. * (double)l + (double)r, "budget", budget, "functionals", functionals, "suspicion", "");
}

typedef void tamper(json_t *run, size_t c, size_t l, size_t r);

/* A study of a case whose runs have these spacings and errors. */
static inline enum status make(struct study *study, struct pool *pool, const char *name,
                               const char *vary, size_t replicates, tamper *tampering,
                               struct error *error)
{
    *study = (struct study){.level_count = level_count, .replicates = replicates};
    memcpy(study->ladder, ladder, sizeof ladder);
    if (run_prepare(&study->settings, name, 0, NULL, error) ||
        sweep_parse(&study->sweep, vary, error))
        fail_msg("%s", error->message);
    study->settings.file.ladder_count = 0; /* bounds are those of the gates */
    const size_t runs = study->sweep.count * level_count * replicates;
    study->results = calloc(study->sweep.count, sizeof *study->results);
    study->runs = calloc(runs, sizeof *study->runs);
    study->jobs = calloc(runs, sizeof *study->jobs);
    *pool = (struct pool){.jobs = calloc(runs, sizeof *pool->jobs), .count = runs};
    for (size_t c = 0; c < study->sweep.count; c++) {
        struct run_settings settings = study->settings;
        struct run run;
        assert_int_equal(sweep_apply(&study->sweep, c, &settings, error), STATUS_OK);
        study->results[c].excluded = run_resolve(&run, &settings, error);
        if (study->results[c].excluded) continue;
        study->results[c].settings = run.settings;
        study->results[c].scheme = run.scheme;
        for (size_t l = 0; l < level_count; l++)
            for (size_t r = 0; r < replicates; r++) {
                const size_t k = (c * level_count + l) * replicates + r, job = runs - 1 - k;
                study->jobs[k] = job; /* in any order */
                pool->jobs[job] = (struct pool_job){
                    .name = strdup("run"), .done = true, .document = run_document(study, l, r)};
                if (tampering) tampering(pool->jobs[job].document, c, l, r);
            }
    }
    *error = (struct error){0};
    return study_judge(study, pool, error);
}

static inline struct study made(const char *name, const char *vary, size_t replicates,
                                tamper *tampering)
{
    struct study study;
    struct pool pool;
    struct error error;
    if (make(&study, &pool, name, vary, replicates, tampering, &error))
        fail_msg("%s", error.message);
    pool_free(&pool);
    return study;
}
