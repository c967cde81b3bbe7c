/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "stress.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "result.h"
#include "stress_part.h"

enum { STEPS_QUICK = 30000, STEPS_NIGHTLY = 3000000 };
/* Budget of steps times n^2, proportional to the cost if few particles interact with all: about a
 * minute. */
static const double work_nightly = 1e11;

/* --- the cells -------------------------------------------------------------------------------- */

/* Appends "KEY=VALUE;KEY=VALUE" to the cell's arguments. */
static enum status add_keys(struct stress_cell *cell, const char *keys, struct error *error)
{
    while (*keys) {
        const size_t length = strcspn(keys, ";");
        if (cell->argument_count == STRESS_ARGUMENTS || length >= STRESS_TEXT)
            return error_set(error, STATUS_BAD_INPUT,
                             "stress %s: more than %d keys, or one of more than %d characters: %s",
                             cell->group->member.name, STRESS_ARGUMENTS, STRESS_TEXT - 1, keys);
        snprintf(cell->arguments[cell->argument_count++], STRESS_TEXT, "%.*s", (int)length, keys);
        keys += length + (keys[length] == ';');
    }
    return STATUS_OK;
}

static bool wanted(const struct stress_group *group, size_t count, char *const *names)
{
    for (size_t i = 0; i < count; i++)
        if (!strcmp(names[i], group->member.name)) return true;
    return count == 0;
}

static bool is_group(const char *name)
{
    for (size_t g = 0; g < stress_group_count; g++)
        if (!strcmp(name, stress_groups[g].member.name)) return true;
    return false;
}

/* Row i of a group's map; false: it has no such row. */
static bool row_at(const struct stress_group *group, size_t i, struct stress_entry *row)
{
    const struct family *family = group->row_family;
    if (family) {
        if (i == family->n) return false;
        *row = (struct stress_entry){.label = family->members[i]->name};
    } else {
        *row = (group->rows ? group->rows : stress_schemes)[i];
    }
    return row->label;
}

static const struct stress_entry *columns_of(const struct stress_group *group)
{
    return group->columns ? group->columns : group->made();
}

static bool is_scheme(const struct stress_cell *cell, size_t i)
{
    return !cell->group->row_family && !cell->group->rows &&
           strcmp(cell->row.label, stress_schemes[i].label) == 0;
}

static void list_cells(struct stress *stress, size_t count, char *const *names)
{
    struct stress_entry row;
    stress->count = 0;
    for (size_t g = 0; g < stress_group_count; g++) {
        const struct stress_group *group = &stress_groups[g];
        if (!wanted(group, count, names)) continue;
        for (size_t r = 0; row_at(group, r, &row); r++)
            for (const struct stress_entry *column = columns_of(group); column->label; column++) {
                if ((row.nightly || column->nightly) && !stress->nightly) continue;
                if (stress->cells)
                    stress->cells[stress->count] =
                        (struct stress_cell){.group = group, .row = row, .column = column};
                stress->count++;
            }
    }
}

static const char *case_of(const struct stress_cell *cell)
{
    return cell->group->case_name ? cell->group->case_name : cell->column->label;
}

static enum status prepare(struct stress_cell *cell, bool nightly, struct error *error)
{
    char *arguments[STRESS_ARGUMENTS], own[2 * STRESS_TEXT];
    const char *row = cell->row.keys;
    if (!row) {
        snprintf(own, sizeof own, "%s=%s", cell->group->row_title, cell->row.label);
        row = own;
    }
    if (add_keys(cell, cell->group->keys, error) || add_keys(cell, cell->column->keys, error) ||
        add_keys(cell, row, error))
        return error->status;
    for (size_t i = 0; i < cell->argument_count; i++) arguments[i] = cell->arguments[i];
    if (run_prepare(&cell->settings, case_of(cell), (int)cell->argument_count, arguments, error))
        return error->status;
    const double n = settings_real(&cell->settings.settings, SETTING_n);
    cell->step_budget =
        nightly ? (uint64_t)fmin(STEPS_NIGHTLY, work_nightly / (n * n)) : STEPS_QUICK;
    return STATUS_OK;
}

/* "sphproof run CASE KEY=VALUE ..." of a cell. */
static void command_of(const struct stress_cell *cell, char command[STRESS_COMMAND])
{
    int used = snprintf(command, STRESS_COMMAND, "sphproof run %s", case_of(cell));
    for (size_t i = 0; i < cell->argument_count && used < STRESS_COMMAND; i++) {
        const char *argument = cell->arguments[i], *quote = strchr(argument, ' ') ? "\"" : "";
        const int key = (int)strcspn(argument, "=") + 1;
        used += snprintf(command + used, (size_t)(STRESS_COMMAND - used), " %.*s%s%s%s", key,
                         argument, quote, argument + key, quote);
    }
}

static const char largest_step[] =
    "largest stable c dt/dx, found by noise runs, of the one predicted";

static const struct {
    enum status (*compute)(const struct stress_cell *cell, json_t **document, struct error *error);
    bool theory;        /* runs must confirm a prediction */
    const char *number; /* what the number of a cell measures */
} kinds[] = {
    [STRESS_RUN] = {stress_run, false, "L1 error of density over its mean"},
    [STRESS_DRIFT] = {stress_run, false, "drift of energy"},
    [STRESS_LIMIT] = {stress_linear, true,
                      "greatest stable width eta, found by noise runs, of the one predicted"},
    [STRESS_STEP] = {stress_linear, true, largest_step},
    [STRESS_PAIRING] = {stress_linear, false,
                        "neighbours from which pairs have less energy, predicted"},
    [STRESS_CLOUD] = {stress_cloud, false, "share of particles in pairs"},
    [STRESS_LATTICE] = {stress_cloud, true,
                        "growth rate of noise in c/dx, measured, of the fastest wave's by theory; "
                        "stable: neither grows. Green: theory and run agree, also where noise "
                        "grows"},
    [STRESS_CLOUD_STEP] = {stress_cloud, true, largest_step},
    [STRESS_AMPLIFY] = {stress_amplify, false, "growth of a difference in the last digits"},
};

static enum status compute(const void *context, json_t **document, struct error *error)
{
    const struct stress_cell *cell = context;
    return kinds[cell->group->kind].compute(cell, document, error);
}

/* --- the pool --------------------------------------------------------------------------------- */

static enum status add_cell(struct stress_cell *cell, struct pool *pool, struct error *error)
{
    char command[STRESS_COMMAND], key[STRESS_COMMAND + 64], name[128];
    command_of(cell, command);
    snprintf(key, sizeof key, "stress %s %s %s %llu %s", cell->group->member.name,
             cell->column->label, cell->row.label, (unsigned long long)cell->step_budget, command);
    snprintf(name, sizeof name, "stress %s: %s, %s", cell->group->member.name, cell->row.label,
             cell->column->label);
    const double n = settings_real(&cell->settings.settings, SETTING_n);
    /* waves of lattices: the forces again for every wavevector, and a run of noise */
    const double each = cell->group->kind == STRESS_LATTICE ? 2e-4 : 2e-5;
    const double line = 1e-6 * n * n, cloud = cell->settings.file.dimension > 1 ? each * n : 0;
    cell->job =
        pool_add(pool, name, key, 0.02 + (cloud > 0 ? cloud * sqrt(n) : line), compute, cell);
    return cell->job == (size_t)-1 ? error_set(error, STATUS_ENVIRONMENT, "no memory for a cell")
                                   : STATUS_OK;
}

enum status stress_plan(struct stress *stress, bool nightly, size_t group_count,
                        char *const *groups, struct pool *pool, struct error *error)
{
    *stress = (struct stress){.nightly = nightly};
    for (size_t i = 0; i < group_count; i++)
        if (!is_group(groups[i])) {
            char allowed[256];
            int used = 0;
            for (size_t g = 0; g < stress_group_count && used < (int)sizeof allowed; g++)
                used += snprintf(allowed + used, sizeof allowed - (size_t)used, " %s",
                                 stress_groups[g].member.name);
            return error_set(error, STATUS_BAD_INPUT, "stress: no group '%.60s'; allowed:%s",
                             groups[i], allowed);
        }
    list_cells(stress, group_count, groups);
    stress->cells = malloc(stress->count * sizeof *stress->cells);
    if (!stress->cells) return error_set(error, STATUS_ENVIRONMENT, "no memory for the cells");
    list_cells(stress, group_count, groups);
    for (size_t i = 0; i < stress->count; i++)
        if (prepare(&stress->cells[i], nightly, error) ||
            add_cell(&stress->cells[i], pool, error)) {
            stress_free(stress);
            return error->status;
        }
    return STATUS_OK;
}

void stress_free(struct stress *stress)
{
    free(stress->cells);
    *stress = (struct stress){0};
}

/* --- judging ---------------------------------------------------------------------------------- */

static json_t *cell_json(const struct stress_cell *cell, const struct pool_job *job)
{
    char command[STRESS_COMMAND];
    json_t *settings = json_object(), *entry = json_object();
    command_of(cell, command);
    result_add(settings, "case=%s", case_of(cell));
    for (size_t i = 0; i < cell->argument_count; i++) {
        const char *argument = cell->arguments[i];
        char key[STRESS_TEXT];
        snprintf(key, sizeof key, "%.*s", (int)strcspn(argument, "="), argument);
        json_object_set_new(settings, key, json_string(argument + strlen(key) + 1));
    }
    result_add(entry, "group=%s row=%s column=%s settings=%p", cell->group->member.name,
               cell->row.label, cell->column->label, (void *)settings);
    if (job->document)
        json_object_update(entry, job->document);
    else {
        char reason[640];
        snprintf(reason, sizeof reason, "%s: %s", stress_outcome_breakdown(job->error.message),
                 job->error.message);
        json_t *outcome = stress_outcome((double)NAN, (double)NAN, "broke_down", reason);
        json_object_update(entry, outcome);
        json_decref(outcome);
    }
    if (kinds[cell->group->kind].theory || cell->group->kind == STRESS_AMPLIFY)
        snprintf(command, sizeof command, "sphproof stress %s", cell->group->member.name);
    if (cell->group->kind == STRESS_PAIRING)
        snprintf(command, sizeof command, "sphproof kernel %s --dim %s", cell->row.label,
                 cell->column->label);
    result_add(entry, "command=%s", command);
    return entry;
}

static json_t *row_labels(const struct stress_group *group, bool nightly)
{
    json_t *list = json_array();
    struct stress_entry row;
    for (size_t i = 0; row_at(group, i, &row); i++)
        if (nightly || !row.nightly) json_array_append_new(list, json_string(row.label));
    return list;
}

static json_t *column_labels(const struct stress_group *group, bool nightly)
{
    json_t *list = json_array();
    for (const struct stress_entry *column = columns_of(group); column->label; column++)
        if (nightly || !column->nightly) json_array_append_new(list, json_string(column->label));
    return list;
}

static json_t *group_json(const struct stress_group *group, bool nightly)
{
    json_t *reproduce =
        json_sprintf("sphproof stress %s%s", group->member.name, nightly ? " --nightly" : "");
    json_t *stable = group->kind == STRESS_LATTICE ? json_real(stress_cloud_slowest) : json_null();
    return result_object("number=%s stable_below=%p name=%s title=%s row_title=%s column_title=%s "
                         "rows=%p columns=%p bound=%g reproduce=%p",
                         kinds[group->kind].number, (void *)stable, group->member.name,
                         group->member.label, group->row_title ? group->row_title : "scheme",
                         group->column_title, (void *)row_labels(group, nightly),
                         (void *)column_labels(group, nightly), group->bound, (void *)reproduce);
}

static const char *outcome_of(const json_t *entry)
{
    return json_string_value(json_object_get(entry, "outcome"));
}

/* True if the outcome fails the map: a theory that runs do not confirm, an undetected NaN, a crash,
 * refused settings, a breakdown where every scheme must survive, or round-off amplified by the
 * default scheme unless that is known. */
static bool is_wrong(const struct stress_cell *cell, const json_t *entry)
{
    const char *outcome = outcome_of(entry),
               *reason = json_string_value(json_object_get(entry, "reason"));
    const enum stress_kind kind = cell->group->kind;
    const bool theory = kinds[kind].theory;
    const bool amplified = kind == STRESS_AMPLIFY && is_scheme(cell, 0) && !cell->group->known;
    const bool lost = cell->group->survives && strcmp(outcome, "broke_down") == 0;
    return lost || strncmp(reason, "silent NaN", 10) == 0 || strncmp(reason, "crash", 5) == 0 ||
           strcmp(outcome, "refused") == 0 || ((theory || amplified) && strcmp(outcome, "ok") != 0);
}

static void add_failure(json_t *document, const json_t *entry, const char *detail)
{
    json_t *list = json_object_get(document, "failures");
    json_array_append_new(
        list,
        json_pack("{s:o, s:o, s:O}", "name",
                  json_sprintf("%s: %s, %s", json_string_value(json_object_get(entry, "group")),
                               json_string_value(json_object_get(entry, "row")),
                               json_string_value(json_object_get(entry, "column"))),
                  "detail",
                  json_sprintf("%s%s", detail, json_string_value(json_object_get(entry, "reason"))),
                  "command", json_object_get(entry, "command")));
}

/* Adds "comparison" and a failure for each breakdown that the seed program's method survives. */
static void compare(const struct stress *stress, const json_t *cells, json_t *document)
{
    json_t *lost = json_array();
    size_t both = 0, only_default = 0, only_seed = 0, none = 0;
    for (size_t i = 0; i < stress->count; i++) {
        const struct stress_cell *cell = &stress->cells[i];
        if (!is_scheme(cell, 0)) continue;
        for (size_t j = i + 1; j < stress->count; j++) {
            const struct stress_cell *other = &stress->cells[j];
            if (!is_scheme(other, 1) || other->column != cell->column) continue;
            const json_t *mine = json_array_get(cells, i), *theirs = json_array_get(cells, j);
            const bool survives = strcmp(outcome_of(mine), "broke_down") != 0;
            const bool seed_survives = strcmp(outcome_of(theirs), "broke_down") != 0;
            if (!survives && seed_survives) {
                json_array_append_new(lost, json_deep_copy(mine));
                add_failure(document, mine, "the seed program's method survives this; ");
            }
            *(survives        ? seed_survives ? &both : &only_default
              : seed_survives ? &only_seed
                              : &none) += 1;
        }
    }
    json_object_set_new(document, "comparison",
                        result_object("both_survive=%zu only_default_survives=%zu "
                                      "only_seed_survives=%zu both_break=%zu lost=%p",
                                      both, only_default, only_seed, none, (void *)lost));
}

size_t stress_judge(const struct stress *stress, const struct pool *pool, json_t *document)
{
    json_t *cells = json_array(), *groups = json_array(), *counts = json_object();
    const struct stress_group *last = NULL;
    bool theory = false;
    json_object_set_new(document, "failures", json_array());
    for (size_t i = 0; i < stress->count; i++) {
        const struct stress_cell *cell = &stress->cells[i];
        json_t *entry = cell_json(cell, &pool->jobs[cell->job]);
        const char *outcome = outcome_of(entry);
        const json_int_t count = json_integer_value(json_object_get(counts, outcome));
        json_object_set_new(counts, outcome, json_integer(count + 1));
        if (is_wrong(cell, entry)) add_failure(document, entry, "");
        theory = theory || cell->group->kind == STRESS_LIMIT;
        if (cell->group != last)
            json_array_append_new(groups, group_json(cell->group, stress->nightly));
        last = cell->group;
        json_array_append_new(cells, entry);
    }
    json_object_set_new(document, "cells", cells);
    json_object_set_new(document, "groups", groups);
    if (theory) json_object_set_new(document, "atlas", stress_linear_atlas());
    compare(stress, cells, document);
    const size_t wrong = json_array_size(json_object_get(document, "failures"));
    result_add(counts, "wrong=%zu", wrong);
    json_object_set_new(document, "summary", counts);
    return wrong;
}
