/* SPDX-License-Identifier: GPL-3.0-or-later
 * Checks the exact flows to or from a centre: Sedov's blast, Noh's collision, the spinning disc.
 * Shocks obey their jump conditions, the contents of balls change by the flux through their
 * surfaces, and other known results (Sedov's constants, Primakoff's blast) are reproduced. The
 * check flow tests the equations between shocks. */
#include <math.h>
#include <string.h>

#include <gsl/gsl_integration.h>

#include "check.h"
#include "disc.h"
#include "noh.h"
#include "sedov.h"
#include "worst.h"

/* Radial (v) and azimuthal (along) velocity. */
struct radial_state {
    double rho, v, along, P;
};

/* A flow with the numbers of one case: a, b are spin and pressure of a disc. */
struct radial {
    const char *name;
    double gamma;
    int d;
    double a, b;
    struct sedov sedov;
    double t[2]; /* first and last time */
    void (*at)(const struct radial *flow, double r, double t, struct radial_state *state);
    double (*shock)(const struct radial *flow, double t); /* or the edge of the gas */
};

struct blast_subject {
    const char *fault_of; /* the flow that it changes; NULL: all */
    void (*spoil)(const struct radial *flow, double r, double t, struct radial_state *state);
    double energy; /* replaces the energy of a blast */
};

static void sedov_at(const struct radial *flow, double r, double t, struct radial_state *state)
{
    const struct sedov_state s = sedov_sample(&flow->sedov, r, t);
    *state = (struct radial_state){s.rho, s.v, 0, s.P};
}

static void noh_at(const struct radial *flow, double r, double t, struct radial_state *state)
{
    const struct noh_state s = noh_sample(flow->gamma, flow->d, r, t);
    *state = (struct radial_state){s.rho, s.v, 0, s.P};
}

static void disc_at(const struct radial *flow, double r, double t, struct radial_state *state)
{
    const struct disc_state s = disc_sample(flow->a, flow->b, r, t);
    *state = (struct radial_state){s.rho, s.v_out, s.v_along, s.P};
}

static double sedov_front(const struct radial *flow, double t)
{
    return sedov_shock(&flow->sedov, t);
}

static double noh_front(const struct radial *flow, double t)
{
    return noh_shock(flow->gamma, t);
}

static double disc_edge(const struct radial *flow, double t)
{
    return disc_radius(flow->a, flow->b, t);
}

/* ---- integrals ---- */

enum { RULE = 64, CONSERVED = 3 }; /* mass, energy, angular momentum */

struct ball {
    const struct radial *flow;
    const struct blast_subject *subject;
    const gsl_integration_glfixed_table *rule;
};

static void look(const struct ball *ball, double r, double t, struct radial_state *state)
{
    ball->flow->at(ball->flow, r, t, state);
    if (ball->subject && ball->subject->spoil) ball->subject->spoil(ball->flow, r, t, state);
}

static double energy_of(const struct ball *ball, const struct radial_state *s)
{
    return 0.5 * s->rho * (s->v * s->v + s->along * s->along) + s->P / (ball->flow->gamma - 1);
}

/* Content of lo < r < hi at t over the unit sphere's surface. r - lo is the fourth power of the
 * integration variable, which turns fractional powers of r into whole ones. */
static void add_content(const struct ball *ball, double lo, double hi, double t,
                        double sum[CONSERVED])
{
    for (size_t i = 0; i < RULE; i++) {
        double y, w;
        struct radial_state s;
        gsl_integration_glfixed_point(0, 1, i, &y, &w, ball->rule);
        const double r = lo + (hi - lo) * y * y * y * y;
        w *= 4 * y * y * y * (hi - lo) * pow(r, ball->flow->d - 1);
        look(ball, r, t, &s);
        sum[0] += w * s.rho;
        sum[1] += w * energy_of(ball, &s);
        sum[2] += w * s.rho * r * s.along;
    }
}

static void find_content(const struct ball *ball, double r, double t, double sum[CONSERVED])
{
    const double front = ball->flow->shock(ball->flow, t);
    memset(sum, 0, CONSERVED * sizeof *sum);
    add_content(ball, 0, fmin(front, r), t, sum);
    if (front < r) add_content(ball, front, r, t, sum);
}

/* Outflow through the sphere of radius r, which no shock crosses in that time. */
static void find_outflow(const struct ball *ball, double r, double sum[CONSERVED])
{
    const double area = pow(r, ball->flow->d - 1), *t = ball->flow->t;
    memset(sum, 0, CONSERVED * sizeof *sum);
    for (size_t i = 0; i < RULE; i++) {
        double at, w;
        struct radial_state s;
        gsl_integration_glfixed_point(t[0], t[1], i, &at, &w, ball->rule);
        look(ball, r, at, &s);
        sum[0] += w * area * s.rho * s.v;
        sum[1] += w * area * s.v * (energy_of(ball, &s) + s.P);
        sum[2] += w * area * s.rho * r * s.along * s.v;
    }
}

/* |change + outflow| over the sum of the sizes, the worst of the three. */
static double balance_of(const struct ball *ball, double r)
{
    double before[CONSERVED], after[CONSERVED], out[CONSERVED], worst = 0;
    find_content(ball, r, ball->flow->t[0], before);
    find_content(ball, r, ball->flow->t[1], after);
    find_outflow(ball, r, out);
    for (int k = 0; k < CONSERVED; k++) {
        const double size = fabs(before[k]) + fabs(after[k]) + fabs(out[k]);
        if (size != 0) worst_keep(&worst, fabs(after[k] - before[k] + out[k]) / size);
    }
    return worst;
}

/* Fluxes of mass, momentum and energy through the front, in the frame of the front. */
static double jump_of(const struct ball *ball, double t)
{
    const double R = ball->flow->shock(ball->flow, t), dt = 1e-4 * t;
    const double D =
        (ball->flow->shock(ball->flow, t + dt) - ball->flow->shock(ball->flow, t - dt)) / (2 * dt);
    double flux[2][CONSERVED], size[CONSERVED] = {0}, worst = 0;
    for (int side = 0; side < 2; side++) {
        struct radial_state s;
        look(ball, R * (side ? 1 + 1e-12 : 1 - 1e-12), t, &s);
        const double through = s.rho * (s.v - D);
        flux[side][0] = through;
        flux[side][1] = through * s.v + s.P;
        flux[side][2] = energy_of(ball, &s) * (s.v - D) + s.P * s.v;
        size[0] += fabs(through);
        size[1] += fabs(through * s.v) + s.P;
        size[2] += fabs(energy_of(ball, &s) * (s.v - D)) + fabs(s.P * s.v);
    }
    for (int k = 0; k < CONSERVED; k++)
        if (size[k] != 0) worst_keep(&worst, fabs(flux[0][k] - flux[1][k]) / size[k]);
    return worst;
}

/* ---- the cases ---- */

static void measure_radial(struct check_run *run, const struct radial *flow,
                           const struct blast_subject *subject)
{
    gsl_integration_glfixed_table *rule = gsl_integration_glfixed_table_alloc(RULE);
    const struct ball ball = {flow, subject, rule};
    if (!rule) {
        check_skip(run, "no memory");
        return;
    }
    double jump = 0;
    const double start = flow->shock(flow, flow->t[0]), end = flow->shock(flow, flow->t[1]);
    for (int k = 0; k <= 4; k++)
        worst_keep(&jump, jump_of(&ball, flow->t[0] + 0.25 * k * (flow->t[1] - flow->t[0])));
    check_measure(run, fmax(balance_of(&ball, 0.5 * start), balance_of(&ball, 1.5 * end)), 1e-10,
                  1e-13, "%s, gamma %.4g, d %d: balls inside and outside of the front", flow->name,
                  flow->gamma, flow->d);
    /* a disc has no shock but a free edge */
    if (flow->at != disc_at)
        check_measure(run, jump, 1e-7, 1e-9, "%s, gamma %.4g, d %d: jump at the shock", flow->name,
                      flow->gamma, flow->d);
    gsl_integration_glfixed_table_free(rule);
}

static bool concerns(const struct blast_subject *subject, const char *name)
{
    return !subject || strcmp(subject->fault_of, name) == 0;
}

/* E/rho = xi0^-(d+2) with R = 1 at t = 1, against the tables of Sedov and of Kamm & Timmes. */
static void measure_constants(struct check_run *run, const struct blast_subject *subject)
{
    static const struct {
        double gamma;
        int d;
        double xi0;
    } known[] = {{1.4, 1, 0.975430154},    {1.4, 2, 1.004021606},    {1.4, 3, 1.032777468},
                 {5. / 3, 1, 1.183703989}, {5. / 3, 2, 1.153787088}, {5. / 3, 3, 1.151666418}};
    for (size_t k = 0; k < sizeof known / sizeof *known; k++) {
        struct sedov sedov;
        const double energy = subject && subject->energy > 0 ? subject->energy : 1;
        const char *fault = sedov_solve(known[k].gamma, known[k].d, 1, energy, &sedov);
        check_measure(run, fault ? (double)NAN : fabs(sedov_shock(&sedov, 1) / known[k].xi0 - 1),
                      1e-9, 1e-12, "sedov, gamma %.4g, d %d: xi0", known[k].gamma, known[k].d);
    }
}

/* gamma = 7 in 3D (Primakoff): v is proportional to r, P to r^3 and rho to r. For gamma close to 7
 * the profile differs by the difference in gamma. */
static void measure_primakoff(struct check_run *run, const struct blast_subject *subject)
{
    struct radial flow = {.name = "sedov", .gamma = 7 - 1e-7, .d = 3};
    const struct ball ball = {&flow, subject, NULL};
    struct radial_state front, s;
    double worst = sedov_solve(flow.gamma, 3, 1, 1, &flow.sedov) ? (double)NAN : 0;
    flow.at = sedov_at;
    const double R = sedov_shock(&flow.sedov, 1);
    look(&ball, R * (1 - 1e-12), 1, &front);
    for (int k = 1; k < 10; k++) {
        const double x = 0.1 * k;
        look(&ball, R * x, 1, &s);
        worst_keep(&worst, fabs(s.v / front.v / x - 1));
        worst_keep(&worst, fabs(s.rho / front.rho / x - 1));
        worst_keep(&worst, fabs(s.P / front.P / (x * x * x) - 1));
    }
    check_measure(run, worst, 1e-5, 1e-7, "sedov, gamma 7, d 3: Primakoff's blast");
}

static double mass_at(double r, const struct sedov_state *s)
{
    (void)r;
    return s->rho;
}

static double kinetic_at(double r, const struct sedov_state *s)
{
    (void)r;
    return 0.5 * s->rho * s->v * s->v;
}

static double pressure_at(double r, const struct sedov_state *s)
{
    (void)r;
    return s->P;
}

/* Integrals over balls inside and outside the front: the total energy; and the mass, which by
 * self-similarity is (1 - v R/(r D)) times the edge density times the volume. */
static void measure_integrals(struct check_run *run, const struct radial *flow)
{
    const struct sedov *sedov = &flow->sedov;
    const double t = 0.4, R = sedov_shock(sedov, t), D = 2 * R / ((flow->d + 2) * t);
    const double unit = flow->d == 1 ? 2 : flow->d == 2 ? M_PI : 4 * M_PI / 3;
    const double energy = sedov_integral(sedov, 1.5 * R, t, kinetic_at) +
                          sedov_integral(sedov, 1.5 * R, t, pressure_at) / (flow->gamma - 1);
    double worst = fabs(energy / sedov->E - 1);
    for (int k = 1; k <= 3; k++) {
        const double r = 0.6 * k * R;
        const struct sedov_state edge = sedov_sample(sedov, r, t);
        const double mass = unit * pow(r, flow->d) * edge.rho * (1 - edge.v * R / (r * D));
        worst_keep(&worst, fabs(sedov_integral(sedov, r, t, mass_at) / mass - 1));
    }
    check_measure(run, worst, 1e-9, 1e-13, "sedov, gamma %.4g, d %d: energy and mass of balls",
                  flow->gamma, flow->d);
}

static void measure_blast(struct check_run *run, const void *of)
{
    static const double gammas[] = {1.4, 5. / 3, 3};
    static const double discs[][2] = {{1, 0.25}, {0, 0.5}, {2.3, 0.1}};
    const struct blast_subject *subject = of;
    for (int d = 1; d <= 3; d++)
        for (size_t k = 0; k < sizeof gammas / sizeof *gammas; k++) {
            struct radial sedov = {.name = "sedov",
                                   .gamma = gammas[k],
                                   .d = d,
                                   .t = {0.3, 0.5},
                                   .at = sedov_at,
                                   .shock = sedov_front};
            const struct radial noh = {.name = "noh",
                                       .gamma = gammas[k],
                                       .d = d,
                                       .t = {0.3, 0.5},
                                       .at = noh_at,
                                       .shock = noh_front};
            if (sedov_solve(gammas[k], d, 1.3, 0.7, &sedov.sedov)) sedov.sedov.xi0 = NAN;
            if (concerns(subject, "sedov")) {
                measure_radial(run, &sedov, subject);
                measure_integrals(run, &sedov);
            }
            if (concerns(subject, "noh")) measure_radial(run, &noh, subject);
        }
    for (size_t k = 0; concerns(subject, "disc") && k < sizeof discs / sizeof *discs; k++) {
        const struct radial disc = {.name = "disc",
                                    .gamma = 2,
                                    .d = 2,
                                    .a = discs[k][0],
                                    .b = discs[k][1],
                                    .t = {0.2, 1.3},
                                    .at = disc_at,
                                    .shock = disc_edge};
        measure_radial(run, &disc, subject);
    }
    if (!concerns(subject, "sedov")) return;
    measure_constants(run, subject);
    measure_primakoff(run, subject);
}

/* ---- mutants ---- */

static void sedov_fast(const struct radial *flow, double r, double t, struct radial_state *s)
{
    (void)r, (void)t;
    s->v *= (flow->gamma + 1) / 2;
}

static void sedov_hollow(const struct radial *flow, double r, double t, struct radial_state *s)
{
    const double R = flow->shock ? flow->shock(flow, t) : sedov_shock(&flow->sedov, t);
    if (r < R) s->rho *= pow(r / R, 1e-3);
}

static void sedov_flat(const struct radial *flow, double r, double t, struct radial_state *s)
{
    struct radial_state half;
    const double R = sedov_shock(&flow->sedov, t);
    flow->at(flow, 0.5 * R, t, &half);
    if (r < 0.5 * R) s->P = 1.01 * half.P;
}

static void noh_four(const struct radial *flow, double r, double t, struct radial_state *s)
{
    if (r < noh_shock(flow->gamma, t)) s->rho = pow(4, flow->d);
}

static void noh_unsqueezed(const struct radial *flow, double r, double t, struct radial_state *s)
{
    if (r >= noh_shock(flow->gamma, t)) s->rho = 1;
}

static void noh_thick(const struct radial *flow, double r, double t, struct radial_state *s)
{
    if (r >= noh_shock(flow->gamma, t)) s->rho = pow(1 + t / r, flow->d);
}

static void noh_soft(const struct radial *flow, double r, double t, struct radial_state *s)
{
    if (r < noh_shock(flow->gamma, t)) s->P *= 2 / 3. * flow->gamma;
}

static void disc_rigid(const struct radial *flow, double r, double t, struct radial_state *s)
{
    (void)t;
    s->along = flow->a * r;
}

static void disc_slow(const struct radial *flow, double r, double t, struct radial_state *s)
{
    (void)flow, (void)r, (void)t;
    s->v *= 0.999;
}

static void disc_isothermal(const struct radial *flow, double r, double t, struct radial_state *s)
{
    const double a = flow->shock(flow, t);
    (void)r;
    s->P *= a * a;
}

#define SPOILED(of, function)                                                                      \
    &(struct blast_subject)                                                                        \
    {                                                                                              \
        .fault_of = of, .spoil = function                                                          \
    }
static const struct check_mutant blast_mutants[] = {
    {"sedov_energy", "the blast of an energy 1e-6 larger",
     &(struct blast_subject){.fault_of = "sedov", .energy = 1 + 1e-6}},
    {"sedov_fast", "gas behind the blast as fast as its front", SPOILED("sedov", sedov_fast)},
    {"sedov_hollow", "density inside of a blast times (r/R)^0.001", SPOILED("sedov", sedov_hollow)},
    {"sedov_flat", "pressure in the middle of a blast 1 % off", SPOILED("sedov", sedov_flat)},
    {"noh_four", "density 4^d for any gamma", SPOILED("noh", noh_four)},
    {"noh_unsqueezed", "no squeeze on the way to the middle", SPOILED("noh", noh_unsqueezed)},
    {"noh_thick", "(1 + t/r)^d for (1 + t/r)^(d - 1)", SPOILED("noh", noh_thick)},
    {"noh_soft", "pressure behind the shock of gamma 1.5", SPOILED("noh", noh_soft)},
    {"disc_rigid", "a disc that grows and turns as fast as before", SPOILED("disc", disc_rigid)},
    {"disc_slow", "a disc that grows too slowly by 0.1 %", SPOILED("disc", disc_slow)},
    {"disc_isothermal", "a disc that stays warm", SPOILED("disc", disc_isothermal)},
    {0},
};

CHECK_DEFINE(
    exact, blast, 550,
    .property = "Sedov, Noh, spinning disc: jump conditions, balance of balls, constants, limits",
    .measure = measure_blast, .mutants = blast_mutants);
