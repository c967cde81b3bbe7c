/* SPDX-License-Identifier: GPL-3.0-or-later
 * Compares the error budgets that a run reports, also of the mirrored problem, and errors at the
 * centre of a blast with sums over its particles. */
#include "test.h"

#include "keyed.h"

static struct run_result ran(const char *name, const char *keys)
{
    const struct run run = keyed_run(name, keys);
    return keyed_result(&run);
}

/* ---- sums over the particles of the window ---- */

static bool in_window(const struct prepared *p, const struct snapshot *s, size_t i)
{
    double x[3] = {0}, square = 0;
    bool inside = true;
    problem_position(p, s, i, x);
    for (int d = 0; d < p->domain.dim; d++) {
        inside = inside && x[d] >= p->window.lo[d] && x[d] <= p->window.hi[d];
        square += (x[d] - p->window.centre[d]) * (x[d] - p->window.centre[d]);
    }
    return inside && (!(p->window.radius > 0) || sqrt(square) <= p->window.radius);
}

TEST(budget_means)
{
    static const struct {
        const char *name, *keys;
        double volume; /* of the box */
        int dim;
    } cases[] = {{"sod", "n=100 t_end=0.05 eta=2", 2, 1},
                 {"lax", "n=77 t_end=0.02 grade=0.5", 2, 1},
                 {"gresho", "n=16^2 t_end=0.05 window_radius=0.3", 1, 2},
                 {"sound_wave_3d", "n=8^3 t_end=0.01 eta=3", 1, 3}};
    for (size_t c = 0; c < sizeof cases / sizeof *cases; c++) {
        struct run_result run = ran(cases[c].name, cases[c].keys);
        const struct prepared *p = &run.problem;
        const struct snapshot *s = &run.snapshot;
        double h = 0, error = 0, volume = 0, box = 1;
        size_t inside = 0;
        for (int d = 0; d < p->domain.dim; d++) box *= domain_length(&p->domain, d);
        for (size_t i = 0; i < s->n; i++) {
            struct problem_state exact;
            double x[3] = {0};
            if (!in_window(p, s, i)) continue;
            inside++;
            for (int d = 0; d < p->domain.dim; d++) x[d] = s->x[d][i];
            problem_sample(p, x, run.time, &exact);
            h += s->volume[i] * s->h[i];
            error += s->volume[i] * fabs(s->rho[i] - exact.rho);
            volume += s->volume[i];
        }
        assert_int_equal(p->domain.dim, cases[c].dim);
        near_relative(run.spacing, pow(box / (double)s->n, 1. / p->domain.dim), 1e-14);
        near_relative(run.h, h / volume, 1e-13);
        near_relative(run.errors[FIELD_DENSITY].l1_whole, error / volume, 1e-12);
        assert_int_equal(run.errors[FIELD_DENSITY].n, inside);
        assert_true(inside > 0 && inside < s->n + (cases[c].dim == 3));
        run_free(&run);
    }
}

/* A mirrored tube has the same error in each region and the same motion in undisturbed gas. */
TEST(mirrored_budgets)
{
    static const char *const tubes[][2] = {
        {"left=1,0,1 right=0.125,0,0.1", "right=1,0,1 left=0.125,0,0.1"},
        {"left=1,0.5,1 right=0.5,-0.2,0.1", "right=1,-0.5,1 left=0.5,0.2,0.1"},
        {"left=1,-1.5,0.4 right=1,1.5,0.4", "left=1,-1.5,0.4 right=1,1.5,0.4"},
        {"left=1,1,0.4 right=1.3,-1,0.4", "left=1.3,1,0.4 right=1,-1,0.4"},
    };
    for (size_t t = 0; t < sizeof tubes / sizeof *tubes; t++) {
        struct run_result run[2];
        for (int k = 0; k < 2; k++) {
            char keys[128];
            snprintf(keys, sizeof keys, "%s t_end=0.08 n=300", tubes[t][k]);
            run[k] = ran("sod", keys);
        }
        const struct regions *regions = run[0].budget.regions;
        assert_int_equal(run[0].n, run[1].n);
        for (size_t r = 0; regions->names[r]; r++)
            for (int f = 0; f < FIELDS; f++)
                near_below(fabs(run[0].budget.l1[r][f] - run[1].budget.l1[r][f]),
                           1e-7 * run[0].errors[f].l1);
        assert_int_equal(isnan(run[0].budget.still), isnan(run[1].budget.still));
        if (!isnan(run[0].budget.still))
            near_below(fabs(run[0].budget.still - run[1].budget.still), 1e-9);
        run_free(&run[0]);
        run_free(&run[1]);
    }
}

/* A particle at the centre of a blast is compared with the mean of the exact gas over a ball of its
 * volume, because u is infinite at the centre; others are compared with the gas at their
 * positions. */
TEST(particles_at_the_centre_of_a_blast)
{
    static const struct {
        const char *name, *keys;
        bool odd;
    } cases[] = {{"sedov_3d", "n=9^3 t_end=0.02", true},
                 {"sedov_3d", "n=10^3 t_end=0.02", false},
                 {"sedov_2d", "n=15^2 t_end=0.01", true}};
    for (size_t c = 0; c < sizeof cases / sizeof *cases; c++) {
        struct run_result run = ran(cases[c].name, cases[c].keys);
        const struct prepared *p = &run.problem;
        const struct snapshot *s = &run.snapshot;
        const double unit = p->domain.dim == 2 ? M_PI : 4 * M_PI / 3;
        double error = 0, volume = 0;
        size_t central = 0;
        for (size_t i = 0; i < s->n; i++) {
            struct problem_state exact;
            double x[3] = {0};
            if (!in_window(p, s, i)) continue;
            for (int d = 0; d < p->domain.dim; d++) x[d] = s->x[d][i];
            problem_sample(p, x, run.time, &exact);
            if (problem_radius(p, x) < 1e-9) {
                const double reach = pow(s->volume[i] / unit, 1. / p->domain.dim);
                assert_true(exact.u > 1e9);
                /* mass in a ball that grows with the shock, see check exact/blast; P rises
                 * outwards */
                struct problem_state edge;
                problem_sample(p, (double[3]){reach}, run.time, &edge);
                const double growth = 2 / ((p->domain.dim + 2) * run.time);
                const double most = edge.u / (1 - edge.v[0] / (reach * growth));
                const double mean = p->problem->mean_energy(p, reach, run.time);
                assert_true(mean < most && mean > 0.7 * most);
                exact.u = mean;
                central++;
            }
            error += s->volume[i] * fabs(s->u[i] - exact.u);
            volume += s->volume[i];
        }
        assert_int_equal(central, cases[c].odd);
        near_relative(run.errors[FIELD_INTERNAL_ENERGY].l1_whole, error / volume, 1e-12);
        run_free(&run);
    }
}
