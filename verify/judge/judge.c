/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "judge.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "initial.h"
#include "list.h"
#include "mode.h"
#include "plugin_kernel.h"
#include "text.h"

enum { SINC_ORDER = 5, JUDGE_FEWEST = 8 }; /* fewest particles that have a median */

/* A median error above this fraction of the range of the exact values is not caused by jumps. */
#define JUDGE_FOREIGN       0.06
#define JUDGE_FOREIGN_MEAN  0.2  /* nor is an L1 above this, for jumps a few h wide */
#define JUDGE_FOREIGN_PART  0.5  /* relative error of a functional */
#define JUDGE_FOREIGN_MODE  10   /* motion at a mode's wavelength, over the mode */
#define JUDGE_FOREIGN_AHEAD 0.03 /* fraction of the window that moves ahead of all waves */
#define JUDGE_FOREIGN_MASS  0.03 /* relative error of the total mass */

/* Recomputes a stored pressure that agrees with the gas law to the file's precision, because the
 * file rounded it once more. */
static void sharpen_pressure(struct snapshot_file *file, double gamma)
{
    double *P = file->column[SNAPSHOT_P];
    const double *u = file->column[SNAPSHOT_U], *rho = file->column[SNAPSHOT_RHO];
    double worst = 0;
    for (size_t i = 0; i < file->n; i++)
        worst = fmax(worst, fabs(P[i] - (gamma - 1) * rho[i] * u[i]) / (P[i] + 1e-300));
    char value[48];
    if (worst <= 8 * file->precision[1]) {
        for (size_t i = 0; i < file->n; i++) P[i] = (gamma - 1) * rho[i] * u[i];
        snprintf(value, sizeof value, "(gamma - 1) rho u");
    } else {
        snprintf(value, sizeof value, "as stored");
    }
    snapshot_note(&file->notes, "pressure", value, "the stored one differs by at most %.2g", worst);
}

/* For liquids u has no meaning, and P may be missing. */
static enum status complete_liquid(struct judged *judged, struct error *error)
{
    struct snapshot_file *file = &judged->file;
    static const enum snapshot_column columns[] = {SNAPSHOT_P, SNAPSHOT_U};
    for (size_t k = 0; k < 2; k++) {
        const bool pressure = columns[k] == SNAPSHOT_P;
        if (file->column[columns[k]]) continue;
        if (snapshot_file_fill(file, columns[k], pressure ? (double)NAN : 0, judged->path, error))
            return error->status;
        if (pressure) snapshot_note(&file->notes, "pressure", "unknown", "the file stores none");
    }
    return STATUS_OK;
}

/* Computes P from u, or u from P, where one is missing. */
static enum status complete(struct judged *judged, double gamma, struct error *error)
{
    struct snapshot_file *file = &judged->file;
    const bool lacks_P = !file->column[SNAPSHOT_P], lacks_u = !file->column[SNAPSHOT_U];
    if (judged->run.problem.problem->liquid) return complete_liquid(judged, error);
    if (snapshot_check_gas(judged->path, file, error)) return error->status;
    if (!lacks_P && !lacks_u) {
        sharpen_pressure(file, gamma);
        return STATUS_OK;
    }
    if (snapshot_file_make(file, lacks_P ? SNAPSHOT_P : SNAPSHOT_U, judged->path, error))
        return error->status;
    double *P = file->column[SNAPSHOT_P], *u = file->column[SNAPSHOT_U],
           *rho = file->column[SNAPSHOT_RHO];
    for (size_t i = 0; i < file->n; i++) {
        if (lacks_P)
            P[i] = (gamma - 1) * rho[i] * u[i];
        else
            u[i] = P[i] / ((gamma - 1) * rho[i]);
    }
    snapshot_note(&file->notes, lacks_P ? "pressure" : "internal energy",
                  lacks_P ? "(gamma - 1) rho u" : "P/((gamma - 1) rho)", "the file stores none");
    return STATUS_OK;
}

/* ---- the file's gas as a snapshot ---- */

enum { ARRAYS = 12 };

struct gas {
    double *storage;
    size_t *id;
    struct snapshot snapshot;
};

static const double *sort_by;

static int by_position(const void *a, const void *b)
{
    const double x = sort_by[*(const size_t *)a], y = sort_by[*(const size_t *)b];
    return (x > y) - (x < y);
}

/* A particle's periodic image in the box, also where rounding would leave it a digit below the
 * box. */
static double wrapped(const struct judged *judged, const double period[3], int d, size_t i)
{
    const double x = judged->file.column[d][i], lo = judged->run.problem.domain.lo[d];
    return period[d] > 0 ? fmax(lo, x - period[d] * floor((x - lo) / period[d])) : x;
}

static double width_of_volume(const struct judged *judged, size_t i)
{
    const struct snapshot_file *file = &judged->file;
    const double volume = file->column[SNAPSHOT_M][i] / file->column[SNAPSHOT_RHO][i];
    return pow(volume, 1. / (judged->slab > 0 ? 3 : file->dim));
}

static enum status gas_make(struct gas *gas, const struct judged *judged, const double period[3],
                            double reach, struct error *error)
{
    const struct snapshot_file *file = &judged->file;
    const size_t n = file->gas;
    struct snapshot *s = &gas->snapshot;
    double *column[ARRAYS];
    gas->storage = malloc(ARRAYS * n * sizeof *gas->storage);
    gas->id = malloc(2 * n * sizeof *gas->id);
    if (!gas->storage || !gas->id)
        return error_set(error, STATUS_ENVIRONMENT, "no memory for %.200s", judged->path);
    for (size_t k = 0; k < ARRAYS; k++) column[k] = gas->storage + k * n;
    size_t *order = gas->id + n;
    for (size_t i = 0; i < n; i++) {
        gas->id[i] = order[i] = i;
        column[11][i] = wrapped(judged, period, 0, i);
    }
    sort_by = column[11];
    if (file->dim == 1) qsort(order, n, sizeof *order, by_position);
    for (size_t k = 0; k < n; k++) {
        const size_t i = order[k];
        for (int d = 0; d < file->dim; d++) {
            column[d][k] = wrapped(judged, period, d, i);
            column[3 + d][k] = file->column[SNAPSHOT_VX + d][i];
        }
        column[6][k] = file->column[SNAPSHOT_M][i] / (judged->slab > 0 ? judged->slab : 1);
        column[7][k] = file->column[SNAPSHOT_RHO][i];
        column[8][k] = file->column[SNAPSHOT_U][i];
        column[9][k] = file->column[SNAPSHOT_P][i];
        column[10][k] = file->column[SNAPSHOT_H] && reach > 0 ? reach * file->column[SNAPSHOT_H][i]
                                                              : 2 * width_of_volume(judged, i);
    }
    for (size_t k = 0; k < n; k++) column[11][k] = column[6][k] / column[7][k];
    *s = (struct snapshot){.n = n,
                           .m = column[6],
                           .rho = column[7],
                           .u = column[8],
                           .P = column[9],
                           .h = column[10],
                           .volume = column[11],
                           .id = gas->id,
                           .time = file->time.value};
    for (int d = 0; d < file->dim; d++) s->x[d] = column[d], s->v[d] = column[3 + d];
    return STATUS_OK;
}

/* ---- measurements besides errors ---- */

/* Adds one particle to the sums; c: its sound speed. As in a run, momentum does not count where
 * walls or gravity act. */
static void add_to_sums(const struct prepared *problem, const double x[3], const double v[3],
                        double m, double u, double c, struct conservation *sums)
{
    const struct domain *domain = &problem->domain;
    double p[3] = {0}, r[3] = {0};
    double squares = 0, distance = 0, turning = 0;
    for (int d = 0; d < domain->dim; d++) {
        p[d] = m * v[d];
        r[d] = x[d] - 0.5 * (domain->lo[d] + domain->hi[d]);
        squares += v[d] * v[d];
        sums->kinetic += 0.5 * m * (v[d] - problem->boost[d]) * (v[d] - problem->boost[d]);
        distance += r[d] * r[d];
        sums->energy -= m * problem->gravity[d] * x[d];
        if (problem->boundary[d] != BOUNDARY_REFLECTING && problem->boundary[d] != BOUNDARY_FIXED &&
            !(fabs(problem->gravity[d]) > 0))
            sums->momentum[d] += p[d];
    }
    sums->mass += m;
    sums->energy += m * (u + 0.5 * squares);
    sums->momentum_scale += m * sqrt(squares);
    sums->sound_scale += m * c;
    for (int d = 0; d < 3; d++) {
        const double L = r[(d + 1) % 3] * p[(d + 2) % 3] - r[(d + 2) % 3] * p[(d + 1) % 3];
        sums->angular_momentum[d] += L;
        turning += L * L;
    }
    sums->angular_scale += sqrt(turning);
    sums->turning_scale += sqrt(distance) * m * c;
}

void judge_sum(const struct prepared *problem, const struct snapshot *s, const double shift[3],
               struct conservation *sums)
{
    double x[3] = {0}, v[3] = {0};
    for (size_t i = 0; i < s->n; i++) {
        double u = s->u[i], square = problem->gamma * s->P[i] / s->rho[i];
        for (int d = 0; d < problem->domain.dim; d++)
            x[d] = s->x[d][i] + shift[d], v[d] = s->v[d][i];
        if (problem->problem->liquid) { /* its P follows the case's own equation of state */
            struct problem_state state;
            problem_sample(problem, x, s->time, &state);
            u = state.u;
            square = problem->gamma * (problem->gamma - 1) * u;
        }
        add_to_sums(problem, x, v, s->m[i], u, sqrt(square), sums);
    }
}

/* Sums over the snapshot and over the particles that a run of the case would start with in this
 * box, on the case's own lattice. A case that starts from a glass has no sums of the start, because
 * a glass takes long to make. */
static enum status measure_sums(struct judged *judged, struct error *error)
{
    const struct prepared *p = &judged->run.problem;
    const struct snapshot *s = &judged->result.snapshot;
    struct run_settings plain = judged->run.asked;
    struct initial initial = {0};
    struct error reason = {0};
    struct run start;
    double x[3] = {0}, v[3] = {0};
    judge_sum(p, s, x, &judged->sums);
    if (!judged->boxed || p->problem->liquid)
        return STATUS_OK; /* plates and viscosity change the sums of a liquid */
    plain.settings.value[SETTING_lattice] = plain.file.settings.value[SETTING_lattice];
    plain.settings.value[SETTING_equal_masses] = plain.file.settings.value[SETTING_equal_masses];
    if (!run_resolve(&start, &plain, &reason) &&
        settings_choice(&start.settings, SETTING_lattice) != LATTICE_GLASS &&
        !initial_create(&initial, &start.problem, &start.settings, &reason))
        for (size_t i = 0; i < initial.n; i++) {
            for (int d = 0; d < p->domain.dim; d++) x[d] = initial.x[d][i], v[d] = initial.v[d][i];
            add_to_sums(p, x, v, initial.m[i], initial.u[i], 0, &judged->start);
        }
    initial_free(&initial);
    return reason.status == STATUS_ENVIRONMENT
               ? error_set(error, reason.status, "%.200s: %.280s", judged->path, reason.message)
               : STATUS_OK;
}

/* Rms velocity across x in planar flows, in the radial direction in circular ones. NaN if the
 * window has no particles. */
static double measure_noise(const struct judged *judged)
{
    const struct prepared *p = &judged->run.problem;
    const struct snapshot *s = &judged->result.snapshot;
    double sum = 0, volume = 0;
    if (p->domain.dim == 1) return (double)NAN;
    if (p->problem->circular) return judged->result.radial.l2;
    for (size_t i = 0; i < s->n; i++) {
        double x[3];
        problem_position(p, s, i, x);
        if (!window_contains(&p->window, x)) continue;
        for (int d = 1; d < p->domain.dim; d++) sum += s->volume[i] * s->v[d][i] * s->v[d][i];
        volume += s->volume[i];
    }
    return sqrt(sum / volume);
}

/* For a growing mode one snapshot gives the mean growth rate since the start, where the amplitude
 * is known. The first functional of such a problem is the amplitude. */
static void measure_growth(struct judged *judged)
{
    const struct growing *growing = judged->run.problem.problem->growing;
    struct run_result *r = &judged->result;
    const struct run_functional *amplitude = r->functionals;
    for (size_t k = 1; k < r->functional_count && growing; k++)
        if (strcmp(r->functionals[k].name, growing->name) == 0)
            r->functionals[k].value =
                r->functionals[k].exact + log(amplitude->value / amplitude->exact) / r->time;
}

/* True if the particle is in the window. Fills the exact states at its position, now and at the
 * start. */
static bool counts(const struct judged *judged, size_t i, struct problem_state *now,
                   struct problem_state *before)
{
    const struct prepared *p = &judged->run.problem;
    const struct snapshot *s = &judged->result.snapshot;
    double x[3] = {0}, position[3];
    problem_position(p, s, i, position);
    for (int d = 0; d < p->domain.dim; d++) x[d] = s->x[d][i];
    problem_sample(p, x, judged->result.time, now);
    problem_sample_start(p, x, before);
    return window_contains(&p->window, position);
}

/* Magnitude of the difference of a particle's velocity from that of a state. */
static double velocity_off(const struct judged *judged, size_t i, const struct problem_state *state)
{
    const struct snapshot *s = &judged->result.snapshot;
    double squares = 0;
    for (int d = 0; d < judged->run.problem.domain.dim; d++)
        squares += (s->v[d][i] - state->v[d]) * (s->v[d][i] - state->v[d]);
    return sqrt(squares);
}

/* The region of the exact solution that a particle is in; "" where the problem has none. */
static const char *region_of(const struct judged *judged, size_t i)
{
    const struct prepared *p = &judged->run.problem;
    const struct snapshot *s = &judged->result.snapshot;
    const struct regions *regions = p->problem->regions;
    double position[3];
    if (!regions) return "";
    problem_position(p, s, i, position);
    return regions->names[regions->at(p, position, BUDGET_REACH * s->h[i], judged->result.time)];
}

/* True if the particle is near a jump, where every scheme has large errors. */
static bool near_jump(const struct judged *judged, size_t i)
{
    const char *name = region_of(judged, i);
    return strcmp(name, "shock") == 0 || strcmp(name, "contact") == 0;
}

/* Fraction of the window's particles that are ahead of all exact waves and move by more than a
 * tenth of the range of velocities: a scheme's waves are close to the exact ones, those of another
 * time or position are not. NaN if the window has no particles. */
static double moves_ahead(const struct judged *judged, double range)
{
    size_t all = 0, ahead = 0;
    for (size_t i = 0; i < judged->result.snapshot.n; i++) {
        struct problem_state now, before;
        if (!counts(judged, i, &now, &before)) continue;
        all++;
        ahead += !strcmp(region_of(judged, i), "undisturbed") &&
                 velocity_off(judged, i, &now) > 0.1 * range;
    }
    return (double)ahead / (double)all;
}

static double value_of(const struct problem_state *state, int f, int dim)
{
    if (f == FIELD_VELOCITY && dim > 1)
        return sqrt(state->v[0] * state->v[0] + state->v[1] * state->v[1] +
                    state->v[2] * state->v[2]);
    return problem_field(state, (enum field)f);
}

/* Median error of a field in the gas that the flow has changed, over the range of its exact values:
 * a scheme has large errors at jumps, another solution nearly everywhere. The scale of a uniform
 * field is half its value, that of velocities in gas at rest the sound speed. In cold gas, pressure
 * and energy are also compared with what dissipation of the motion could give. */
static double median_error(const struct judged *judged, int f, double *errors, double *range)
{
    const struct snapshot *s = &judged->result.snapshot;
    const int dim = judged->run.problem.domain.dim;
    const double *const values[FIELDS] = {s->rho, NULL, s->P, s->u};
    double least = INFINITY, most = -INFINITY, sound = -INFINITY, motion = -INFINITY;
    for (int all = 0; all < 2; all++) {
        size_t n = 0;
        for (size_t i = 0; i < s->n; i++) {
            struct problem_state now, before;
            if (!counts(judged, i, &now, &before)) continue;
            const double exact = value_of(&now, f, dim);
            least = fmin(least, exact), most = fmax(most, exact);
            sound = fmax(sound, sqrt(judged->run.problem.gamma * now.P / now.rho));
            const double speed = value_of(&now, FIELD_VELOCITY, 3);
            motion = fmax(motion, (f == FIELD_PRESSURE ? now.rho : 1) * speed * speed);
            if (near_jump(judged, i)) continue;
            if (!all && fabs(exact - value_of(&before, f, dim)) <= 1e-3 * fabs(exact)) continue;
            errors[n++] =
                f == FIELD_VELOCITY ? velocity_off(judged, i, &now) : fabs(values[f][i] - exact);
        }
        const double size = fmax(fabs(most), fabs(least));
        const bool varies = most - least > 1e-9 * size;
        *range = fmax(most - least, (varies ? 0.2 : 0.5) * size);
        if (f == FIELD_VELOCITY && *range == 0) *range = sound;
        if (f == FIELD_PRESSURE || f == FIELD_INTERNAL_ENERGY) *range = fmax(*range, 0.1 * motion);
        if (n >= JUDGE_FEWEST) {
            list_sort(errors, n);
            return errors[n / 2] / *range;
        }
        if (judged->run.problem.problem->regions) break;
    }
    return 0; /* too few particles to judge */
}

/* Error of a functional over its bound; above 1 it is far off. The value of mode_error is its
 * error; the error of others is relative to the exact value, and 0 where that is unknown. */
static double wrong_functional(const struct run_functional *f)
{
    const double part = strcmp(f->name, mode_error.name) == 0 ? f->value / JUDGE_FOREIGN_MODE
                        : isfinite(f->exact) ? fabs(f->value / f->exact - 1) / JUDGE_FOREIGN_PART
                                             : 0;
    return isnan(part) ? (double)INFINITY : part;
}

/* The functional that judges a problem without comparable fields: the first one, or the shape of a
 * mode, since noise may have its amplitude. */
static const struct run_functional *telling(const struct run_result *result)
{
    const struct run_functional *first = result->functionals;
    for (size_t k = 1; k < result->functional_count; k++)
        if (strcmp(first[k].name, mode_error.name) == 0 &&
            wrong_functional(&first[k]) > fmax(1, wrong_functional(first)))
            return &first[k];
    return first;
}

/* True if the case has an exact value at the snapshot's time that the gas was compared with. */
static bool is_known(const struct run_result *r)
{
    return !r->problem.problem->fieldless ||
           (r->functional_count && isfinite(r->functionals[0].exact));
}

static enum status measure_wrong(struct judged *judged, struct error *error)
{
    if (judged->run.problem.problem->fieldless) {
        if (judged->result.functional_count)
            judged->wrong = JUDGE_FOREIGN * wrong_functional(telling(&judged->result));
        return STATUS_OK;
    }
    double *errors = malloc(judged->result.snapshot.n * sizeof *errors);
    if (!errors) return error_set(error, STATUS_ENVIRONMENT, "no memory for errors");
    for (int f = 0; f < FIELDS; f++) {
        double range = INFINITY;
        if (!problem_knows(judged->run.problem.problem, (enum field)f)) continue;
        const double median = median_error(judged, f, errors, &range);
        const double mean = judged->result.errors[f].l1 / range;
        double part = fmax(median, mean * JUDGE_FOREIGN / JUDGE_FOREIGN_MEAN);
        if (f == FIELD_VELOCITY)
            part = fmax(part, moves_ahead(judged, range) * JUDGE_FOREIGN / JUDGE_FOREIGN_AHEAD);
        if (part > judged->wrong) judged->wrong = part, judged->wrong_field = (enum field)f;
    }
    free(errors);
    return STATUS_OK;
}

/* ---- messages ---- */

static void note_kernel(struct judged *judged)
{
    const struct conventions *c = &judged->conventions;
    struct snapshot_notes *notes = &judged->file.notes;
    const struct convention *best = &c->candidate[0];
    char value[80];
    if (c->known)
        snprintf(value, sizeof value, "%s, support radius %.6g h", best->kernel.member.name,
                 best->ratio);
    else
        snprintf(value, sizeof value, "not identifiable");
    snapshot_note(notes, "kernel", value, "%s", c->why);
    if (c->known)
        snapshot_note(notes, "density",
                      best->sum == DENSITY_MASSES ? "sum of m_j W_ij" : "m_i times the sum of W_ij",
                      "%s",
                      c->same_masses ? "masses are equal: the other sum is the same"
                      : c->any_sum   ? "or the other sum: masses hardly differ, both fit"
                                     : c->why);
}

static void note_precision(struct judged *judged)
{
    struct snapshot_file *file = &judged->file;
    const bool single = file->precision[1] > 1e-9;
    char value[24];
    snprintf(value, sizeof value, "%d digits", file->digits);
    snapshot_note(&file->notes, "precision",
                  file->digits ? value
                  : single     ? "float32"
                               : "float64",
                  "%s; nothing below %.0e of a value is meant",
                  file->digits                          ? "as written"
                  : single && file->precision[0] < 1e-9 ? "positions float64, the rest float32"
                                                        : "as stored",
                  file->precision[1]);
}

/* True if the box has another mass than the case's. Another code's start may have one row of
 * particles more or less on a side of a jump, which counts where rows are few. */
static bool wrong_mass(const struct judged *judged)
{
    const double rows = pow((double)judged->result.n, 1. / judged->file.dim);
    return judged->start.mass > 0 && !(fabs(judged->sums.mass / judged->start.mass - 1) <=
                                       fmax(JUDGE_FOREIGN_MASS, 1 / rows));
}

/* Relative difference of the total energy from that of the case's initial state. */
static double energy_off(const struct judged *judged)
{
    return fabs(judged->sums.energy / judged->start.energy - 1);
}

/* True if a snapshot of t = 0 is the case's initial state, whatever its densities are, which codes
 * compute from neighbours. Of a blast only the total energy is known. */
static bool is_the_start(const struct judged *judged)
{
    const struct judge_start *start = &judged->of_start;
    return start->looked && !start->wrong && !start->moved &&
           (!isnan(start->worst[START_ENERGY]) || energy_off(judged) <= JUDGE_FOREIGN_MASS);
}

/* Compares a snapshot of t = 0 with the initial state, including the sums of measure_sums. */
static enum status measure_start(struct judged *judged, bool glance, struct error *error)
{
    struct judge_start *start = &judged->of_start;
    if (measure_sums(judged, error)) return error->status;
    const double ratio =
        judged->start.mass > 0 ? judged->sums.mass / judged->start.mass : (double)NAN;
    if (glance) return STATUS_OK;
    if (judge_start_look(&judged->result, judged->file.precision[1], ratio, start, error))
        return error->status;
    if (start->looked && !start->wrong) {
        const bool known = !isnan(start->worst[START_ENERGY]);
        char masses[40] = "";
        if (!isnan(start->worst[START_MASS]))
            snprintf(masses, sizeof masses, ", masses to %.1e", start->worst[START_MASS]);
        snapshot_note(
            &judged->file.notes, "start", "the case's",
            "%s%svelocities to %.1e of the greatest, %s to %.1e%s; density and pressure are sums "
            "over neighbours",
            start->message, *start->message ? "; " : "", start->worst[START_VELOCITY],
            known ? "internal energies" : "the total energy",
            known ? start->worst[START_ENERGY] : energy_off(judged), masses);
    } else if (start->looked) {
        snapshot_note(&judged->file.notes, "start", "damaged", "%s", start->message);
    }
    return STATUS_OK;
}

static void write_verdict(struct judged *judged)
{
    const struct run_result *r = &judged->result;
    const struct convention *best = &judged->conventions.candidate[0];
    char kernel[100], gas[520] = "";
    if (judged->of_start.wrong)
        snprintf(gas, sizeof gas, "%s; ", judged->of_start.message);
    else if (wrong_mass(judged))
        snprintf(gas, sizeof gas,
                 "its mass is %.3g times that of the case in this box: particles are missing or "
                 "there twice, or box or units are others; ",
                 judged->sums.mass / judged->start.mass);
    if (judged->case_gamma > 0)
        snprintf(gas, sizeof gas,
                 "another gas: gamma = %.6g, the case has %.6g (--gamma %.6g judges it as that); ",
                 r->problem.gamma, judged->case_gamma, r->problem.gamma);
    if (judged->conventions.known)
        snprintf(kernel, sizeof kernel, "%s with H = %.6g h", best->kernel.member.name,
                 best->ratio);
    else
        snprintf(kernel, sizeof kernel, "kernel not identifiable");
    if (!is_known(r))
        snprintf(judged->verdict, sizeof judged->verdict,
                 "%snothing of this case is known at t = %.6g, so nothing was compared; %s", gas,
                 r->time, kernel);
    else if (r->problem.problem->fieldless)
        snprintf(judged->verdict, sizeof judged->verdict, "%s%s%s = %.4g, the case says %.4g; %s",
                 gas, judged->far ? "far from the solution of this case: " : "", telling(r)->name,
                 telling(r)->value, telling(r)->exact, kernel);
    else {
        char errors[120] = "";
        for (int f = 0; f < FIELD_INTERNAL_ENERGY; f++)
            if (problem_knows(r->problem.problem, (enum field)f))
                text_add(errors, sizeof errors, "%s %s %.3g", *errors ? "," : "",
                         field_family.members[f]->name, r->errors[f].l1);
        snprintf(judged->verdict, sizeof judged->verdict, "%s%sL1 of%s; %s", gas,
                 judged->far ? "far from the solution of this case: " : "", errors, kernel);
    }
    if (judged->far && !r->problem.problem->fieldless)
        snapshot_note(&judged->file.notes, "solution", "far from this case's",
                      "%s is off also away from jumps, by %.2g times what a scheme may be: another "
                      "gamma, time, x0 or case, too few particles, or a scheme that fails",
                      field_family.members[judged->wrong_field]->name,
                      judged->wrong / JUDGE_FOREIGN);
}

enum status judge_as(const char *path, const struct judge_request *request, bool glance,
                     struct judged *judged, struct error *error)
{
    struct gas gas = {0};
    double period[3] = {0};
    struct kernel kernel;
    *judged = (struct judged){.path = path};
    enum status status = snapshot_read(path, &request->options, &judged->file, error);
    if (!status) status = judge_geometry(request, judged, period, error);
    if (!status) status = complete(judged, judged->run.problem.gamma, error);
    const int dim = judged->file.dim;
    if (judged->slab > 0) judged->file.dim = 3; /* densities were summed in 3D */
    if (!status && request->kernel >= 0)
        status = plugin_select(&kernel, request->kernel, SINC_ORDER, judged->file.dim, error);
    if (!status && !glance)
        status = conventions_find(&judged->file, period, request->kernel < 0 ? NULL : &kernel,
                                  &request->width, &judged->conventions, error);
    judged->file.dim = dim;
    if (!status)
        status =
            gas_make(&gas, judged, period,
                     judged->conventions.known ? judged->conventions.candidate[0].ratio : 0, error);
    if (!status) {
        struct error reason = {0};
        status = run_judge(&judged->run, &gas.snapshot, &judged->result, &reason);
        if (status)
            error_set(error, status, "%.200s: %.280s%s%s", path, reason.message,
                      status == STATUS_BAD_INPUT ? " (t_end: the snapshot's time)" : "",
                      !request->boundary && strstr(reason.message, "mirrored tube")
                          ? "; --boundary open if the tube has ends"
                          : "");
    }
    if (!status) status = judge_check_window(judged, error);
    if (!status && judged->slab > 0)
        judged->result.spacing = cbrt(pow(judged->result.spacing, 2) * judged->slab);
    if (!status) measure_growth(judged);
    if (!status) status = measure_wrong(judged, error);
    if (!status) status = measure_start(judged, glance, error);
    if (!status) {
        judged->far = judged->wrong > JUDGE_FOREIGN && !is_the_start(judged);
        judged->foreign =
            judged->far || judged->case_gamma > 0 || wrong_mass(judged) ||
            (judged->of_start.wrong &&
             (judged->of_start.explained ||
              judged->of_start.wrong > judged->result.n / 10)); /* a few may be displaced */
        judged->passes = !judged->foreign || request->allow_far;
        judged->silent = !is_known(&judged->result) && !request->allow_far;
        judged->transverse = measure_noise(judged);
        if (!glance) note_kernel(judged);
        note_precision(judged);
        write_verdict(judged);
    }
    free(gas.storage), free(gas.id);
    return status;
}

void judge_free(struct judged *judged)
{
    run_free(&judged->result);
    snapshot_file_free(&judged->file);
}
