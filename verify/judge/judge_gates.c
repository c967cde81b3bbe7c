/* SPDX-License-Identifier: GPL-3.0-or-later
 * Gates of judge: bounds for all its figures, and the gates of the case. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "gates.h"
#include "judge.h"
#include "result.h"
#include "text.h"
#include "value.h"

enum { NAME = 48, SOURCE = 200 };

/* Bounds of conservation in `--gates case`, wide enough for initial states of other codes and
 * single precision; turning_bound: angular momentum of rotating flow, which a square box does not
 * conserve exactly. */
static const double conserved_bound = 2e-3, turning_bound = 0.02;
/* A known weakness without a number extends the bound by this factor. */
static const double weakness = 1.5;
/* Snapshot and case have the same time if they differ by less than this fraction of it. */
static const double same_time = 0.01;

/* ---- figures that gates can bound ---- */

static void add_figure(json_t *figures, const char *prefix, const char *name, double value)
{
    char full[2 * NAME];
    snprintf(full, sizeof full, "%s%s", prefix, name);
    json_object_set_new(figures, full, result_number(value));
}

static void add_norms(json_t *figures, const char *name, const struct norms *of)
{
    const double values[NORMS] = {of->l1, of->l2, of->linf, of->particle_mean, of->l1_whole};
    char prefix[NAME];
    snprintf(prefix, sizeof prefix, "%s_", name);
    for (int norm = 0; norm < NORMS; norm++)
        add_figure(figures, prefix, field_norm_family.members[norm]->name, values[norm]);
}

/* {NAME: number, or for an order {"order", "low", "high" ...}}. New reference. */
static json_t *figures_of(const struct judged *judged, size_t n)
{
    const struct judged *main = judge_main(judged, n);
    const struct run_result *r = &main->result;
    const struct problem *problem = r->problem.problem;
    struct trace trace;
    json_t *figures = json_object(), *conserved = judge_conservation(judged, n, &trace),
           *orders = judge_orders(judged, n), *order;
    size_t i;
    for (int f = 0; f < FIELDS; f++)
        if (problem_knows(problem, (enum field)f))
            add_norms(figures, field_family.members[f]->name, &r->errors[f]);
    if (problem->circular) {
        add_norms(figures, "azimuthal", &r->azimuthal);
        add_norms(figures, "radial", &r->radial);
    }
    for (size_t k = 0; k < r->functional_count; k++) {
        const struct run_functional *f = &r->functionals[k];
        add_figure(figures, "", f->name, isfinite(f->exact) ? fabs(f->value - f->exact) : f->value);
    }
    for (size_t k = 0; r->budget.regions && r->budget.regions->names[k]; k++)
        add_figure(figures, "density_l1.", r->budget.regions->names[k],
                   r->budget.l1[k][FIELD_DENSITY]);
    if (main->file.dim > 1) add_figure(figures, "", "noise", main->transverse);
    for (size_t k = 0; json_is_object(conserved) && k < TRACE_FIGURES; k++)
        if (!json_is_null(json_object_get(conserved, trace_figures[k])))
            add_figure(figures, "", trace_figures[k], value_member(conserved, trace_figures[k]));
    json_array_foreach(orders, i, order) {
        char name[NAME];
        snprintf(name, sizeof name, "order.%s", value_text(order, "field"));
        json_object_set(figures, name, order);
    }
    json_decref(conserved);
    json_decref(orders);
    return figures;
}

/* ---- one gate ---- */

static enum finding_status compare(double low, double high, bool least, double bound)
{
    if (least ? low >= bound : high <= bound) return FINDING_PASS;
    return (least ? high >= bound : low <= bound) ? FINDING_UNDETERMINED : FINDING_FAIL;
}

static json_t *gate_json(const char *name, const json_t *figure, bool least, double bound,
                         const char *source)
{
    const bool order = json_is_object(figure);
    const double value = order ? value_member(figure, "order") : value_real(figure),
                 low = order ? value_member(figure, "low") : value,
                 high = order ? value_member(figure, "high") : value;
    enum finding_status status = compare(low, high, least, bound);
    char why[GATE_WHY] = "";
    if (order && isnan(low)) {
        status = FINDING_UNDETERMINED;
        const size_t levels = json_array_size(json_object_get(figure, "pairwise")) + 1;
        if (levels < ORDER_LEVELS_MIN)
            snprintf(why, sizeof why, "an interval needs %d numbers of particles, there are %zu",
                     ORDER_LEVELS_MIN, levels);
        else
            snprintf(why, sizeof why, "an error is 0 or unknown");
    } else if (status == FINDING_UNDETERMINED) {
        snprintf(why, sizeof why, "the order is %.3f, its 95 %% interval %.3f to %.3f", value, low,
                 high);
    }
    json_t *gate = result_object("name=%s relation=%s value=%g bound=%g status=%s source=%s", name,
                                 least ? ">=" : "<=", value, bound, finding_words[status], source);
    if (order) result_add(gate, "low=%g high=%g", low, high);
    if (*why) result_add(gate, "why=%s", why);
    return gate;
}

/* ---- gates of the command line ---- */

static enum status no_such_figure(const json_t *figures, const char *name, struct error *error)
{
    char names[360] = "";
    const char *key;
    size_t used = 0;
    json_t *value;
    json_object_foreach((json_t *)figures, key, value) {
        const char *norm = strrchr(key, '_');
        bool of_field = false; /* listed once, with all norms */
        for (int k = 1; k < NORMS && norm; k++)
            of_field |= strstr(key, field_norm_family.members[k]->name) != NULL;
        if (of_field || used >= sizeof names) continue;
        used += (size_t)snprintf(names + used, sizeof names - used, " %s", key);
    }
    return error_set(error, STATUS_BAD_INPUT,
                     "--gate %.48s: nothing here is called so; allowed:%s; for l1 also l2 linf "
                     "particle_mean l1_whole%s",
                     name, names,
                     strncmp(name, "order", strlen("order"))
                         ? ""
                         : "; orders need several numbers of particles");
}

static enum status ask(const char *text, const json_t *figures, const char *no_orders,
                       json_t *gates, struct error *error)
{
    for (const char *at = text;
         at && (*at || at == text);) { /* the loop also runs once for an empty text, to refuse it */
        const size_t length = strcspn(at, ","), end = strcspn(at, "<>=");
        const size_t sign = strspn(at + end, "<>=");
        char name[NAME], relation[3] = "", number[40];
        double bound;
        if (end >= length || end >= sizeof name || sign >= sizeof relation ||
            length - end - sign >= sizeof number)
            return error_set(error, STATUS_BAD_INPUT,
                             "--gate %.80s: allowed: NAME=BOUND,... or NAME>=BOUND, such as "
                             "density_l1=2e-3 or order.density>=0.9",
                             text);
        snprintf(name, sizeof name, "%.*s", (int)end, at);
        snprintf(relation, sizeof relation, "%.*s", (int)sign, at + end);
        snprintf(number, sizeof number, "%.*s", (int)(length - end - sign), at + end + sign);
        const bool least = !strcmp(relation, ">="),
                   order = !strncmp(name, "order.", strlen("order."));
        if (!least && strcmp(relation, "=") && strcmp(relation, "<="))
            return error_set(error, STATUS_BAD_INPUT, "--gate %.48s%s%.40s: allowed: = <= >=", name,
                             relation, number);
        if (order && !strcmp(relation, "="))
            return error_set(error, STATUS_BAD_INPUT,
                             "--gate %.48s=%.40s: an order is gated by >= or <=", name, number);
        if (!text_real(number, &bound) || !(order || bound > 0))
            return error_set(error, STATUS_BAD_INPUT, "--gate %.48s%s%.40s: allowed: %s", name,
                             relation, number, order ? "a number" : "above 0");
        const json_t *figure = json_object_get(figures, name);
        if (!figure && order && *no_orders)
            return error_set(error, STATUS_BAD_INPUT, "--gate %.48s: no orders: %s", name,
                             no_orders);
        if (!figure) return no_such_figure(figures, name, error);
        json_array_append_new(gates, gate_json(name, figure, least, bound, JUDGE_ASKED));
        at += length + (at[length] == ',');
    }
    return STATUS_OK;
}

/* ---- gates of the case ---- */

/* Refuses, with the reason, snapshots to which the case's bounds do not apply. */
static enum status check_case(const struct judged *main, struct error *error)
{
    const struct case_file *file = &main->run.asked.file;
    const double t_end = settings_real(&file->settings, SETTING_t_end);
    if (main->file.dim != main->case_dim)
        return error_set(error, STATUS_BAD_INPUT,
                         "--gates case: %.60s is written in %d dimensions and has no bounds for %d",
                         file->name, main->case_dim, main->file.dim);
    if (!(fabs(main->result.time - t_end) <= same_time * t_end))
        return error_set(error, STATUS_BAD_INPUT,
                         "--gates case: the bounds of %.60s are for t = %g, %.160s is at t = %g; "
                         "allowed: --gate",
                         file->name, t_end, main->path, main->result.time);
    if (main->altered)
        return error_set(
            error, STATUS_BAD_INPUT,
            "--gates case: %.160s has another initial state or gravity than %.60s; allowed: "
            "--gate, or a case file of its own, with bounds in [converge]",
            main->path, file->name);
    if (!file->gate_count)
        return error_set(error, STATUS_BAD_INPUT,
                         "--gates case: %.60s has none; in [converge] of a case file stands "
                         "density_l1 = LOWEST_ORDER HIGHEST_ORDER BOUND",
                         file->name);
    return STATUS_OK;
}

static void say_source(const struct judged *main, const struct case_gate *gate, char text[SOURCE])
{
    const struct case_file *file = &main->run.asked.file;
    const double n = main->case_n, raise = gates_raise(file, gate, (size_t)n);
    const size_t finest = file->ladder_count ? file->ladder[file->ladder_count - 1] : 0;
    int used = snprintf(text, SOURCE, "case %s: %.3g", file->name, gate->gate.bound);
    if (finest) used += snprintf(text + used, SOURCE - (size_t)used, " at n = %zu", finest);
    if (gate->gate.low > 0 && n < (double)finest)
        snprintf(text + used, SOURCE - (size_t)used, ", raised by order %g to n = %.0f",
                 gate->gate.low, n);
    else if (fabs(raise - 1) > 0)
        snprintf(text + used, SOURCE - (size_t)used, ", beyond it %.3g", raise * gate->gate.bound);
}

static void add_case(const struct judged *main, const json_t *figures, json_t *gates)
{
    static const char *const kept[] = {"mass", "momentum", "energy", "angular_momentum"};
    const bool turns = main->result.problem.problem->circular == CIRCULAR_ROUND;
    const struct case_file *file = &main->run.asked.file;
    json_t *run = judge_one_json(main, false);
    char text[SOURCE], name[NAME];
    json_object_set_new(run, "n", json_real(round(main->case_n)));
    for (size_t i = 0; i < file->gate_count; i++) {
        struct case_gate gate = file->gates[i];
        if (isinf(gate.known.bound)) gate.known.bound = weakness * gate.gate.bound;
        json_t *found = gates_error(file, &gate, run);
        if (!found) continue;
        say_source(main, &gate, text);
        result_add(found, "relation=%s source=%s", "<=", text);
        const json_t *known = json_object_get(found, "known");
        if (known) json_object_set(found, "why", (json_t *)known);
        json_array_append_new(gates, found);
    }
    for (size_t i = 0; i < file->gate_count; i++) {
        const struct case_gate *gate = &file->gates[i];
        snprintf(name, sizeof name, "order.%s", field_family.members[gate->field]->name);
        const json_t *order = json_object_get(figures, name);
        if (gate->functional || gate->norm != NORM_L1 || !isfinite(gate->gate.high) || !order)
            continue;
        snprintf(text, sizeof text, "case %s: its ladder's order", file->name);
        const double low = gates_at(file, gate, (size_t)main->case_n).low;
        json_t *found = gate_json(name, order, true, low, text);
        if (*gate->known.why && strcmp(value_text(found, "status"), finding_words[FINDING_PASS]))
            result_add(found, "status=%s why=%s", finding_words[FINDING_KNOWN], gate->known.why);
        json_array_append_new(gates, found);
    }
    for (size_t k = 0; k < (turns ? 4 : 3); k++)
        if (json_object_get(figures, kept[k]))
            json_array_append_new(
                gates, gate_json(kept[k], json_object_get(figures, kept[k]), false,
                                 k == 3 ? turning_bound : conserved_bound,
                                 "of every case: what starts of other codes may differ by"));
    json_decref(run);
}

enum status judge_gates(const char *asked, bool of_case, const struct judged *judged, size_t n,
                        json_t **gates, struct error *error)
{
    const struct judged *main = judge_main(judged, n);
    json_t *figures = figures_of(judged, n);
    char no_orders[JUDGE_WHY] = "";
    const bool one = judge_one_ladder(judged, n, no_orders);
    *gates = json_array();
    enum status status = ask(asked, figures, no_orders, *gates, error);
    if (!status && of_case) status = check_case(main, error);
    if (!status && of_case && !one)
        status = error_set(error, STATUS_BAD_INPUT, "--gates case: no orders: %s", no_orders);
    if (!status && of_case) add_case(main, figures, *gates);
    json_decref(figures);
    return status;
}
