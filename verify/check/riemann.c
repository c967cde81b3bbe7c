/* SPDX-License-Identifier: GPL-3.0-or-later
 * Checks of the exact Riemann solver: a table, the laws that its solutions must obey on random
 * problems, vacuum, and symmetries. Toro (2009), chapters 3 and 4. */
#include <math.h>

#include "check.h"
#include "riemann_property.h"
#include "worst.h"

enum { PROBLEMS = 2000 };

static double relative(double value, double expected)
{
    return fabs(value - expected) / fabs(expected);
}

/* ---- table ---- */

/* Star states to 17 digits from a solver in multiple precision; the problems of Toro (2009), table
 * 4.1, and others. */
static const struct row {
    const char *name;
    struct riemann_problem problem;
    struct {
        double p, v, rho_left, rho_right;
    } star;
} rows[] = {
    {"Sod",
     {1.4, {1, 0, 1}, {0.125, 0, 0.1}},
     {0.30313017805064682, 0.92745262004894995, 0.42631942817849519, 0.26557371170530706}},
    {"Sod with gamma = 5/3",
     {5. / 3, {1, 0, 1}, {0.125, 0, 0.1}},
     {0.29394518766601783, 0.84119485216880841, 0.47968905872091747, 0.22980574931194701}},
    {"123 (two rarefactions)",
     {1.4, {1, -2, 0.4}, {1, 2, 0.4}},
     {0.0018938734200547630, 0, 0.021852118206812831, 0.021852118206812831}},
    {"left blast",
     {1.4, {1, 0, 1000}, {1, 0, 0.01}},
     {460.89378749138354, 19.597451388723052, 0.57506229847655549, 5.9992407047962340}},
    {"right blast",
     {1.4, {1, 0, 0.01}, {1, 0, 100}},
     {46.095044248867966, -6.1963282497870359, 5.9924168635152249, 0.57511278978241230}},
    {"collision",
     {1.4, {5.99924, 19.5975, 460.894}, {5.99242, -6.19633, 46.095}},
     {1691.6469553991261, 8.6897744116323806, 14.282349951978402, 31.042601641619876}},
    {"Noh",
     {5. / 3, {1, 1, 1e-6}, {1, -1, 1e-6}},
     {1.3333355833321615, 0, 3.9999887500527341, 3.9999887500527341}},
    {"LeBlanc",
     {5. / 3, {1, 0, 1. / 15}, {1e-3, 0, 1. / 15 * 1e-9}},
     {5.1557792765096986e-4, 0.62183867139173445, 0.054079335349316236, 0.0039999980604299968}},
};

static void measure_table(struct check_run *run, const void *subject)
{
    const struct riemann_subject *solver = subject ? subject : &riemann_reference;
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        const struct row *row = &rows[i];
        struct riemann_solution s;
        double worst = 0;
        if (solver->solve(row->problem.gamma, &row->problem.left, &row->problem.right, &s))
            worst = (double)NAN;
        else {
            worst_keep(&worst, relative(s.p_star, row->star.p));
            worst_keep(&worst, fabs(s.v_star - row->star.v) / riemann_speed_scale(&row->problem));
            worst_keep(&worst, relative(s.rho_star_left, row->star.rho_left));
            worst_keep(&worst, relative(s.rho_star_right, row->star.rho_right));
        }
        /* floor: inputs such as 1.4 and 5.99924 are rounded, and an error of 1e-16 there is
         * amplified */
        check_measure(run, worst, 1e-13, 5e-15, "%s: p*, v*, rho* on both sides", row->name);
    }
}

static const struct check_mutant table_mutants[] = {
    RIEMANN_MUTANT(negative_pressure,
                   "Newton's relative change goes negative and ends it with p < 0"),
    RIEMANN_MUTANT(loose_root, "star pressure 1e-6 off"),
    RIEMANN_MUTANT(two_shocks, "every wave taken for a shock: expansion shocks"),
    RIEMANN_MUTANT(gamma_fixed, "gamma 1.4 whatever was asked for"),
    {0},
};

CHECK_DEFINE(riemann, star_states, 405,
             .property = "p*, v*, rho*_L, rho*_R of eight problems as from multiple precision",
             .measure = measure_table, .mutants = table_mutants);

/* ---- waves ---- */

/* The worst defects over random problems; problem[k] has the worst figure k. */
static void measure_waves(struct check_run *run, const void *subject)
{
    enum { FIGURES = 7 };
    static const char *const names[FIGURES] = {
        "mass across shocks",         "momentum across shocks",
        "energy across shocks",       "isentrope across rarefactions",
        "Riemann invariants",         "speeds of heads, tails and contact",
        "order of waves and entropy",
    };
    const struct riemann_subject *solver = subject ? subject : &riemann_reference;
    gsl_rng *random = gsl_rng_alloc(gsl_rng_mt19937);
    double worst[FIGURES] = {0};
    struct riemann_problem at[FIGURES] = {0};
    int shocks = 0, fans = 0;
    for (int i = 0; i < PROBLEMS; i++) {
        const struct riemann_problem p = riemann_random(random, i % 2 ? 10 : 3);
        struct riemann_solution s;
        if (solver->solve(p.gamma, &p.left, &p.right, &s)) s.p_star = s.v_star = (double)NAN;
        const struct riemann_defects d = riemann_defects_of(&s);
        shocks += (s.left_wave == RIEMANN_SHOCK) + (s.right_wave == RIEMANN_SHOCK);
        fans += (s.left_wave == RIEMANN_RAREFACTION) + (s.right_wave == RIEMANN_RAREFACTION);
        const double values[FIGURES] = {d.mass,      d.momentum, d.energy, d.isentrope,
                                        d.invariant, d.speeds,   d.order};
        for (int k = 0; k < FIGURES; k++) {
            const double before = worst[k];
            worst_keep(&worst[k], values[k]);
            if (worst[k] != before && !isnan(before)) at[k] = p;
        }
    }
    gsl_rng_free(random);
    const bool enough = shocks >= PROBLEMS / 4 && fans >= PROBLEMS / 4;
    for (int k = 0; k < FIGURES; k++)
        check_measure(run, enough ? worst[k] : (double)NAN, 1e-14, 1e-15,
                      "%s; worst of %d problems: gamma %.6g, rho v P %.6g %.6g %.6g | %.6g %.6g "
                      "%.6g",
                      names[k], PROBLEMS, at[k].gamma, at[k].left.rho, at[k].left.v, at[k].left.P,
                      at[k].right.rho, at[k].right.v, at[k].right.P);
}

static const struct check_mutant waves_mutants[] = {
    RIEMANN_MUTANT(loose_root, "star pressure 1e-6 off"),
    RIEMANN_MUTANT(swapped_velocity, "contact velocity with the two jumps of velocity exchanged"),
    RIEMANN_MUTANT(isentropic_shock, "density behind a shock from the isentrope"),
    RIEMANN_MUTANT(shock_speed, "(gamma-1) and (gamma+1) exchanged in the speed of a shock"),
    RIEMANN_MUTANT(isentrope_exponent, "density behind a rarefaction (p*/p)^((gamma-1)/gamma)"),
    RIEMANN_MUTANT(tail_speed, "tail of a rarefaction v* -+ c instead of v* -+ c*"),
    RIEMANN_MUTANT(two_shocks, "every wave taken for a shock: expansion shocks"),
    {0},
};

CHECK_DEFINE(
    riemann, jump_conditions, 450,
    .property = "Rankine-Hugoniot across shocks; P/rho^gamma and v +- 2c/(gamma-1) across fans",
    .measure = measure_waves, .mutants = waves_mutants);

/* ---- vacuum ---- */

static void measure_vacuum(struct check_run *run, const void *subject)
{
    const struct riemann_subject *solver = subject ? subject : &riemann_reference;
    gsl_rng *random = gsl_rng_alloc(gsl_rng_mt19937);
    double kind = 0, edge = 0;
    size_t vacua = 0;
    struct riemann_solution s;
    for (int i = 0; i < PROBLEMS; i++) {
        const struct riemann_problem p = riemann_random(random, 4);
        if (solver->solve(p.gamma, &p.left, &p.right, &s)) {
            kind = 1;
            continue;
        }
        worst_keep(&kind, riemann_vacuum_defect(&s));
        if (!s.vacuum) continue;
        vacua++;
        worst_keep(&edge, riemann_defects_of(&s).invariant);
    }
    gsl_rng_free(random);
    check_measure(run, kind, 0, 0, "vacuum exactly where v_R - v_L >= 2 (c_L + c_R)/(gamma-1)");
    check_measure(run, vacua ? edge : (double)NAN, 1e-14, 1e-15,
                  "edges of a vacuum move with v -+ 2c/(gamma-1)");

    const struct riemann_state gas = {1, 0, 1}, nothing = {0, 0, 0};
    const double c = sqrt(1.4);
    double side = 0;
    if (solver->solve(1.4, &gas, &nothing, &s))
        side = (double)NAN;
    else
        worst_keep(&side, relative(s.left_tail, 5 * c) + relative(s.left_head, -c));
    if (solver->solve(1.4, &nothing, &gas, &s))
        side = (double)NAN;
    else
        worst_keep(&side, relative(s.right_tail, -5 * c) + relative(s.right_head, c));
    check_measure(run, side, 1e-14, 1e-15, "vacuum on the right, on the left");
}

static const struct check_mutant vacuum_mutants[] = {
    RIEMANN_MUTANT(no_vacuum, "no vacuum: the formula of two rarefactions beyond its range"),
    RIEMANN_MUTANT(vacuum_limit,
                   "vacuum only where the gases part faster than 4 (c_L + c_R)/(gamma-1)"),
    RIEMANN_MUTANT(vacuum_edge, "the edge of a vacuum moves with v +- c"),
    {0},
};

CHECK_DEFINE(
    riemann, vacuum, 450,
    .property = "vacuum where the gases part faster than both can expand; its edges' speeds",
    .measure = measure_vacuum, .mutants = vacuum_mutants);

/* ---- symmetries ---- */

static void measure_symmetries(struct check_run *run, const void *subject)
{
    const struct riemann_subject *solver = subject ? subject : &riemann_reference;
    gsl_rng *random = gsl_rng_alloc(gsl_rng_mt19937);
    double mirror = 0, boost = 0;
    size_t boosted = 0;
    for (int i = 0; i < PROBLEMS / 2; i++) {
        struct riemann_problem p = riemann_random(random, 2);
        /* velocities on a grid, so that the boost is exact */
        const double dv = 512, grain = 0x1p-24;
        p.left.v = nearbyint(p.left.v / grain) * grain;
        p.right.v = nearbyint(p.right.v / grain) * grain;
        const struct riemann_problem m = riemann_mirrored(&p), b = riemann_boosted(&p, dv);
        const double speed = riemann_speed_scale(&p);
        struct riemann_solution s, in_mirror, moving;
        if (solver->solve(p.gamma, &p.left, &p.right, &s) ||
            solver->solve(m.gamma, &m.left, &m.right, &in_mirror) ||
            solver->solve(b.gamma, &b.left, &b.right, &moving)) {
            mirror = (double)NAN;
            break;
        }
        in_mirror = riemann_solution_mirrored(&in_mirror);
        worst_keep(&mirror, riemann_difference(&s, &in_mirror, speed));
        if (b.left.v - dv != p.left.v || b.right.v - dv != p.right.v) continue;
        boosted++;
        moving = riemann_solution_boosted(&moving, -dv);
        worst_keep(&boost, riemann_difference(&s, &moving, speed + dv));
    }
    gsl_rng_free(random);
    check_measure(run, mirror, 0, 0, "the mirror image's solution is the mirrored solution");
    check_measure(run, boosted ? boost : (double)NAN, 2e-15, 2e-16,
                  "seen from a moving frame (Galilei)");
}

static const struct check_mutant symmetries_mutants[] = {
    RIEMANN_MUTANT(left_at_rest, "the left gas's velocity is left out of the velocity jump"),
    RIEMANN_MUTANT(right_not_mirrored, "the right wave's speeds with the left one's signs"),
    {0},
};

CHECK_DEFINE(riemann, symmetries, 450, .property = "mirror image (bit for bit) and Galilean frame",
             .measure = measure_symmetries, .mutants = symmetries_mutants);
