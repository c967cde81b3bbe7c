/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "rate_check.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "list.h"
#include "oracle.h"
#include "worst.h"

enum { ORACLE_MOST = 1500 }; /* particles; the oracle sums over all pairs */

static const char *const names[RATE_COLUMNS] = {"h", "rho", "P", "ax", "ay", "az", "du"};

/* The value of a particle in this column of the file. */
static double value(const struct rate_table *table, const double *m, int column, size_t i)
{
    const double *const of[RATE_COLUMNS] = {table->h,        table->rho,      table->P,
                                            table->force[0], table->force[1], table->force[2],
                                            table->dU};
    return of[column][i] / (column < 3 ? 1 : m[i]);
}

/* The scale by which differences of a column are divided. */
static double scale_of(const struct rate_table *table, const double *m, int column, size_t i)
{
    if (column < 3) return fabs(value(table, m, column, i));
    double most = 0;
    for (size_t k = 0; k < table->n; k++) {
        double size = 0;
        const int first = column == 6 ? 6 : 3, last = column == 6 ? 6 : 2 + table->dim;
        for (int c = first; c <= last; c++) size = hypot(size, value(table, m, c, k));
        most = fmax(most, size);
    }
    return most;
}

static double relative(double difference, double scale)
{
    return difference == 0 ? 0 : difference / scale;
}

/* What is compared; theirs: NULL where the file has no such column. */
struct both {
    const double *theirs[RATE_COLUMNS];
    const struct setup *setup;
    const struct rate_table *ours;
    double tolerance;
    double open; /* relative uncertainty of the other code's eta */
};

/* Compares a column with this table; fills everything except the cause. The particle stays 0 if
 * nothing differs. */
static void compare(struct rate_comparison *c, const struct both *both,
                    const struct rate_table *table)
{
    const double *theirs = both->theirs[c->column], *m = both->setup->m;
    const double common = scale_of(table, m, c->column, 0);
    double sum = 0;
    c->worst = 0;
    for (size_t i = 0; i < table->n; i++) {
        const double scale = c->column < 3 ? scale_of(table, m, c->column, i) : common;
        const double d = relative(fabs(theirs[i] - value(table, m, c->column, i)), scale);
        if (!(d <= c->worst)) c->particle = i;
        worst_keep(&c->worst, d);
        sum += d * d;
    }
    c->rms = sqrt(sum / (double)table->n);
}

/* --- causes ----------------------------------------------------------------------------------- */

/* Makes the k-th change of a setup. Returns what it means if the other code has it; NULL behind the
 * last change. */
static const char *make_change(struct setup *setup, int k)
{
    struct scheme *s = &setup->scheme;
#define CHANGE(change, cause)                                                                      \
    if (k-- == 0) return change, cause
    CHANGE(s->viscosity = VISCOSITY_NONE, "viscosity: they have none");
    CHANGE(s->viscosity = VISCOSITY_CONSTANT, "viscosity: theirs is constant");
    CHANGE(s->beta = 0, "viscosity: theirs has no quadratic term (beta = 0)");
    CHANGE(s->beta = s->alpha, "viscosity: beta = alpha in theirs");
    CHANGE(s->alpha *= 2, "viscosity: alpha is twice ours");
    CHANGE(s->alpha /= 2, "viscosity: alpha is half of ours");
    CHANGE((s->alpha *= 2, s->beta *= 2), "viscosity: alpha and beta are twice ours");
    CHANGE((s->alpha /= 2, s->beta /= 2), "viscosity: alpha and beta are half of ours");
    CHANGE(s->viscosity_form = VISCOSITY_FORM_MU, "viscosity: theirs is of the form mu");
    CHANGE(s->viscosity_form = VISCOSITY_FORM_SIGNAL, "viscosity: theirs is of the form signal");
    CHANGE(s->balsara = BALSARA_ON, "viscosity: theirs has a Balsara factor");
    CHANGE(s->balsara = BALSARA_OFF, "viscosity: theirs has no Balsara factor");
    CHANGE(s->pair_width = PAIR_WIDTH_MAX, "pair width: theirs is max(h_i, h_j)");
    CHANGE(s->pair_width = PAIR_WIDTH_MEAN, "pair width: theirs is the mean of both gradients");
    CHANGE(s->pair_width = PAIR_WIDTH_HARMONIC, "pair width: theirs is the harmonic mean");
    CHANGE(s->gradient = GRADIENT_STANDARD, "gradient: theirs is standard");
    CHANGE(s->gradient = GRADIENT_IA, "gradient: theirs is ia");
    CHANGE(s->gradient = GRADIENT_CORRECTED, "gradient: theirs is corrected");
    CHANGE(s->gradient = GRADIENT_BLENDED, "gradient: theirs is blended");
    CHANGE(s->formulation = FORMULATION_VANILLA_ICE, "pressure: their formulation is vanilla_ice");
    CHANGE(s->formulation = FORMULATION_LAGRANGIAN,
           "pressure: their formulation is lagrangian, with grad-h factors");
    CHANGE(s->volume_element = VOLUME_MASS, "volume element: theirs is mass");
    CHANGE(s->volume_element = VOLUME_ENERGY, "volume element: theirs is energy");
    CHANGE(s->volume_element = VOLUME_NUMBER, "volume element: theirs is number");
    CHANGE(s->alpha_u = s->shock_conductivity = 0, "conductivity: they have none");
    CHANGE(s->shock_conductivity = 1,
           "conductivity: theirs is 1 in strong shocks (shock_conductivity=1)");
    CHANGE(setup->gamma = 5. / 3, "gamma: theirs is 5/3");
    CHANGE(setup->gamma = 1.4, "gamma: theirs is 1.4");
    CHANGE(s->eta /= 2, "eta: theirs is half of ours (h is the support radius here)");
    CHANGE(s->eta *= 2, "eta: theirs is twice ours (h is the support radius here)");
    CHANGE(setup->boundary[0] = setup->boundary[1] = setup->boundary[2] = BOUNDARY_OPEN,
           "boundary: theirs is open");
#undef CHANGE
    return NULL;
}

/* A cause explains a difference if it reduces the difference to the tolerance or by a factor of
 * 1000. An infinite difference, relative to rates of 0, must fall to the tolerance. */
static double near_enough(const struct rate_comparison *c, double tolerance)
{
    return isinf(c->worst) ? tolerance : fmax(tolerance, 1e-3 * c->worst);
}

/* Names this cause for the columns that it explains and that have none yet. Of kernels the one that
 * explains most is named: left (else NULL) has the remaining difference of each column with the
 * kernel named so far, INFINITY before the first. A difference of the size of both->open also
 * counts as explained if the cause removes nine tenths of it. */
static void propose(struct rate_check *check, const struct both *both,
                    const struct rate_table *changed, double *left, const char *cause)
{
    for (size_t k = 0; k < check->count; k++) {
        struct rate_comparison *c = &check->columns[k], now = *c;
        if (c->good || (c->cause[0] && (!left || isinf(left[k])))) continue;
        compare(&now, both, changed);
        const double near = fmax(near_enough(c, both->tolerance), fmin(both->open, 0.1 * c->worst));
        if (!(now.worst <= near && (!left || now.worst < left[k]))) continue;
        if (left) left[k] = now.worst;
        snprintf(c->cause, sizeof c->cause, "%s", cause);
    }
}

/* Other codes iterate h to 1e-4 or so. Their particles' eta may scatter by this fraction. */
static const double eta_known = 2e-3;

/* The eta that the other code's smoothing lengths and densities have in common; ours if they have
 * none. open: its relative scatter. */
static double their_eta(const struct both *both, double *open)
{
    const struct setup *setup = both->setup;
    const double *h = both->theirs[0], *rho = both->theirs[1];
    double least = INFINITY, most = -INFINITY;
    if (!h || !rho) return setup->scheme.eta;
    for (size_t i = 0; i < setup->n; i++) {
        const double eta = h[i] * pow(rho[i] / setup->m[i], 1. / setup->dim);
        least = fmin(least, eta), most = fmax(most, eta);
    }
    const double eta = 0.5 * (least + most);
    if (!(most - least < eta_known * eta)) return setup->scheme.eta;
    *open = (most - least) / eta;
    return eta;
}

/* Proposes another kernel, the one that explains most, with our eta or the other code's; or that
 * eta alone. */
static void propose_kernels(struct rate_check *check, const struct both *both)
{
    struct both scattered = *both;
    double left[RATE_COLUMNS];
    const double found = their_eta(both, &scattered.open), ours = both->setup->scheme.eta;
    const bool other = fabs(found - ours) > 1e-6 * ours;
    for (int k = 0; k < RATE_COLUMNS; k++) left[k] = INFINITY;
    for (int k = other ? -1 : 0; k < (int)kernel_family.n; k++) {
        struct setup changed = *both->setup;
        struct rate_table table;
        char cause[RATE_CAUSE];
        const char *name = k < 0 ? "" : kernel_family.members[k]->name;
        if (k >= 0) kernel_select(&changed.scheme.kernel, name, 5, NULL);
        if (other) changed.scheme.eta = found;
        if (k < 0)
            snprintf(cause, sizeof cause, "eta: theirs is %.6g", found);
        else if (other)
            snprintf(cause, sizeof cause, "kernel: theirs is %s, with eta %.6g", name, found);
        else
            snprintf(cause, sizeof cause, "kernel: theirs is %s", name);
        if (!rate_table_make(&table, &changed, NULL))
            propose(check, &scattered, &table, left, cause);
        rate_table_free(&table);
    }
}

/* Proposes rates without grad-h factors, which the oracle can compute and the solver cannot. */
static void propose_no_grad_h(struct rate_check *check, const struct both *both)
{
    const struct setup *setup = both->setup;
    struct oracle oracle = {0};
    struct rate_table changed = *both->ours;
    if (setup->scheme.formulation != FORMULATION_LAGRANGIAN || setup->n > ORACLE_MOST) return;
    for (int a = 0; a < setup->dim; a++)
        if (setup->boundary[a] != BOUNDARY_PERIODIC || setup->gravity[a] != 0) return;
    double *storage = malloc(4 * setup->n * sizeof *storage);
    const bool made = storage && !oracle_create(&oracle, setup, NULL);
    oracle.without_grad_h = true;
    if (made && !oracle_evaluate(&oracle, NULL)) {
        for (int a = 0; a < 3; a++) changed.force[a] = storage + (size_t)a * setup->n;
        changed.dU = storage + 3 * setup->n;
        for (size_t i = 0; i < setup->n; i++) {
            for (int a = 0; a < 3; a++) changed.force[a][i] = (double)oracle.particles[i].F[a];
            changed.dU[i] = (double)oracle.particles[i].dU;
        }
        propose(check, both, &changed, NULL,
                "grad-h: their lagrangian formulation has no grad-h factors");
    }
    free(storage);
    oracle_free(&oracle);
}

/* True if theirs are our values in another order: codes sort particles by keys of their own. */
static bool is_reordered(const struct both *both, int column, double close)
{
    const struct rate_table *ours = both->ours;
    const double *theirs = both->theirs[column], *m = both->setup->m,
                 scale = scale_of(ours, m, column, 0);
    const size_t n = ours->n;
    double *mine = malloc(2 * n * sizeof *mine), *other = mine ? mine + n : NULL;
    bool same = mine != NULL;
    for (size_t i = 0; same && i < n; i++)
        mine[i] = value(ours, m, column, i), other[i] = theirs[i];
    if (same) list_sort(mine, n), list_sort(other, n);
    for (size_t i = 0; same && i < n; i++)
        same = fabs(other[i] - mine[i]) <= close * (column < 3 ? mine[i] : scale);
    free(mine);
    return same;
}

/* Finds causes that the numbers themselves show: a constant factor, a missing term, an order of
 * rows. */
static void explain_plainly(struct rate_comparison *c, const struct both *both)
{
    const struct setup *setup = both->setup;
    const struct rate_table *ours = both->ours;
    const struct kernel *kernel = &setup->scheme.kernel;
    const int column = c->column;
    const double *theirs = both->theirs[column], close = near_enough(c, both->tolerance),
                 scale = scale_of(ours, setup->m, column, 0);
    double ratio = 0, weight = 0, off[4] = {0};
    for (size_t i = 0; i < ours->n; i++) {
        const double mine = value(ours, setup->m, column, i), size = column < 3 ? mine : scale;
        const double own = setup->m[i] * kernel->constant[setup->dim] *
                           kernel->w(kernel, 0, setup->dim) / pow(ours->h[i], setup->dim);
        ratio += theirs[i] * mine / (size * size);
        weight += mine * mine / (size * size);
        worst_keep(&off[0], fabs(theirs[i] + own - mine) / size);
        worst_keep(&off[1], fabs(theirs[i] - setup->m[i] * mine) / size);
        worst_keep(&off[2], fabs(theirs[i] + mine) / size);
    }
    ratio /= weight;
    for (size_t i = 0; i < ours->n; i++) {
        const double mine = value(ours, setup->m, column, i), size = column < 3 ? mine : scale;
        worst_keep(&off[3], fabs(theirs[i] - ratio * mine) / size);
    }
    const bool element_of_energy = setup->scheme.volume_element == VOLUME_ENERGY;
    if (column == 1 && !element_of_energy && off[0] <= close)
        snprintf(c->cause, RATE_CAUSE, "self-contribution: they leave out m W(0)");
    else if (column >= 3 && off[1] <= close)
        snprintf(c->cause, RATE_CAUSE, "they give %s: %s = that over m",
                 column == 6 ? "dU/dt" : "dp/dt", c->quantity);
    else if (column >= 3 && off[2] <= close)
        snprintf(c->cause, RATE_CAUSE, "the sign is the other one");
    else if (off[3] <= close)
        snprintf(c->cause, RATE_CAUSE, "theirs is %.9g times ours everywhere", ratio);
    else if (is_reordered(both, column, close))
        snprintf(c->cause, RATE_CAUSE, "rows: theirs are our values in another order");
}

static void find_causes(struct rate_check *check, const struct both *both)
{
    for (int k = 0;; k++) {
        struct setup changed = *both->setup;
        struct rate_table table;
        const char *cause = make_change(&changed, k);
        if (!cause) break;
        if (!rate_table_make(&table, &changed, NULL)) propose(check, both, &table, NULL, cause);
        rate_table_free(&table);
    }
    propose_no_grad_h(check, both);
    propose_kernels(check, both);
    const char *first = NULL; /* first wrong column; the later ones follow from it */
    for (size_t k = 0; k < check->count; k++) {
        struct rate_comparison *c = &check->columns[k];
        if (c->good) continue;
        if (!c->cause[0]) explain_plainly(c, both);
        c->follows = !c->cause[0] && first && c->column >= 2;
        if (c->follows)
            snprintf(c->cause, RATE_CAUSE, "it follows from %s, or there is more than one", first);
        if (!first && c->column < 3) first = c->quantity;
    }
}

enum status rate_check_make(struct rate_check *check, const char *path, const struct csv *theirs,
                            const struct setup *setup, const struct rate_table *ours,
                            double tolerance, struct error *error)
{
    struct both both = {.setup = setup, .ours = ours, .tolerance = tolerance};
    *check = (struct rate_check){.good = true};
    if (theirs->rows != ours->n)
        return error_set(error, STATUS_BAD_INPUT,
                         "%.200s: %zu rows: allowed: one for each of the %zu particles, in their "
                         "order",
                         path, theirs->rows, ours->n);
    for (int column = 0; column < RATE_COLUMNS; column++) {
        const int k = csv_column(theirs, names[column]);
        if (k < 0 || (column < 6 && column - 3 >= ours->dim)) continue;
        struct rate_comparison *c = &check->columns[check->count++];
        both.theirs[column] = theirs->values[k];
        c->column = column;
        c->quantity = names[column];
        compare(c, &both, ours);
        c->good = c->worst <= tolerance;
        check->good &= c->good;
    }
    if (check->count == 0)
        return error_set(error, STATUS_BAD_INPUT,
                         "%.200s:1: nothing to compare: allowed: any of h rho P ax ay az du", path);
    if (!check->good) find_causes(check, &both);
    return STATUS_OK;
}

enum status rate_check_positions(const char *path, const struct csv *theirs,
                                 const struct setup *setup, struct error *error)
{
    for (int axis = 0; axis < setup->dim; axis++) {
        const char name[] = {"xyz"[axis], '\0'};
        const double side = setup->hi[axis] - setup->lo[axis];
        const int column = csv_column(theirs, name);
        for (size_t i = 0; column >= 0 && i < setup->n && i < theirs->rows; i++) {
            const double theirs_at = theirs->values[column][i];
            double away = theirs_at - setup->x[axis][i];
            if (setup->boundary[axis] == BOUNDARY_PERIODIC) away = remainder(away, side);
            if (fabs(away) <= 1e-5 * side) continue;
            return error_set(
                error, STATUS_BAD_INPUT,
                "%.200s: the row of particle %zu is at %s=%.9g, and the particle is at "
                "%.9g: allowed: the same positions in the same order, or no columns "
                "x y z",
                path, i, name, theirs_at, setup->x[axis][i]);
        }
    }
    return STATUS_OK;
}
