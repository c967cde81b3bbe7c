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
    switch (column) {
    case 0:
        return table->h[i];
    case 1:
        return table->rho[i];
    case 2:
        return table->P[i];
    case 6:
        return table->dU[i] / m[i];
    default:
        return table->force[column - 3][i] / m[i];
    }
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

/* Fills everything except the cause. The particle stays 0 if nothing differs. */
static void compare(struct rate_comparison *c, const double *theirs, const struct rate_table *ours,
                    const double *m, int column)
{
    const double common = scale_of(ours, m, column, 0);
    double sum = 0;
    c->worst = 0;
    for (size_t i = 0; i < ours->n; i++) {
        const double scale = column < 3 ? scale_of(ours, m, column, i) : common;
        const double d = relative(fabs(theirs[i] - value(ours, m, column, i)), scale);
        if (!(d <= c->worst)) c->particle = i;
        worst_keep(&c->worst, d);
        sum += d * d;
    }
    c->rms = sqrt(sum / (double)ours->n);
}

/* --- causes ----------------------------------------------------------------------------------- */

typedef void change(struct setup *setup);

#define CHANGE(name, key, value)                                                                   \
    static void name(struct setup *setup)                                                          \
    {                                                                                              \
        setup->key = value;                                                                        \
    }
CHANGE(no_viscosity, scheme.viscosity, VISCOSITY_NONE)
CHANGE(constant_viscosity, scheme.viscosity, VISCOSITY_CONSTANT)
CHANGE(no_beta, scheme.beta, 0)
CHANGE(beta_alpha, scheme.beta, setup->scheme.alpha)
CHANGE(twice_alpha, scheme.alpha, 2 * setup->scheme.alpha)
CHANGE(half_alpha, scheme.alpha, setup->scheme.alpha / 2)
CHANGE(mu_form, scheme.viscosity_form, VISCOSITY_FORM_MU)
CHANGE(signal_form, scheme.viscosity_form, VISCOSITY_FORM_SIGNAL)
CHANGE(with_balsara, scheme.balsara, BALSARA_ON)
CHANGE(without_balsara, scheme.balsara, BALSARA_OFF)
CHANGE(width_max, scheme.pair_width, PAIR_WIDTH_MAX)
CHANGE(width_mean, scheme.pair_width, PAIR_WIDTH_MEAN)
CHANGE(width_harmonic, scheme.pair_width, PAIR_WIDTH_HARMONIC)
CHANGE(standard, scheme.gradient, GRADIENT_STANDARD)
CHANGE(ia, scheme.gradient, GRADIENT_IA)
CHANGE(corrected, scheme.gradient, GRADIENT_CORRECTED)
CHANGE(blended, scheme.gradient, GRADIENT_BLENDED)
CHANGE(vanilla_ice, scheme.formulation, FORMULATION_VANILLA_ICE)
CHANGE(lagrangian, scheme.formulation, FORMULATION_LAGRANGIAN)
CHANGE(mass, scheme.volume_element, VOLUME_MASS)
CHANGE(energy, scheme.volume_element, VOLUME_ENERGY)
CHANGE(number, scheme.volume_element, VOLUME_NUMBER)
CHANGE(gamma_5_3, gamma, 5. / 3)
CHANGE(gamma_7_5, gamma, 1.4)
CHANGE(half_eta, scheme.eta, setup->scheme.eta / 2)
CHANGE(twice_eta, scheme.eta, 2 * setup->scheme.eta)
#undef CHANGE

static void conduction(struct setup *setup)
{
    setup->scheme.alpha_u = setup->scheme.shock_conductivity = 0;
}

static void shock_conduction(struct setup *setup)
{
    setup->scheme.shock_conductivity = 1;
}

static void twice_viscosity(struct setup *setup)
{
    twice_alpha(setup);
    setup->scheme.beta *= 2;
}

static void half_viscosity(struct setup *setup)
{
    half_alpha(setup);
    setup->scheme.beta /= 2;
}

static void open_box(struct setup *setup)
{
    for (int a = 0; a < setup->dim; a++) setup->boundary[a] = BOUNDARY_OPEN;
}

static const struct {
    change *make;
    const char *cause;
} changes[] = {
    {no_viscosity, "viscosity: they have none"},
    {constant_viscosity, "viscosity: theirs is constant"},
    {no_beta, "viscosity: theirs has no quadratic term (beta = 0)"},
    {beta_alpha, "viscosity: beta = alpha in theirs"},
    {twice_alpha, "viscosity: alpha is twice ours"},
    {half_alpha, "viscosity: alpha is half of ours"},
    {twice_viscosity, "viscosity: alpha and beta are twice ours"},
    {half_viscosity, "viscosity: alpha and beta are half of ours"},
    {mu_form, "viscosity: theirs is of the form mu"},
    {signal_form, "viscosity: theirs is of the form signal"},
    {with_balsara, "viscosity: theirs has a Balsara factor"},
    {without_balsara, "viscosity: theirs has no Balsara factor"},
    {width_max, "pair width: theirs is max(h_i, h_j)"},
    {width_mean, "pair width: theirs is the mean of both gradients"},
    {width_harmonic, "pair width: theirs is the harmonic mean"},
    {standard, "gradient: theirs is standard"},
    {ia, "gradient: theirs is ia"},
    {corrected, "gradient: theirs is corrected"},
    {blended, "gradient: theirs is blended"},
    {vanilla_ice, "pressure: their formulation is vanilla_ice"},
    {lagrangian, "pressure: their formulation is lagrangian, with grad-h factors"},
    {mass, "volume element: theirs is mass"},
    {energy, "volume element: theirs is energy"},
    {number, "volume element: theirs is number"},
    {conduction, "conductivity: they have none"},
    {shock_conduction, "conductivity: theirs is 1 in strong shocks (shock_conductivity=1)"},
    {gamma_5_3, "gamma: theirs is 5/3"},
    {gamma_7_5, "gamma: theirs is 1.4"},
    {half_eta, "eta: theirs is half of ours (h is the support radius here)"},
    {twice_eta, "eta: theirs is twice ours (h is the support radius here)"},
    {open_box, "boundary: theirs is open"},
};

/* A cause explains a difference if it reduces the difference to the tolerance or by a factor of
 * 1000. An infinite difference, relative to rates of 0, must fall to the tolerance. */
static double near_enough(const struct rate_comparison *c, double tolerance)
{
    return isinf(c->worst) ? tolerance : fmax(tolerance, 1e-3 * c->worst);
}

/* Names this cause for the columns that it explains better than the cause named so far. left: the
 * remaining difference of each column with the cause named so far, INFINITY before the first; a
 * column keeps a cause that explains as much. open: relative uncertainty of the other code's eta; a
 * difference of that size also counts as explained if the cause removes nine tenths of it. */
static void propose_better(struct rate_check *check, const double *const theirs[RATE_COLUMNS],
                           const struct rate_table *changed, const double *m, double tolerance,
                           double open, double left[RATE_COLUMNS], const char *cause)
{
    for (size_t k = 0; k < check->count; k++) {
        struct rate_comparison *c = &check->columns[k], now = *c;
        if (c->good || (c->cause[0] && isinf(left[k]))) continue;
        compare(&now, theirs[c->column], changed, m, c->column);
        const double near = fmax(near_enough(c, tolerance), fmin(open, 0.1 * c->worst));
        if (!(now.worst <= near && now.worst < left[k])) continue;
        left[k] = now.worst;
        snprintf(c->cause, sizeof c->cause, "%s", cause);
    }
}

static void leave_all(double left[RATE_COLUMNS])
{
    for (int k = 0; k < RATE_COLUMNS; k++) left[k] = INFINITY;
}

/* Names this cause for the columns that it explains and that have no cause yet. */
static void propose(struct rate_check *check, const double *const theirs[RATE_COLUMNS],
                    const struct rate_table *changed, const double *m, double tolerance,
                    const char *cause)
{
    double left[RATE_COLUMNS];
    leave_all(left);
    propose_better(check, theirs, changed, m, tolerance, 0, left, cause);
}

/* Other codes iterate h to 1e-4 or so. Their particles' eta may scatter by this fraction. */
static const double eta_known = 2e-3;

/* The eta that the other code's smoothing lengths and densities have in common; ours if they have
 * none. open: its relative scatter. */
static double their_eta(const double *const theirs[RATE_COLUMNS], const struct setup *setup,
                        double *open)
{
    const double *h = theirs[0], *rho = theirs[1];
    double least = INFINITY, most = -INFINITY;
    if (!h || !rho) return setup->scheme.eta;
    for (size_t i = 0; i < setup->n; i++) {
        const double eta = h[i] * pow(rho[i] / setup->m[i], 1. / setup->dim);
        least = fmin(least, eta), most = fmax(most, eta);
    }
    const double eta = 0.5 * (least + most);
    if (!(eta > 0 && most - least <= eta_known * eta)) return setup->scheme.eta;
    *open = (most - least) / eta;
    return eta;
}

/* Proposes another kernel, the one that explains most, with our eta or the other code's; or that
 * eta alone. */
static void propose_kernels(struct rate_check *check, const double *const theirs[RATE_COLUMNS],
                            const struct setup *setup, double tolerance)
{
    double open = 0, left[RATE_COLUMNS];
    leave_all(left);
    const double found = their_eta(theirs, setup, &open), ours = setup->scheme.eta;
    const bool other = fabs(found - ours) > 1e-6 * ours;
    for (int k = -1; k < (int)kernel_family.n; k++) {
        struct setup changed = *setup;
        struct rate_table table;
        char cause[RATE_CAUSE];
        const char *name = k < 0 ? "" : kernel_family.members[k]->name;
        if (k < 0 && !other) continue;
        if (k >= 0 && kernel_select(&changed.scheme.kernel, name, 5, NULL)) continue;
        if (other) changed.scheme.eta = found;
        if (k < 0)
            snprintf(cause, sizeof cause, "eta: theirs is %.6g", found);
        else if (other)
            snprintf(cause, sizeof cause, "kernel: theirs is %s, with eta %.6g", name, found);
        else
            snprintf(cause, sizeof cause, "kernel: theirs is %s", name);
        if (!rate_table_make(&table, &changed, NULL))
            propose_better(check, theirs, &table, setup->m, tolerance, open, left, cause);
        rate_table_free(&table);
    }
}

/* Proposes rates without grad-h factors, which the oracle can compute and the solver cannot. */
static void propose_no_grad_h(struct rate_check *check, const double *const theirs[RATE_COLUMNS],
                              const struct setup *setup, const struct rate_table *ours,
                              double tolerance)
{
    struct oracle oracle;
    struct rate_table changed = *ours;
    if (setup->scheme.formulation != FORMULATION_LAGRANGIAN || setup->n > ORACLE_MOST) return;
    for (int a = 0; a < setup->dim; a++)
        if (setup->boundary[a] != BOUNDARY_PERIODIC || setup->gravity[a] != 0) return;
    double *storage = changed.storage = NULL;
    if (oracle_create(&oracle, setup, NULL)) return;
    oracle.without_grad_h = true;
    if (!oracle_evaluate(&oracle, NULL) &&
        (storage = malloc(4 * setup->n * sizeof *storage)) != NULL) {
        for (int a = 0; a < 3; a++) changed.force[a] = storage + (size_t)a * setup->n;
        changed.dU = storage + 3 * setup->n;
        for (size_t i = 0; i < setup->n; i++) {
            for (int a = 0; a < 3; a++) changed.force[a][i] = (double)oracle.particles[i].F[a];
            changed.dU[i] = (double)oracle.particles[i].dU;
        }
        propose(check, theirs, &changed, setup->m, tolerance,
                "grad-h: their lagrangian formulation has no grad-h factors");
    }
    free(storage);
    oracle_free(&oracle);
}

/* True if theirs are our values in another order: codes sort particles by keys of their own. */
static bool is_reordered(const double *theirs, int column, const struct setup *setup,
                         const struct rate_table *ours, double close)
{
    const double scale = scale_of(ours, setup->m, column, 0);
    const size_t n = ours->n;
    double *mine = malloc(2 * n * sizeof *mine), *other = mine ? mine + n : NULL;
    bool same = mine != NULL;
    for (size_t i = 0; same && i < n; i++)
        mine[i] = value(ours, setup->m, column, i), other[i] = theirs[i];
    if (same) list_sort(mine, n), list_sort(other, n);
    for (size_t i = 0; same && i < n; i++)
        same = fabs(other[i] - mine[i]) <= close * (column < 3 ? mine[i] : scale);
    free(mine);
    return same;
}

/* Finds causes that the numbers themselves show: a constant factor, a missing term, an order of
 * rows. */
static void explain_plainly(struct rate_comparison *c, const double *theirs, int column,
                            const struct setup *setup, const struct rate_table *ours,
                            double tolerance)
{
    const struct kernel *kernel = &setup->scheme.kernel;
    const double close = near_enough(c, tolerance);
    const double scale = scale_of(ours, setup->m, column, 0);
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
    else if (is_reordered(theirs, column, setup, ours, close))
        snprintf(c->cause, RATE_CAUSE, "rows: theirs are our values in another order");
}

static void find_causes(struct rate_check *check, const double *const theirs[RATE_COLUMNS],
                        const struct setup *setup, const struct rate_table *ours, double tolerance)
{
    for (size_t k = 0; k < sizeof changes / sizeof *changes; k++) {
        struct setup changed = *setup;
        struct rate_table table;
        changes[k].make(&changed);
        if (!rate_table_make(&table, &changed, NULL))
            propose(check, theirs, &table, setup->m, tolerance, changes[k].cause);
        rate_table_free(&table);
    }
    propose_no_grad_h(check, theirs, setup, ours, tolerance);
    propose_kernels(check, theirs, setup, tolerance);
    const char *first = NULL; /* first wrong column; the later ones follow from it */
    for (size_t k = 0; k < check->count; k++) {
        struct rate_comparison *c = &check->columns[k];
        const int column = c->column;
        if (c->good) continue;
        if (!c->cause[0]) explain_plainly(c, theirs[column], column, setup, ours, tolerance);
        c->follows = !c->cause[0] && first && column >= 2;
        if (c->follows)
            snprintf(c->cause, RATE_CAUSE, "it follows from %s, or there is more than one", first);
        if (!first && column < 3) first = c->quantity;
    }
}

enum status rate_check_make(struct rate_check *check, const char *path, const struct csv *theirs,
                            const struct setup *setup, const struct rate_table *ours,
                            double tolerance, struct error *error)
{
    const double *columns[RATE_COLUMNS] = {NULL};
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
        columns[column] = theirs->values[k];
        c->column = column;
        c->quantity = names[column];
        compare(c, columns[column], ours, setup->m, column);
        c->good = c->worst <= tolerance;
        check->good &= c->good;
    }
    if (check->count == 0)
        return error_set(error, STATUS_BAD_INPUT,
                         "%.200s:1: nothing to compare: allowed: any of h rho P ax ay az du", path);
    if (!check->good) find_causes(check, columns, setup, ours, tolerance);
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
