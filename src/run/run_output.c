/* SPDX-License-Identifier: GPL-3.0-or-later
 * A run's result as JSON and as a snapshot. */

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "judged.h"
#include "result.h"
#include "run_output.h"
#include "snapshot_writer.h"

static json_t *norms_json(const struct norms *of, bool known)
{
    const double values[NORMS] = {of->l1, of->l2, of->linf, of->particle_mean, of->l1_whole};
    json_t *norms = json_object();
    for (int norm = 0; norm < NORMS; norm++)
        json_object_set_new(norms, field_norm_family.members[norm]->name,
                            known ? result_number(values[norm]) : json_null());
    return norms;
}

static bool is_interpolated(const double interpolation[FIELDS])
{
    bool any = false;
    for (int field = 0; field < FIELDS; field++) any |= isfinite(interpolation[field]) != 0;
    return any;
}

void run_interpolation_text(const double interpolation[FIELDS], char *text, size_t size)
{
    size_t used = 0;
    text[0] = '\0';
    if (!is_interpolated(interpolation)) return;
    for (int field = 0; field < FIELDS && used < size; field++)
        if (isfinite(interpolation[field]))
            used += (size_t)snprintf(text + used, size - used, "%s%s %.2g",
                                     used ? ", "
                                          : "the reference is a table: with every second "
                                            "row left out it misses the others by a mean of ",
                                     field_family.members[field]->name, interpolation[field]);
}

/* Adds "interpolation": the interpolation error of a table by field. */
static void add_interpolation(json_t *errors, const double interpolation[FIELDS])
{
    json_t *object = json_object();
    for (int field = 0; field < FIELDS; field++)
        json_object_set_new(object, field_family.members[field]->name,
                            result_number_or_null(interpolation[field]));
    json_object_set_new(errors, "interpolation", object);
}

json_t *run_errors_json(const struct run_result *result)
{
    const struct problem *problem = result->problem.problem;
    json_t *errors = json_object();
    for (int field = 0; field < FIELDS; field++)
        json_object_set_new(
            errors, field_family.members[field]->name,
            norms_json(&result->errors[field], problem_knows(problem, (enum field)field)));
    if (problem_is_circular(&result->problem)) {
        json_object_set_new(errors, "azimuthal", norms_json(&result->azimuthal, true));
        json_object_set_new(errors, "radial", norms_json(&result->radial, true));
    }
    json_object_set_new(errors, "binned_density_l1",
                        result->problem.domain.dim == 1 && problem_knows(problem, FIELD_DENSITY)
                            ? result_number(result->binned_density_l1)
                            : json_null());
    if (problem->user == USER_TABLE) add_interpolation(errors, result->interpolation);
    return errors;
}

void run_add_motion(const struct run_result *result, const struct trace_motion *motion,
                    json_t *conservation)
{
    const bool steady = result->problem.problem->steady;
    result_add(conservation, "ke_rebound=%g? ke_asymmetry=%g? centre=%g?",
               steady ? motion->rebound : (double)NAN, steady ? motion->asymmetry : (double)NAN,
               motion->centre / result->spacing);
}

json_t *run_budget_json(const struct budget *budget)
{
    if (!budget->regions) return json_null();
    json_t *object = json_object();
    for (size_t r = 0; budget->regions->names[r]; r++) {
        json_t *fields = json_object();
        for (int f = 0; f < FIELDS; f++)
            json_object_set_new(fields, field_family.members[f]->name,
                                result_number(budget->l1[r][f]));
        json_object_set_new(object, budget->regions->names[r], fields);
    }
    result_add(object, "still=%g?", budget->still);
    return object;
}

static json_t *position_json(int dim, const double x[3])
{
    json_t *array = json_array();
    for (int d = 0; d < dim; d++) json_array_append_new(array, json_real(x[d]));
    return array;
}

json_t *run_window_json(const struct window *window)
{
    if (window->radius > 0)
        return result_object("centre=%p radius=%g",
                             (void *)position_json(window->dim, window->centre), window->radius);
    if (window->dim == 1) return json_pack("[f, f]", window->lo[0], window->hi[0]);
    return result_object("lo=%p hi=%p", (void *)position_json(window->dim, window->lo),
                         (void *)position_json(window->dim, window->hi));
}

json_t *run_drift_json(int dim, const struct trace_drift *drift)
{
    json_t *angular = dim == 1 ? json_null() : result_number(drift->angular_momentum);
    return result_object("mass=%g momentum=%g angular_momentum=%p energy=%g", drift->mass,
                         drift->momentum, (void *)angular, drift->energy);
}

static json_t *conservation_json(const struct run_result *result)
{
    json_t *object = run_drift_json(result->problem.domain.dim, &result->drift);
    run_add_motion(result, &result->motion, object);
    return object;
}

static json_t *cost_json(const struct run_result *result)
{
    const struct simulation_cost *cost = &result->cost;
    return json_pack(
        "{s:o, s:o, s:I, s:I, s:I, s:I, s:I, s:I, s:I, s:I}", "wall_s", result_number(cost->wall_s),
        "cpu_s", result_number(cost->cpu_s), "steps", (json_int_t)cost->steps, "particle_updates",
        (json_int_t)cost->particle_updates, "pair_interactions",
        (json_int_t)cost->pair_interactions, "skipped_particle_updates",
        (json_int_t)cost->skipped_particle_updates, "without_slope",
        (json_int_t)cost->without_slope, "without_viscosity", (json_int_t)cost->without_viscosity,
        "without_conductivity", (json_int_t)cost->without_conductivity, "peak_rss_bytes",
        (json_int_t)result->peak_rss);
}

/* The matrix at the end of the run; "fallen_back_most" is that of the worst evaluation. */
static json_t *matrix_json(const struct run_result *result)
{
    json_t *matrix = description_json(&result->matrix);
    if (json_is_object(matrix))
        result_add(matrix, "fallen_back_most=%zu", (size_t)result->cost.fallen_back_most);
    return matrix;
}

static json_t *plan_json(const struct run_result *result)
{
    json_t *lines = json_array();
    for (size_t i = 0; i < result->plan_count; i++)
        json_array_append_new(lines, result_object("pass=%s runs=%d? why=%s", result->plan[i].pass,
                                                   result->plan[i].runs, result->plan[i].why));
    return lines;
}

void run_add_plan(const struct run_settings *settings, const struct run_result *result,
                  json_t *document)
{
    result_add(document, "case=%s title=%s settings=%p n=%zu window=%p", settings->file.name,
               settings->file.title, (void *)settings_json(&result->settings), result->n,
               (void *)run_window_json(&result->problem.window));
    if (!isnan(result->start.density))
        json_object_set_new(document, "start",
                            result_object("density_rms=%g gradient_rms=%g spread=%g",
                                          result->start.density, result->start.gradient,
                                          result->start.spread));
    result_add(document, "plan=%p estimate=%p warnings=%s", (void *)plan_json(result),
               (void *)result_object("memory_bytes=%g steps=%g cpu_s=%g",
                                     ceil(result->estimate.memory), result->estimate.steps,
                                     result->estimate.cpu_s),
               result->warnings);
}

json_t *run_functionals_json(const struct run_result *result)
{
    json_t *list = json_array();
    for (size_t i = 0; i < result->functional_count; i++)
        json_array_append_new(
            list, result_object("name=%s value=%g reference=%g", result->functionals[i].name,
                                result->functionals[i].value, result->functionals[i].exact));
    return list;
}

void run_add_json(const struct run_settings *settings, const struct run_result *result,
                  json_t *document)
{
    const bool broke_down = result->status == STATUS_BROKE_DOWN;
    const char *names[JUDGED_MAX];
    run_add_plan(settings, result, document);
    result_add(document, "time=%g status=%s", result->time, broke_down ? "broke_down" : "ok");
    if (broke_down) result_add(document, "message=%s", result->message);
    json_object_set_new(document, "errors", run_errors_json(result));
    json_object_set_new(document, "conservation", conservation_json(result));
    json_object_set_new(document, "regularity", trace_regularity_json(&result->regularity));
    json_object_set_new(document, "cost", cost_json(result));
    json_object_set_new(document, "matrix", matrix_json(result));
    json_object_set_new(document, "functionals", run_functionals_json(result));
    json_t *measured = json_array();
    const size_t count = judged_names_of(&settings->file, result, names);
    for (size_t i = 0; i < count; i++) json_array_append_new(measured, json_string(names[i]));
    result_add(document, "measured=%p spacing=%g h=%g budget=%p suspicion=%s", (void *)measured,
               result->spacing, result->h, (void *)run_budget_json(&result->budget),
               result->suspicion);
}

enum status run_write_snapshot(const struct run_result *result, const char *path,
                               struct error *error)
{
    const struct snapshot_writer *writer = snapshot_writer_of(path, error);
    return writer ? writer->write(result, path, error) : error->status;
}
