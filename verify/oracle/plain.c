/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "plain.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "clock.h"
#include "integrator.h"

struct plain_particle {
    double x, m, v, u;                                /* state */
    double v_half, u_half;                            /* after the first kick */
    double h, h_inverse, rho, P, c;                   /* of the state */
    double dv, du, signal;                            /* rates, largest signal speed */
    ptrdiff_t first, last /* with r < h_i */, lo, hi; /* with r < max(h_i, h_j) */
};

enum { GHOSTS = 128, NEWTON_MAX = 100, ARRAYS = 8 };
static const double C_1 = 4. / 3; /* of the cubic spline */

/* w(q) and dw/dq of W = C_1/h w(r/h) */
static double shape(double q)
{
    const double p = 1 - q;
    return q <= 0.5 ? 1 - 6 * q * q * p : q < 1 ? 2 * p * p * p : 0;
}

static double slope(double q)
{
    const double p = 1 - q;
    return q <= 0.5 ? q * (18 * q - 12) : q < 1 ? -6 * p * p : 0;
}

static enum status broke_down(const struct plain *plain, ptrdiff_t i, const char *what,
                              double value, struct error *error)
{
    return error_set(error, STATUS_BROKE_DOWN,
                     "plain: broke down at t = %g: %s of particle %td is %g", plain->time, what, i,
                     value);
}

/* Wraps positions, sorts by insertion (particles hardly ever cross) and copies the images. */
static enum status arrange(struct plain *plain, struct error *error)
{
    struct plain_particle *a = plain->particles;
    const ptrdiff_t n = (ptrdiff_t)plain->n, ghosts = (ptrdiff_t)plain->ghosts;
    for (ptrdiff_t i = 0; i < n; i++) {
        if (!isfinite(a[i].x)) return broke_down(plain, i, "position", a[i].x, error);
        a[i].x -= plain->period * floor((a[i].x - plain->lo) / plain->period);
    }
    for (ptrdiff_t i = 1; i < n; i++) {
        if (a[i - 1].x <= a[i].x) continue;
        const struct plain_particle moved = a[i];
        ptrdiff_t k = i;
        for (; k > 0 && a[k - 1].x > moved.x; k--) a[k] = a[k - 1];
        a[k] = moved;
    }
    for (ptrdiff_t i = 0; i < ghosts; i++) {
        a[n + i] = a[i];
        a[n + i].x += plain->period;
        a[i - ghosts] = a[n + i - ghosts];
        a[i - ghosts].x -= plain->period;
    }
    return STATUS_OK;
}

/* Sums rho and drho/dh at width h and stores the range of neighbours. */
static void sum_density(struct plain *plain, ptrdiff_t i, double h, double *rho, double *drho)
{
    struct plain_particle *all = plain->particles, *a = &all[i];
    const ptrdiff_t begin = -(ptrdiff_t)plain->ghosts, end = (ptrdiff_t)(plain->n + plain->ghosts);
    const double h_inverse = 1 / h;
    double sum = a->m * shape(0), sum_slope = 0;
    for (a->first = i; a->first > begin; a->first--) {
        const struct plain_particle *b = &all[a->first - 1];
        const double q = (a->x - b->x) * h_inverse;
        if (q >= 1) break;
        sum += b->m * shape(q);
        sum_slope += b->m * q * slope(q);
    }
    for (a->last = i; a->last + 1 < end; a->last++) {
        const struct plain_particle *b = &all[a->last + 1];
        const double q = (b->x - a->x) * h_inverse;
        if (q >= 1) break;
        sum += b->m * shape(q);
        sum_slope += b->m * q * slope(q);
    }
    *rho = C_1 * h_inverse * sum;
    *drho = -C_1 * h_inverse * h_inverse * (sum + sum_slope);
}

/* Solves h = eta m/rho(h): h rho(h) rises with h, so a bracket secures Newton's method. */
static enum status find_density(struct plain *plain, ptrdiff_t i, struct error *error)
{
    struct plain_particle *a = &plain->particles[i];
    const double eta = plain->scheme->eta;
    double low = 0, high = plain->period, h = a->h;
    for (int iteration = 0; iteration < NEWTON_MAX; iteration++) {
        double drho;
        sum_density(plain, i, h, &a->rho, &drho);
        const double residual = h * a->rho - eta * a->m;
        if (fabs(residual) <= plain->scheme->h_tolerance * h * a->rho) {
            a->h = h;
            a->h_inverse = 1 / h;
            return STATUS_OK;
        }
        if (residual > 0)
            high = h;
        else
            low = h;
        const double next = h - residual / (a->rho + h * drho);
        h = next > low && next < high ? next : 0.5 * (low + high);
    }
    return broke_down(plain, i, "smoothing length (no root was found)", h, error);
}

/* Extends the neighbours of i to those within the larger of both smoothing lengths. */
static void find_pairs(struct plain *plain)
{
    struct plain_particle *a = plain->particles;
    const ptrdiff_t n = (ptrdiff_t)plain->n, ghosts = (ptrdiff_t)plain->ghosts;
    for (ptrdiff_t i = -ghosts; i < n + ghosts; i++) a[i].lo = a[i].first, a[i].hi = a[i].last;
    for (ptrdiff_t i = -ghosts; i < n + ghosts; i++)
        for (ptrdiff_t j = a[i].first; j <= a[i].last; j++) {
            if (i < a[j].lo) a[j].lo = i;
            if (i > a[j].hi) a[j].hi = i;
        }
}

/* Copies the state to the images; their neighbours are the images of the original's, as far as
 * these exist. */
static void copy_state(struct plain *plain)
{
    struct plain_particle *a = plain->particles;
    const ptrdiff_t n = (ptrdiff_t)plain->n, ghosts = (ptrdiff_t)plain->ghosts;
    for (ptrdiff_t k = 0; k < 2 * ghosts; k++) {
        const ptrdiff_t i = k < ghosts ? k - ghosts : n + k - ghosts, shift = i < 0 ? -n : n;
        const double x = a[i].x;
        a[i] = a[i - shift];
        a[i].x = x;
        a[i].first += shift;
        a[i].last += shift;
        if (a[i].first < -ghosts) a[i].first = -ghosts;
        if (a[i].last > n + ghosts - 1) a[i].last = n + ghosts - 1;
    }
}

static void add_pair(const struct scheme *scheme, struct plain_particle *a,
                     const struct plain_particle *b)
{
    const double r_ij = a->x - b->x, v_ij = a->v - b->v, r = fabs(r_ij), e = r_ij > 0 ? 1 : -1;
    const double G = 0.5 * e * C_1 *
                     (a->h_inverse * a->h_inverse * slope(r * a->h_inverse) +
                      b->h_inverse * b->h_inverse * slope(r * b->h_inverse));
    double PI = 0;
    if (v_ij * r_ij < 0 && scheme->viscosity == VISCOSITY_CONSTANT) {
        const double h = 0.25 * (a->h + b->h), c = 0.5 * (a->c + b->c),
                     rho = 0.5 * (a->rho + b->rho);
        const double mu = h * v_ij * r_ij / (r * r + 0.01 * h * h);
        PI = (-scheme->alpha * c * mu + scheme->beta * mu * mu) / rho;
    }
    a->dv -= b->m * ((a->P + b->P) / (a->rho * b->rho) + PI) * G;
    a->du += b->m * (a->P / (a->rho * b->rho) + 0.5 * PI) * v_ij * G;
    const double closing = e * v_ij < 0 ? e * v_ij : 0;
    const double signal = a->c + b->c - 3 * closing;
    if (r < (a->h > b->h ? a->h : b->h) && signal > a->signal) a->signal = signal;
}

static enum status evaluate(struct plain *plain, struct error *error)
{
    struct plain_particle *a = plain->particles;
    const ptrdiff_t n = (ptrdiff_t)plain->n;
    if (arrange(plain, error)) return STATUS_BROKE_DOWN;
    for (ptrdiff_t i = 0; i < n; i++) {
        if (!(a[i].u > 0)) return broke_down(plain, i, "internal energy", a[i].u, error);
        if (find_density(plain, i, error)) return STATUS_BROKE_DOWN;
        if (a[i].first <= -(ptrdiff_t)plain->ghosts ||
            a[i].last + 1 >= n + (ptrdiff_t)plain->ghosts)
            return broke_down(plain, i, "smoothing length (too wide)", a[i].h, error);
        a[i].P = (plain->gamma - 1) * a[i].rho * a[i].u;
        a[i].c = sqrt(plain->gamma * a[i].P / a[i].rho);
        plain->cost.pair_interactions += (uint64_t)(a[i].last - a[i].first);
    }
    copy_state(plain);
    find_pairs(plain);
    plain->time_step = INFINITY;
    for (ptrdiff_t i = 0; i < n; i++) {
        a[i].dv = a[i].du = 0;
        a[i].signal = 2 * a[i].c;
        for (ptrdiff_t j = a[i].lo; j <= a[i].hi; j++)
            if (j != i) add_pair(plain->scheme, &a[i], &a[j]);
        const double dt = plain->scheme->cfl * a[i].h / a[i].signal;
        if (dt < plain->time_step) plain->time_step = dt;
        plain->cost.pair_interactions += (uint64_t)(a[i].hi - a[i].lo) / 2;
    }
    plain->cost.particle_updates += plain->n;
    return STATUS_OK;
}

/* Kick-drift-kick with the other variables predicted to the end of the step, and rates of the final
 * state. */
static enum status step(struct plain *plain, double dt, struct error *error)
{
    struct plain_particle *a = plain->particles;
    for (size_t i = 0; i < plain->n; i++) {
        a[i].v_half = a[i].v + 0.5 * dt * a[i].dv;
        a[i].u_half = a[i].u + 0.5 * dt * a[i].du;
        a[i].x += a[i].v_half * dt;
        a[i].v += a[i].dv * dt;
        a[i].u += a[i].du * dt;
    }
    if (evaluate(plain, error)) return STATUS_BROKE_DOWN;
    for (size_t i = 0; i < plain->n; i++) {
        a[i].v = a[i].v_half + 0.5 * dt * a[i].dv;
        a[i].u = a[i].u_half + 0.5 * dt * a[i].du;
    }
    return evaluate(plain, error);
}

static enum status check(const struct setup *setup, struct error *error)
{
    const struct scheme *s = &setup->scheme;
    if (setup->dim == 1 && strcmp(s->kernel.member.name, "cubic_spline") == 0 &&
        s->gradient == GRADIENT_STANDARD && s->formulation == FORMULATION_VANILLA_ICE &&
        s->volume_element == VOLUME_MASS && s->viscosity <= VISCOSITY_CONSTANT &&
        s->energy == ENERGY_INTERNAL && s->pair_width == PAIR_WIDTH_MEAN &&
        s->h_method == H_NEWTON && strcmp(s->integrator->member.name, "modified_leapfrog") == 0)
        return STATUS_OK;
    return error_set(error, STATUS_BAD_INPUT,
                     "plain: only cubic_spline standard vanilla_ice mass, viscosity none or "
                     "constant, energy internal, modified_leapfrog");
}

static void sum_up(const struct plain *plain, struct conservation *sums)
{
    long double mass = 0, momentum = 0, scale = 0, sound = 0, energy = 0;
    for (size_t i = 0; i < plain->n; i++) {
        const struct plain_particle *a = &plain->particles[i];
        const long double p = (long double)a->m * a->v;
        mass += a->m;
        momentum += p;
        scale += fabsl(p);
        sound += (long double)a->m * a->c;
        energy += (long double)a->m * a->u + 0.5L * p * a->v;
    }
    *sums = (struct conservation){.mass = (double)mass,
                                  .momentum = {(double)momentum},
                                  .momentum_scale = (double)scale,
                                  .sound_scale = (double)sound,
                                  .energy = (double)energy};
}

static enum status set_up(struct plain *plain, const struct setup *setup, struct error *error)
{
    const size_t n = setup->n, ghosts = n < GHOSTS ? n : GHOSTS;
    *plain = (struct plain){.n = n,
                            .ghosts = ghosts,
                            .lo = setup->lo[0],
                            .period = setup->hi[0] - setup->lo[0],
                            .gamma = setup->gamma,
                            .scheme = &setup->scheme};
    if (check(setup, error)) return error->status;
    plain->all = calloc(n + 2 * ghosts, sizeof *plain->all);
    plain->arrays = calloc(ARRAYS * n, sizeof(double));
    if (!plain->all || !plain->arrays)
        return error_set(error, STATUS_ENVIRONMENT, "no memory for %zu particles", n);
    plain->particles = plain->all + ghosts;
    for (size_t i = 0; i < n; i++) {
        struct plain_particle *a = &plain->particles[i];
        a->x = setup->x[0][i];
        a->m = setup->m[i];
        a->v = setup->v[0][i];
        a->u = setup->u[i];
        a->h = setup->rho ? setup->scheme.eta * a->m / setup->rho[i]
                          : setup->scheme.eta * plain->period / (double)n;
    }
    return STATUS_OK;
}

enum status plain_run(struct plain *plain, const struct setup *setup, struct error *error)
{
    const struct clock_taken start = clock_now();
    enum status status = set_up(plain, setup, error);
    if (!status) status = evaluate(plain, error);
    if (status) return status;
    plain->cost.particle_updates = 0;
    sum_up(plain, &plain->start);
    while (!status && plain->time < setup->t_end) {
        const double left = setup->t_end - plain->time;
        double dt = plain->time_step;
        const bool last = dt >= left;
        if (last)
            dt = left;
        else if (2 * dt > left)
            dt = 0.5 * left;
        if (!(plain->time + dt > plain->time)) return broke_down(plain, 0, "time step", dt, error);
        status = step(plain, dt, error);
        plain->time = last ? setup->t_end : plain->time + dt;
        plain->cost.steps++;
    }
    struct clock_taken taken = {0};
    clock_add(&taken, &start);
    plain->cost.wall_s = taken.wall_s;
    plain->cost.cpu_s = taken.cpu_s;
    sum_up(plain, &plain->end);
    return status;
}

void plain_free(struct plain *plain)
{
    free(plain->all);
    free(plain->arrays);
    *plain = (struct plain){0};
}

void plain_snapshot(const struct plain *plain, struct snapshot *snapshot)
{
    const size_t n = plain->particles ? plain->n : 0;
    double *to[ARRAYS];
    for (size_t k = 0; k < ARRAYS; k++) to[k] = n ? plain->arrays + k * n : NULL;
    for (size_t i = 0; i < n; i++) {
        const struct plain_particle *a = &plain->particles[i];
        const double values[ARRAYS] = {a->x, a->v, a->m, a->rho, a->u, a->P, a->h, a->m / a->rho};
        for (size_t k = 0; k < ARRAYS; k++) to[k][i] = values[k];
    }
    *snapshot = (struct snapshot){.n = n,
                                  .x = {to[0]},
                                  .v = {to[1]},
                                  .m = to[2],
                                  .rho = to[3],
                                  .u = to[4],
                                  .P = to[5],
                                  .h = to[6],
                                  .volume = to[7],
                                  .time = plain->time};
}
