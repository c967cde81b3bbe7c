/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "judge_start.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "list.h"
#include "problem_list.h"
#include "start_gas.h"
#include "text.h"

#define MASS_OFF 0.02 /* total masses that differ by less count as equal */

static const char *const names[START_FIELDS] = {"velocity", "internal energy", "mass", "pressure"};

/* ---- comparison with the initial state ---- */

/* True if, in 1D, the particle's mass fills the space between its neighbours: spacings may be
 * graded. */
static bool fills_space(const struct start_gas *gas, size_t i)
{
    const struct snapshot *s = gas->snapshot;
    const size_t last = s->n - 1;
    if (gas->problem->domain.dim > 1) return false;
    const double after = s->x[0][i < last ? i + 1 : i] - s->x[0][i < last ? i : i - 1],
                 before = i ? s->x[0][i] - s->x[0][i - 1] : after,
                 space = s->m[i] / gas->exact[i].rho;
    return space > 0.95 * fmin(before, after) && space < 1.05 * fmax(before, after);
}

/* The exact state at this distance from the particle along one direction. */
static void state_beside(const struct start_gas *gas, size_t i, int direction, double by,
                         struct problem_state *state)
{
    const double from = gas->x[i][direction];
    gas->x[i][direction] += by;
    problem_sample_start(gas->problem, gas->x[i], state);
    gas->x[i][direction] = from;
}

/* The smallest difference from the exact states near the particle: beside a jump, particles that
 * were displaced keep their original state. */
static double least_off(const struct start_gas *gas, enum start_field field, size_t i)
{
    static const double steps[] = {0.25, 0.5, 1};
    const struct prepared *p = gas->problem;
    double least = start_off(gas, field, i, &gas->exact[i]);
    if (field == START_MASS && least > START_WRONG && fills_space(gas, i)) return 0;
    if (p->problem->smooth || least <= START_WRONG) return least;
    for (int d = 0; d < p->domain.dim; d++)
        for (int k = 0; k < 6; k++) {
            struct problem_state beside;
            state_beside(gas, i, d, (k % 2 ? -1 : 1) * steps[k / 2] * gas->spacing, &beside);
            least = fmin(least, start_off(gas, field, i, &beside));
        }
    return least;
}

static double median(double *values, size_t n)
{
    list_sort(values, n);
    return values[n / 2];
}

/* The number of values that equal this one apart from rounding. */
static size_t near(const double *values, size_t n, double value)
{
    size_t count = 0;
    for (size_t i = 0; i < n; i++) count += fabs(values[i] / value - 1) <= START_WRONG;
    return count;
}

/* Finds the densities of the case's gas and the median particle mass of each; false if there are
 * too many densities, or if most masses of one density differ. */
static bool find_gases(struct start_gas *gas, double *work)
{
    const struct snapshot *s = gas->snapshot;
    for (size_t i = 0; i < s->n; i++) {
        const size_t k = start_gas_of(gas, gas->exact[i].rho);
        if (k == START_GASES_MAX) return false;
        if (k == gas->gases) gas->of[gas->gases++].rho = gas->exact[i].rho;
    }
    for (size_t k = 0; k < gas->gases; k++) {
        size_t n = 0;
        for (size_t i = 0; i < s->n; i++)
            if (start_gas_of(gas, gas->exact[i].rho) == k) work[n++] = s->m[i];
        gas->of[k].mass = median(work, n);
        if (2 * near(work, n, gas->of[k].mass) <= n) return false;
    }
    return true;
}

/* True if the masses of all densities are plausible. Lattices on the two sides of a jump have only
 * nearly equal masses, and those of a tube are free; otherwise one deviating density is wrong. */
static bool gases_fit(const struct start_gas *gas)
{
    bool fit = true;
    for (size_t k = 0; k < gas->gases; k++) fit &= fabs(gas->of[k].mass / gas->mass - 1) <= 0.15;
    return fit || problem_reads(gas->problem->problem, SETTING_mass_ratio);
}

/* The mass or volume that particles should have, how many have it, and whether it follows from the
 * case's total mass. */
struct right_value {
    double value;
    size_t count;
    bool of_whole;
};

/* The median, which is right unless most particles are wrong. If the total mass differs from the
 * case's, they may be: then `right`, the value that gives the case's total, if any particle has
 * it. */
static struct right_value find_right(double *values, size_t n, double right, bool mass_is_off)
{
    const bool of_whole = mass_is_off && near(values, n, right);
    const double value = of_whole ? right : median(values, n);
    return (struct right_value){value, near(values, n, value), of_whole};
}

/* Finds whether masses are equal, or volumes, or the masses of each density; false if none are.
 * ratio: the file's total mass over the case's; NaN if the box is not closed. */
static bool measure_masses(struct start_gas *gas, double ratio, double *work)
{
    const struct snapshot *s = gas->snapshot;
    const struct domain *box = &gas->problem->domain;
    const bool off = fabs(ratio - 1) > MASS_OFF;
    double mean = 0, volume = 1;
    for (int d = 0; d < box->dim; d++) volume *= domain_length(box, d);
    for (size_t i = 0; i < s->n; i++) mean += s->m[i] / (double)s->n;
    memcpy(work, s->m, s->n * sizeof *work);
    const struct right_value of_mass = find_right(work, s->n, mean / ratio, off);
    for (size_t i = 0; i < s->n; i++) work[i] = s->m[i] / gas->exact[i].rho;
    const struct right_value of_volume = find_right(work, s->n, volume / (double)s->n, off);
    const bool volumes = of_mass.of_whole != of_volume.of_whole ? of_volume.of_whole
                                                                : of_volume.count > of_mass.count;
    const struct right_value *right = volumes ? &of_volume : &of_mass;
    gas->mass = of_mass.value;
    gas->volume = volumes ? of_volume.value : 0;
    if (!right->of_whole && find_gases(gas, work) && gases_fit(gas)) return true;
    gas->gases = 0;
    return right->of_whole || 2 * right->count > s->n;
}

/* True if the pressures of most particles follow from density and energy. Some codes store a
 * pressure of their own. */
static bool pressures_follow(const struct start_gas *gas)
{
    size_t count = 0;
    for (size_t i = 0; i < gas->snapshot->n; i++)
        count += start_off(gas, START_PRESSURE, i, &gas->exact[i]) <= 1e-6;
    return 2 * count > gas->snapshot->n;
}

static void measure_gas(struct start_gas *gas)
{
    static const double rest[3];
    double sound = -INFINITY;
    for (size_t i = 0; i < gas->snapshot->n; i++) {
        const struct problem_state *exact = &gas->exact[i];
        gas->speed = fmax(gas->speed, start_apart(exact->v, rest));
        sound = fmax(sound, sqrt(gas->problem->gamma * exact->P / exact->rho));
    }
    if (!(gas->speed > 1e-12 * sound)) gas->speed = sound;
}

/* ---- messages ---- */

static size_t count_wrong(const struct start_gas *gas, unsigned fields)
{
    size_t count = 0;
    for (size_t i = 0; i < gas->snapshot->n; i++) count += (gas->wrong[i] & fields) != 0;
    return count;
}

/* A sentence about the particles with a wrong value in one of these fields. */
static void say(const struct start_gas *gas, unsigned fields, const char *what, const char *cause,
                char *text, size_t size)
{
    const size_t wrong = count_wrong(gas, fields);
    char share[60], place[120];
    start_share(wrong, gas->snapshot->n, share, sizeof share);
    start_where(gas, fields, place, sizeof place);
    text_add(text, size, "%s%s of the particles (%zu of %zu) %s the wrong %s%s%s%s",
             *text ? "; " : "", share, wrong, gas->snapshot->n, wrong == 1 ? "has" : "have", what,
             place, *cause ? ": " : "", cause);
}

/* Describes the cause of each wrong field; false if some field has no known cause. */
static bool explain(const struct start_gas *gas, char *text, size_t size)
{
    bool explained = true;
    char cause[160];
    unsigned fields = 0;
    for (size_t i = 0; i < gas->snapshot->n; i++) fields |= gas->wrong[i];
    const bool several = fields & (fields - 1);
    if (several && start_cause_positions(gas, cause, sizeof cause)) {
        say(gas, fields, "state for where they are", cause, text, size);
        return true;
    }
    for (int f = 0; fields >> f; f++) {
        if (!(fields & 1u << f)) continue;
        explained &= start_cause(gas, (enum start_field)f, cause, sizeof cause) ||
                     (!several && start_cause_positions(gas, cause, sizeof cause));
        say(gas, 1u << f, names[f], cause, text, size);
    }
    return explained;
}

/* True if nearly every wrong particle differs from the exact state by no more than a displacement
 * of one spacing causes. Particles that were displaced at random keep their mass and, in flows with
 * jumps, their whole state. */
static bool are_moved(const struct start_gas *gas)
{
    const int dim = gas->problem->domain.dim;
    const unsigned telling =
        gas->problem->problem->smooth ? ~(1u << START_MASS) : 1u << START_PRESSURE;
    size_t wrong = 0, moved = 0;
    for (size_t i = 0; i < gas->snapshot->n; i++) {
        double most[START_FIELDS] = {0};
        if (!gas->wrong[i]) continue;
        if (gas->wrong[i] & telling) return false;
        for (int k = 0; k < 2 * dim; k++) {
            struct problem_state beside;
            state_beside(gas, i, k / 2, (k % 2 ? -1 : 1) * gas->spacing, &beside);
            most[START_VELOCITY] =
                fmax(most[START_VELOCITY], start_apart(beside.v, gas->exact[i].v) / gas->speed);
            most[START_ENERGY] =
                fmax(most[START_ENERGY], start_relative(beside.u, gas->exact[i].u));
            most[START_MASS] =
                fmax(most[START_MASS], start_relative(beside.rho, gas->exact[i].rho));
        }
        bool is_moved = true;
        for (enum start_field f = 0; f <= START_MASS; f++)
            is_moved = is_moved && (!(gas->wrong[i] & 1u << f) ||
                                    start_off(gas, f, i, &gas->exact[i]) <= most[f] + START_WRONG);
        wrong++;
        moved += is_moved;
    }
    return 100 * moved >= 98 * wrong;
}

/* Reports masses that agree with each other but not with the total mass of the case. */
static void look_at_all_mass(const struct start_gas *gas, double ratio, struct judge_start *start)
{
    if (start->wrong || !(fabs(ratio - 1) > MASS_OFF)) return;
    start->wrong = gas->snapshot->n;
    snprintf(start->message, sizeof start->message,
             "all particles have the wrong mass: it is %.6g times the case's", ratio);
    start->explained = true;
}

static void look(struct start_gas *gas, double precision, double mass_ratio, double *work,
                 struct judge_start *start)
{
    const struct snapshot *s = gas->snapshot;
    const struct problem *problem = gas->problem->problem;
    measure_gas(gas);
    const bool known[START_FIELDS] = {true, !problem->mean_energy,
                                      measure_masses(gas, mass_ratio, work), pressures_follow(gas)};
    for (int f = 0; f < START_FIELDS; f++) {
        start->worst[f] = known[f] ? 0 : (double)NAN;
        for (size_t i = 0; known[f] && i < s->n; i++) {
            const double off = least_off(gas, (enum start_field)f, i);
            if (off > START_WRONG) gas->wrong[i] |= 1u << f;
            start->worst[f] = fmax(start->worst[f], off);
        }
    }
    start->looked = true;
    start->wrong = count_wrong(gas, ~0u);
    if (start->wrong) start->explained = explain(gas, start->message, sizeof start->message);
    if (start->wrong && !start->explained && are_moved(gas)) {
        start->wrong = 0;
        start->moved = true;
        snprintf(start->message, sizeof start->message,
                 "particles have the case's state to a spacing, as if they had been moved after "
                 "they had got it");
    }
    look_at_all_mass(gas, mass_ratio, start);
    const double worst = fmax(start->worst[START_VELOCITY], start->worst[START_ENERGY]);
    if (!start->wrong && precision < 1e-9 && worst > 1e-9 && worst < 1e-6)
        snprintf(start->message, sizeof start->message,
                 "as the case's but for %.1e, as if values had been rounded to single precision",
                 worst);
}

enum status judge_start_look(const struct run_result *result, double precision, double mass_ratio,
                             struct judge_start *start, struct error *error)
{
    const struct problem *problem = result->problem.problem;
    const struct snapshot *s = &result->snapshot;
    struct start_gas gas = {.problem = &result->problem, .snapshot = s, .spacing = result->spacing};
    *start = (struct judge_start){.looked = false};
    for (int d = 0; d < result->problem.domain.dim; d++)
        if (result->problem.boundary[d] != BOUNDARY_PERIODIC) mass_ratio = (double)NAN;
    if (result->time != 0 || problem->liquid || problem->filed || problem->user != USER_NOT)
        return STATUS_OK;
    gas.exact = malloc(s->n * sizeof *gas.exact);
    gas.x = calloc(s->n, sizeof *gas.x);
    gas.wrong = calloc(s->n, sizeof *gas.wrong);
    double *work = malloc(s->n * sizeof *work);
    const bool sound = gas.exact && gas.x && gas.wrong && work;
    for (size_t i = 0; sound && i < s->n; i++) {
        for (int d = 0; d < result->problem.domain.dim; d++) gas.x[i][d] = s->x[d][i];
        problem_sample_start(gas.problem, gas.x[i], &gas.exact[i]);
    }
    if (sound) look(&gas, precision, mass_ratio, work, start);
    free(gas.exact), free(gas.x), free(gas.wrong), free(work);
    return sound ? STATUS_OK : error_set(error, STATUS_ENVIRONMENT, "no memory for a start");
}
