/* SPDX-License-Identifier: GPL-3.0-or-later
 * Checks conservation without time stepping: rates of change of total momentum, angular momentum
 * and energy on random disordered states in 1D, 2D and 3D, for both formulations, standard and ia;
 * and measures what linear_exact and ia do not conserve. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "check.h"
#include "gradient_forms.h"
#include "pair_forces.h"
#include "worst.h"

/* ---- rates ---- */

static const struct pair_forces_subject right[] = {
    {{&standard, NAIVE_NONE}, FORMULATION_VANILLA_ICE, FORCES_RIGHT},
    {{&standard, NAIVE_NONE}, FORMULATION_LAGRANGIAN, FORCES_RIGHT},
    {{&ia, NAIVE_NONE}, FORMULATION_VANILLA_ICE, FORCES_RIGHT},
    {{&ia, NAIVE_NONE}, FORMULATION_LAGRANGIAN, FORCES_RIGHT},
};

static void right_subjects(struct check_run *run)
{
    for (size_t i = 0; i < sizeof right / sizeof *right; i++) check_subject(run, &right[i], 0);
}

/* One subject per operator: mean pair gradients do not depend on the formulation. */
static void right_gradients(struct check_run *run)
{
    for (size_t i = 0; i < sizeof right / sizeof *right; i++)
        if (right[i].formulation == FORMULATION_VANILLA_ICE) check_subject(run, &right[i], 0);
}

static const char *name_of(const struct pair_forces_subject *subject)
{
    static char name[2][64];
    static int turn;
    turn = !turn;
    snprintf(name[turn], sizeof *name, "%s, %s", subject->gradient.form->member.name,
             scheme_formulation_family.members[subject->formulation]->name);
    return name[turn];
}

static void measure_rates(struct check_run *run, const void *subject)
{
    const struct pair_forces_subject *s = subject;
    for (int dim = 1; dim <= 3; dim++) {
        struct pair_forces_rates rates = {(double)NAN, (double)NAN, (double)NAN};
        pair_forces_rates(s, dim, 31, &rates);
        check_measure(run, rates.momentum, 1e-14, 2e-16, "%s, %dD: |dp/dt|", name_of(s), dim);
        check_measure(run, rates.energy, 1e-14, 2e-16, "%s, %dD: |dE/dt|", name_of(s), dim);
        if (strcmp(s->gradient.form->member.name, "standard") == 0 && dim > 1)
            check_measure(run, rates.angular, 1e-14, 2e-16, "%s, %dD: |dL/dt|", name_of(s), dim);
    }
}

#define PAIRS(form, formulation, fault)                                                            \
    (&(const struct pair_forces_subject){                                                          \
        {&(form), NAIVE_NONE}, FORMULATION_##formulation, FORCES_##fault})

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
     &(const struct pair_forces_subject){
         {&linear_exact, NAIVE_NONE}, FORMULATION_VANILLA_ICE, FORCES_RIGHT}},
    {0},
};

CHECK_DEFINE(
    conservation, rates, 308,
    .property = "rates of total momentum, energy and (standard) angular momentum, relative to sums "
                "of absolute values, on disordered states",
    .subjects = right_subjects, .measure = measure_rates, .mutants = rates_mutants);

/* ---- antisymmetry ---- */

/* The mean pair gradient of (i, j) against that of (j, i) in the mirror image of the cloud. They
 * must be equal; the mirror only changes the rounding of the sums. In units in the last place. */
static double antisymmetry(const struct pair_forces_subject *subject, int dim, double *condition)
{
    struct kernel kernel;
    struct pair_forces_state *s = calloc(1, sizeof *s), *t = calloc(1, sizeof *t);
    double worst = 0;
    size_t pairs = 0;
    bool ok = s && t && !kernel_select(&kernel, "quintic_spline", 5, NULL);
    ok = ok && pair_forces_state(s, &kernel, dim, 77) && pair_forces_state(t, &kernel, dim, 77);
    for (size_t i = 0; ok && i < t->n; i++) {
        const size_t k = t->n - 1 - i;
        for (int a = 0; a < dim; a++) t->cloud.x[a][i] = -s->cloud.x[a][k];
        t->cloud.h[i] = s->cloud.h[k], t->cloud.volume[i] = s->cloud.volume[k];
    }
    ok = ok && pair_forces_gradients(s, &subject->gradient, &kernel) &&
         pair_forces_gradients(t, &subject->gradient, &kernel);
    for (size_t i = 0; ok && i < s->n; i++)
        for (size_t j = 0; j < i; j++) {
            double size = 0, sum = 0;
            const size_t k = s->n - 1 - i, l = s->n - 1 - j;
            for (int a = 0; a < dim; a++) {
                const double other =
                    subject->fault == FORCES_GATHER ? s->G[i][j][a] : -s->G[j][i][a];
                const double back =
                    subject->fault == FORCES_GATHER ? t->G[l][k][a] : -t->G[k][l][a];
                worst_keep(&size, fabs(s->G[i][j][a]) + fabs(s->G[j][i][a]));
                worst_keep(&sum, fabs((s->G[i][j][a] + other) - (t->G[l][k][a] + back)));
            }
            if (size == 0) continue; /* not neighbours */
            worst_keep(&worst, sum / size);
            pairs++;
        }
    if (ok) *condition = s->condition;
    if (s) clouds_free(&s->cloud);
    if (t) clouds_free(&t->cloud);
    free(s), free(t);
    return ok && pairs ? worst / 0x1p-52 : (double)NAN;
}

static void measure_antisymmetry(struct check_run *run, const void *subject)
{
    const struct pair_forces_subject *s = subject;
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

CHECK_DEFINE(conservation, antisymmetry, 304, .says = "pair gradients are not antisymmetric",
             .property = "mean pair gradients: Gbar_ij = -Gbar_ji, in units of the last place",
             .subjects = right_gradients, .measure = measure_antisymmetry,
             .mutants = antisymmetry_mutants);

/* ---- defects: what is not conserved, and by how much ---- */

/* linear_exact must not conserve momentum, nor ia angular momentum in 2D and 3D: otherwise the
 * check measures a different operator. */
static void measure_defects(struct check_run *run, const void *subject)
{
    static const struct pair_forces_subject exact = {
        {&linear_exact, NAIVE_NONE}, FORMULATION_VANILLA_ICE, FORCES_RIGHT};
    const struct pair_forces_subject *momentum = subject ? subject : &exact;
    const struct pair_forces_subject *angular = subject ? subject : &right[2];
    const double least = 1e-5;
    for (int dim = 1; dim <= 3; dim++) {
        struct pair_forces_rates rates = {(double)NAN, (double)NAN, (double)NAN};
        pair_forces_rates(momentum, dim, 47, &rates);
        check_measure(run, least / rates.momentum, 1, 1e-4,
                      "linear_exact, %dD: momentum defect %.2e, angular %.2e, energy %.2e", dim,
                      rates.momentum, rates.angular, rates.energy);
        if (dim == 1) continue;
        pair_forces_rates(angular, dim, 47, &rates);
        check_measure(run, least / rates.angular, 1, 1e-4, "ia, %dD: angular momentum defect %.2e",
                      dim, rates.angular);
    }
}

static const struct check_mutant defects_mutants[] = {
    {"defect_of_ia", "ia in the place of linear_exact", PAIRS(ia, VANILLA_ICE, RIGHT)},
    {"defect_of_standard", "standard in the place of ia", PAIRS(standard, VANILLA_ICE, RIGHT)},
    {0},
};

CHECK_DEFINE(
    conservation, defects, 350,
    .property =
        "what is not conserved: momentum by linear_exact, angular momentum by ia (1e-5 over "
        "the relative rate)",
    .measure = measure_defects, .mutants = defects_mutants);
