/* SPDX-License-Identifier: GPL-3.0-or-later
 * Conservation without time stepping: rates of change of total momentum, angular momentum and
 * energy on random disordered states in 1D, 2D and 3D, from pair forces (PHYSICS section 5) whose
 * gradients G_ij are src's operators applied to fields that are 1 at one point. */
#include <gsl/gsl_rng.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "check.h"
#include "gradient_forms.h"
#include "scheme.h"
#include "summation.h"

enum pair_fault {
    PAIR_RIGHT,
    PAIR_GATHER,        /* G(h_i) for the mean */
    PAIR_HALF_IN_FORCE, /* mean without the 1/2 in the force, with it in the heating */
    PAIR_PLUS,          /* difference for sum of the two gradients */
    PAIR_OWN_F,         /* f_i in both terms of the Lagrangian force */
    PAIR_NO_F,          /* no f in the heating */
    PAIR_OWN_PRESSURE,  /* P_i for P_i + P_j */
    PAIR_HEATING_SIGN,  /* v_j - v_i in the heating of one of ten points */
    PAIR_OWN_MATRIX,    /* G(h_j) of particle j divided by the volume of i */
};

struct conservation_subject {
    struct gradient_subject gradient;
    enum formulation formulation;
    enum pair_fault fault;
};

enum { N_MAX = 64 };

struct state {
    int dim;
    size_t n;
    struct clouds_cloud cloud; /* volume = m/rho */
    double m[N_MAX], v[3][N_MAX], P[N_MAX], rho[N_MAX], f[N_MAX], condition;
    double G[N_MAX][N_MAX][3]; /* G_ij(h_i) */
};

struct rates {
    double momentum, angular, energy; /* relative to the sums of absolute values */
};

/* ---- a disordered state ---- */

static bool state_make(struct state *s, const struct kernel *kernel, int dim, unsigned long seed)
{
    const size_t side[] = {0, 50, 7, 4};
    const struct clouds_settings settings = {CLOUDS_JITTERED, dim, side[dim], 0.45, 2.6, seed};
    gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    *s = (struct state){.dim = dim};
    bool ok = rng && !clouds_make(&settings, &s->cloud, NULL);
    if (ok) gsl_rng_set(rng, seed + 1);
    s->n = ok ? s->cloud.cloud.points.n : 0;
    for (size_t i = 0; i < s->n; i++) {
        s->m[i] = s->cloud.volume[i] * (0.6 + 0.8 * gsl_rng_uniform(rng));
        s->P[i] = 2.385 * (0.3 + gsl_rng_uniform(rng));
        for (int a = 0; a < dim; a++) s->v[a][i] = 2 * gsl_rng_uniform(rng) - 0.7;
    }
    if (rng) gsl_rng_free(rng);
    const struct summation sum = {s->cloud.cloud.points, kernel, s->m, settings.eta, 1e-13, 1};
    ok = ok && !summation_solve(&sum, s->cloud.h, s->rho, NULL);
    for (size_t i = 0; ok && i < s->n; i++) {
        double slope = 0; /* d rho/dh */
        for (size_t j = 0; j < s->n; j++) {
            double r = 0;
            for (int a = 0; a < dim; a++) r = hypot(r, s->cloud.x[a][j] - s->cloud.x[a][i]);
            slope += s->m[j] * kernel_dh(kernel, r, s->cloud.h[i], dim);
        }
        s->f[i] = 1 / (1 + s->cloud.h[i] / (dim * s->rho[i]) * slope);
        s->cloud.volume[i] = s->m[i] / s->rho[i];
    }
    return ok;
}

/* G_ij for all pairs: the operator applied to the n fields delta_ij / V_j at once. */
static bool state_gradients(struct state *s, const struct gradient_subject *subject,
                            const struct kernel *kernel)
{
    struct operator_point point[N_MAX];
    for (size_t j = 0; j < s->n; j++) {
        double unit[N_MAX] = {0}, g[3][N_MAX], *const gradient[3] = {g[0], g[1], g[2]};
        unit[j] = 1 / s->cloud.volume[j];
        if (gradient_study_apply(subject, kernel, &s->cloud.cloud, unit, gradient, point, NULL))
            return false;
        for (size_t i = 0; i < s->n; i++) {
            s->condition = fmax(s->condition, point[i].condition);
            for (int a = 0; a < s->dim; a++) s->G[i][j][a] = i == j ? 0 : g[a][i];
        }
    }
    return true;
}

/* ---- forces ---- */

/* Force on i by j and heating of i by j. */
static void pair_force(const struct state *s, const struct conservation_subject *subject, size_t i,
                       size_t j, double *force, double *heating)
{
    const double mm = s->m[i] * s->m[j], *rho = s->rho, *P = s->P;
    const bool lagrangian = subject->formulation == FORMULATION_LAGRANGIAN;
    const enum pair_fault fault = subject->fault;
    *heating = 0;
    for (int a = 0; a < s->dim; a++) {
        const double own = s->G[i][j][a];
        double other = -s->G[j][i][a], v = s->v[a][i] - s->v[a][j];
        if (fault == PAIR_PLUS) other = -other;
        if (fault == PAIR_GATHER) other = own;
        if (fault == PAIR_OWN_MATRIX) other *= s->cloud.volume[j] / s->cloud.volume[i];
        if (fault == PAIR_HEATING_SIGN && i % 10 == 3) v = -v;
        const double mean = 0.5 * (own + other);
        if (lagrangian) {
            const double fi = s->f[i], fj = fault == PAIR_OWN_F ? fi : s->f[j];
            const double A = fi * P[i] / (rho[i] * rho[i]), B = fj * P[j] / (rho[j] * rho[j]);
            force[a] = -mm * (A * own + B * other);
            *heating += mm * (fault == PAIR_NO_F ? A / fi : A) * v * own;
        } else {
            const double pressure = P[i] + (fault == PAIR_OWN_PRESSURE ? P[i] : P[j]);
            force[a] = -mm * pressure / (rho[i] * rho[j]) *
                       (fault == PAIR_HALF_IN_FORCE ? 2 * mean : mean);
            *heating += mm * P[i] / (rho[i] * rho[j]) * v * mean;
        }
    }
}

/* The momentum equation rho dv/dt = -grad P with a difference operator: no pair forces. */
static void difference_force(const struct state *s, size_t i, size_t j, double *force,
                             double *heating)
{
    const double V = s->cloud.volume[i], Vj = s->cloud.volume[j];
    *heating = 0;
    for (int a = 0; a < s->dim; a++) {
        force[a] = -V * Vj * (s->P[j] - s->P[i]) * s->G[i][j][a];
        *heating -= V * s->P[i] * Vj * (s->v[a][j] - s->v[a][i]) * s->G[i][j][a];
    }
}

static struct rates state_rates(const struct state *s, const struct conservation_subject *subject)
{
    double p[3] = {0}, L[3] = {0}, E = 0, p_scale = 0, L_scale = 0, E_scale = 0;
    for (size_t i = 0; i < s->n; i++)
        for (size_t j = 0; j < s->n; j++) {
            double force[3] = {0}, x[3] = {0}, heating, work = 0, size = 0, r = 0;
            if (i == j) continue;
            if (subject->gradient.form->difference)
                difference_force(s, i, j, force, &heating);
            else
                pair_force(s, subject, i, j, force, &heating);
            for (int a = 0; a < s->dim; a++) {
                x[a] = s->cloud.x[a][i];
                p[a] += force[a], work += s->v[a][i] * force[a];
                size = hypot(size, force[a]), r = hypot(r, x[a]);
            }
            for (int a = 0; a < 3; a++)
                L[a] += x[(a + 1) % 3] * force[(a + 2) % 3] - x[(a + 2) % 3] * force[(a + 1) % 3];
            E += work + heating;
            p_scale += size, L_scale += r * size, E_scale += fabs(work) + fabs(heating);
        }
    return (struct rates){hypot(hypot(p[0], p[1]), p[2]) / p_scale,
                          hypot(hypot(L[0], L[1]), L[2]) / L_scale, fabs(E) / E_scale};
}

static bool measure_state(const struct conservation_subject *subject, int dim, unsigned long seed,
                          struct rates *rates, double *condition)
{
    struct kernel kernel;
    struct state *s = malloc(sizeof *s);
    bool ok = s && !kernel_select(&kernel, dim == 2 ? "wendland_c4" : "cubic_spline", 5, NULL);
    ok = ok && state_make(s, &kernel, dim, seed) && state_gradients(s, &subject->gradient, &kernel);
    if (ok) *rates = state_rates(s, subject), *condition = s->condition;
    if (s) clouds_free(&s->cloud);
    free(s);
    return ok;
}

/* ---- rates ---- */

static const struct conservation_subject right[] = {
    {{&standard, NAIVE_NONE}, FORMULATION_VANILLA_ICE, PAIR_RIGHT},
    {{&standard, NAIVE_NONE}, FORMULATION_LAGRANGIAN, PAIR_RIGHT},
    {{&ia, NAIVE_NONE}, FORMULATION_VANILLA_ICE, PAIR_RIGHT},
    {{&ia, NAIVE_NONE}, FORMULATION_LAGRANGIAN, PAIR_RIGHT},
};

static size_t right_count(void)
{
    return sizeof right / sizeof *right;
}

static const void *right_at(size_t i)
{
    return &right[i];
}

static const char *name_of(const struct conservation_subject *subject)
{
    static char name[2][64];
    static int turn;
    turn = !turn;
    snprintf(name[turn], sizeof *name, "%s, %s", subject->gradient.form->member.name,
             formulation_family.members[subject->formulation]->name);
    return name[turn];
}

static void measure_rates(struct check_run *run, const void *subject)
{
    const struct conservation_subject *s = subject;
    for (int dim = 1; dim <= 3; dim++) {
        struct rates rates = {(double)NAN, (double)NAN, (double)NAN};
        double condition = 1;
        measure_state(s, dim, 31, &rates, &condition);
        check_measure(run, rates.momentum, 1e-14, 2e-16, "%s, %dD: |dp/dt|", name_of(s), dim);
        check_measure(run, rates.energy, 1e-14, 2e-16, "%s, %dD: |dE/dt|", name_of(s), dim);
        if (strcmp(s->gradient.form->member.name, "standard") == 0 && dim > 1)
            check_measure(run, rates.angular, 1e-14, 2e-16, "%s, %dD: |dL/dt|", name_of(s), dim);
    }
}

#define PAIRS(form, formulation, fault)                                                            \
    (&(const struct conservation_subject){                                                         \
        {&(form), NAIVE_NONE}, FORMULATION_##formulation, PAIR_##fault})

static const struct check_mutant rates_mutants[] = {
    {"pair_gather", "G(h_i) for the mean: gather for symmetric",
     PAIRS(standard, VANILLA_ICE, GATHER)},
    {"pair_gather_ia", "C_i for both matrices", PAIRS(ia, LAGRANGIAN, GATHER)},
    {"pair_no_half", "1/2 of the pair average missing in the force",
     PAIRS(standard, VANILLA_ICE, HALF_IN_FORCE)},
    {"pair_sign", "G_i - G_j for G_i + G_j", PAIRS(ia, VANILLA_ICE, PLUS)},
    {"pair_own_factor", "f_i in both terms", PAIRS(standard, LAGRANGIAN, OWN_F)},
    {"pair_no_factor", "grad-h factor dropped in the heating", PAIRS(ia, LAGRANGIAN, NO_F)},
    {"pair_own_pressure", "2 P_i for P_i + P_j", PAIRS(standard, VANILLA_ICE, OWN_PRESSURE)},
    {"pair_heating_sign", "v_ji for v_ij at some points",
     PAIRS(standard, VANILLA_ICE, HEATING_SIGN)},
    {"pair_own_matrix", "V_i for V_j with G(h_j)", PAIRS(ia, VANILLA_ICE, OWN_MATRIX)},
    {"pair_linear_exact", "linear_exact in the place of ia",
     &(const struct conservation_subject){
         {&linear_exact, NAIVE_NONE}, FORMULATION_VANILLA_ICE, PAIR_RIGHT}},
    {0},
};

const struct check check_conservation_rates = {
    .group = "conservation",
    .name = "rates",
    .property = "rates of total momentum, energy and (standard) angular momentum, relative to sums "
                "of absolute values, on disordered states",
    .subject_count = right_count,
    .subject = right_at,
    .measure = measure_rates,
    .mutants = rates_mutants,
};

/* ---- antisymmetry ---- */

/* The mean pair gradient of (i, j) against that of (j, i) in the mirror image of the cloud, where
 * it must be the same; the mirror only makes the sums round differently. In units of the last
 * place. */
static double antisymmetry(const struct conservation_subject *subject, int dim, double *condition)
{
    struct kernel kernel;
    struct state *s = malloc(sizeof *s), *t = malloc(sizeof *t);
    double worst = (double)NAN;
    bool ok = s && t && !kernel_select(&kernel, "quintic_spline", 5, NULL);
    if (s) *s = (struct state){0};
    if (t) *t = (struct state){0};
    ok = ok && state_make(s, &kernel, dim, 77) && state_make(t, &kernel, dim, 77);
    for (size_t i = 0; ok && i < t->n; i++) {
        const size_t k = t->n - 1 - i;
        for (int a = 0; a < dim; a++) t->cloud.x[a][i] = -s->cloud.x[a][k];
        t->cloud.h[i] = s->cloud.h[k], t->cloud.volume[i] = s->cloud.volume[k];
    }
    ok = ok && state_gradients(s, &subject->gradient, &kernel) &&
         state_gradients(t, &subject->gradient, &kernel);
    for (size_t i = 0; ok && i < s->n; i++)
        for (size_t j = 0; j < i; j++) {
            double size = 0, sum = 0;
            const size_t k = s->n - 1 - i, l = s->n - 1 - j;
            for (int a = 0; a < dim; a++) {
                const double other = subject->fault == PAIR_GATHER ? s->G[i][j][a] : -s->G[j][i][a];
                const double back = subject->fault == PAIR_GATHER ? t->G[l][k][a] : -t->G[k][l][a];
                size = fmax(size, fabs(s->G[i][j][a]) + fabs(s->G[j][i][a]));
                sum = fmax(sum, fabs((s->G[i][j][a] + other) - (t->G[l][k][a] + back)));
            }
            if (size > 0 && !(sum / size <= worst)) worst = sum / size;
        }
    if (ok) *condition = s->condition;
    if (s) clouds_free(&s->cloud);
    if (t) clouds_free(&t->cloud);
    free(s), free(t);
    return worst / 0x1p-52;
}

static void measure_antisymmetry(struct check_run *run, const void *subject)
{
    const struct conservation_subject *s = subject;
    if (s->formulation == FORMULATION_LAGRANGIAN) return; /* the same pair gradients */
    for (int dim = 1; dim <= 3; dim++) {
        double condition = 1;
        const double ulps = antisymmetry(s, dim, &condition);
        const double bound = s->gradient.form->corrected ? 16 * condition : 4;
        check_measure(run, ulps, bound, bound / 16, "%s, %dD: |G_ij + G_ji| in ULPs",
                      s->gradient.form->member.name, dim);
    }
}

static const struct check_mutant antisymmetry_mutants[] = {
    {"antisymmetry_gather", "G(h_i) for the mean", PAIRS(standard, VANILLA_ICE, GATHER)},
    {"antisymmetry_gather_ia", "C_i for both matrices", PAIRS(ia, VANILLA_ICE, GATHER)},
    {0},
};

const struct check check_conservation_antisymmetry = {
    .group = "conservation",
    .name = "antisymmetry",
    .property = "mean pair gradients: Gbar_ij = -Gbar_ji, in units of the last place",
    .subject_count = right_count,
    .subject = right_at,
    .measure = measure_antisymmetry,
    .mutants = antisymmetry_mutants,
};

/* ---- defects: what is not conserved, and by how much ---- */

/* linear_exact must not conserve momentum, ia not angular momentum in 2D and 3D: if they do, the
 * thing measured is not that operator. */
static void measure_defects(struct check_run *run, const void *subject)
{
    static const struct conservation_subject exact = {
        {&linear_exact, NAIVE_NONE}, FORMULATION_VANILLA_ICE, PAIR_RIGHT};
    const struct conservation_subject *momentum = subject ? subject : &exact;
    const struct conservation_subject *angular = subject ? subject : &right[2];
    const double least = 1e-5;
    for (int dim = 1; dim <= 3; dim++) {
        struct rates rates = {(double)NAN, (double)NAN, (double)NAN};
        double condition;
        measure_state(momentum, dim, 47, &rates, &condition);
        check_measure(run, least / rates.momentum, 1, 1e-4,
                      "linear_exact, %dD: momentum defect %.2e, angular %.2e, energy %.2e", dim,
                      rates.momentum, rates.angular, rates.energy);
        if (dim == 1) continue;
        measure_state(angular, dim, 47, &rates, &condition);
        check_measure(run, least / rates.angular, 1, 1e-4, "ia, %dD: angular momentum defect %.2e",
                      dim, rates.angular);
    }
}

static const struct check_mutant defects_mutants[] = {
    {"defect_of_ia", "ia in the place of linear_exact", PAIRS(ia, VANILLA_ICE, RIGHT)},
    {"defect_of_standard", "standard in the place of ia", PAIRS(standard, VANILLA_ICE, RIGHT)},
    {0},
};

const struct check check_conservation_defects = {
    .group = "conservation",
    .name = "defects",
    .property =
        "what is not conserved: momentum by linear_exact, angular momentum by ia (1e-5 over "
        "the relative rate)",
    .measure = measure_defects,
    .mutants = defects_mutants,
};
