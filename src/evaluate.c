/* SPDX-License-Identifier: GPL-3.0-or-later
 * The passes of an evaluation, over the ranges of the plan. Ranges are independent of each other:
 * a particle's sums are gathered by its own range in a fixed order, so results do not depend on
 * the number of threads. */
#include <math.h>
#include <stdlib.h>

#include "loop.h"
#include "solver.h"

#ifdef _OPENMP
#include <omp.h>
#endif

enum { NEWTON_MAX = 200, RANGES_WORTH_A_THREAD = 24 };

static int thread_number(void)
{
#ifdef _OPENMP
    return omp_get_thread_num();
#else
    return 0;
#endif
}

static ptrdiff_t largest_index(ptrdiff_t a, ptrdiff_t b)
{
    return a > b ? a : b;
}

static int threads_for(const struct simulation *simulation)
{
    return simulation->range_count >= RANGES_WORTH_A_THREAD ? simulation->threads : 1;
}

enum status broke_down(const struct simulation *simulation, ptrdiff_t i, const char *quantity,
                       double value, struct error *error)
{
    const struct particles *a = &simulation->particles;
    return error_set(error, STATUS_BROKE_DOWN,
                     "broke down at t = %.9g: %s of particle %zu at x = %.9g is %.9g",
                     simulation->time, quantity, a->id[i], a->x[i], value);
}

/* --- order and the primitive state ------------------------------------------------------------ */

static enum status restore_order(struct simulation *simulation, struct error *error)
{
    struct particles *a = &simulation->particles;
    const ptrdiff_t crossed = particles_sort(a);
    if (crossed < 0)
        for (ptrdiff_t i = 0; i < a->n; i++)
            if (!isfinite(a->x[i])) return broke_down(simulation, i, "position", a->x[i], error);
    if (crossed > 0) simulation->ghosts_filled = 0; /* of the masses */
    return STATUS_OK;
}

/* v and U from p and e. */
static enum status find_primitives(struct simulation *simulation, struct error *error)
{
    struct particles *a = &simulation->particles;
    const double kinetic = simulation->scheme.energy == ENERGY_TOTAL ? 0.5 : 0;
    const double *restrict p = a->p, *restrict e = a->e, *restrict m_inverse = a->m_inverse;
    double *restrict v = a->v, *restrict U = a->U;
    double unsound = 0;
#pragma omp simd reduction(+ : unsound)
    for (ptrdiff_t i = 0; i < a->n; i++) {
        v[i] = p[i] * m_inverse[i];
        U[i] = e[i] - kinetic * p[i] * v[i];
        unsound += U[i] > 0 ? 0. : 1.;
    }
    for (ptrdiff_t i = 0; unsound > 0 && i < a->n; i++)
        if (!(U[i] > 0)) return broke_down(simulation, i, "internal energy", U[i], error);
    return STATUS_OK;
}

/* --- density and smoothing length ------------------------------------------------------------- */

/* Raises the range's reach until it covers the widths h; false where that takes more ghosts than
 * are filled. */
static bool cover(const struct simulation *simulation, struct range *range, const double *h)
{
    const double *x = simulation->particles.x + range->first;
    ptrdiff_t D = range->reach > 1 ? range->reach : 1;
    for (;; D++) {
        if (D + 1 > simulation->ghosts_filled) break;
        int inside = 0;
        for (int i = 0; i < range->len; i++)
            inside |= (x[i + D + 1] - x[i] < h[i]) | (x[i] - x[i - D - 1] < h[i]);
        if (!inside) break;
    }
    range->reach = D;
    return D + 1 <= simulation->ghosts_filled;
}

/* Lowers a reach that has become larger than needed. */
static void tighten(const struct simulation *simulation, struct range *range)
{
    const double *x = simulation->particles.x + range->first;
    const double *h = simulation->particles.h + range->first;
    while (range->reach > 1) {
        const ptrdiff_t D = range->reach;
        int inside = 0;
        for (int i = 0; i < range->len; i++)
            inside |= (x[i + D] - x[i] < h[i]) | (x[i] - x[i - D] < h[i]);
        if (inside) break;
        range->reach--;
    }
}

/* Equation of state and what the pair loops need of it, from the sums of a range. */
static void close_state(struct simulation *simulation, const struct range *range,
                        const struct density_sums *sums)
{
    const struct particles *a = &simulation->particles;
    const double constant = simulation->scheme.kernel.constant[1], gamma = simulation->gamma;
    const bool energy_sum = simulation->plan.energy_sum, grad_h = simulation->plan.grad_h,
               standard = simulation->scheme.gradient == GRADIENT_STANDARD;
    const ptrdiff_t first = range->first;
    const double *restrict m = a->m + first, *restrict U = a->U + first,
                           *restrict h_inverse = a->h_inverse + first,
                           *restrict m_inverse = a->m_inverse + first;
    double *restrict rho_sum = a->rho_sum + first, *restrict y = a->y + first,
                     *restrict V = a->V + first, *restrict rho = a->rho + first,
                     *restrict P = a->P + first, *restrict c = a->c + first,
                     *restrict g = a->g + first;
#pragma omp simd
    for (int i = 0; i < range->len; i++) {
        const double scale = constant * h_inverse[i];
        rho_sum[i] = scale * sums->m[i];
        y[i] = energy_sum ? scale * sums->Z[i] : rho_sum[i];
        V[i] = (energy_sum ? U[i] : m[i]) / y[i];
        rho[i] = energy_sum ? m[i] / V[i] : y[i];
        P[i] = (gamma - 1) * (energy_sum ? y[i] : y[i] * U[i] * m_inverse[i]);
        c[i] = sqrt(gamma * (gamma - 1) * U[i] * m_inverse[i]);
        if (standard) g[i] = scale * h_inverse[i];
    }
    if (!grad_h) return;
    double *restrict factor = a->grad_h + first, *restrict b = a->b + first;
    for (int i = 0; i < range->len; i++) {
        /* h/rho drho/dh = -m_dh/m, so f = 1/(1 - m_dh/m); with the energy element
         * f_ij = 1 - (m_j/Z_j) factor_i (Hopkins 2013), with the mass element f_i = 1 - factor_i */
        const double dh = energy_sum ? sums->Z_dh[i] : sums->m_dh[i];
        factor[i] = -dh / (sums->m[i] - sums->m_dh[i]);
        b[i] = V[i] * P[i] / y[i];
    }
}

/* h = eta m/rho(h) of a range: Newton inside a bracket; a particle that has converged keeps its h
 * while the others go on. Returns the first particle without a root, -1 if all is well, -2 for
 * lack of ghosts. */
static ptrdiff_t solve_range(struct simulation *simulation, struct range *range,
                             struct density_sums *sums)
{
    const struct particles *a = &simulation->particles;
    const struct scheme *scheme = &simulation->scheme;
    const double tolerance = scheme->h_tolerance, constant = scheme->kernel.constant[1];
    double *h = a->h + range->first, *h_inverse = a->h_inverse + range->first;
    const double *m = a->m + range->first;
    double low[RANGE_MAX], high[RANGE_MAX];
    for (int i = 0; i < range->len; i++) {
        low[i] = 0;
        high[i] = INFINITY;
        h_inverse[i] = 1 / h[i];
    }
    for (int iteration = 0; iteration < NEWTON_MAX; iteration++) {
        if (!cover(simulation, range, h)) return -2;
        simulation->loops.density_newton(&scheme->kernel, a, range->first, range->len, range->reach,
                                         h_inverse, sums);
        ptrdiff_t open = -1;
        for (int i = 0; i < range->len; i++) {
            const double target = scheme->eta * m[i] / (constant * h_inverse[i] * sums->m[i]);
            const double residual = h[i] - target;
            if (fabs(residual) <= tolerance * h[i]) continue;
            open = range->first + i;
            if (residual < 0)
                low[i] = h[i];
            else
                high[i] = h[i];
            const double slope = 1 - target / h[i] * (sums->m_dh[i] / sums->m[i]);
            double next = h[i] - residual / slope;
            if (!(slope > 0 && next > low[i] && next < high[i]))
                next = isinf(high[i]) ? 2 * h[i] : 0.5 * (low[i] + high[i]);
            /* a bracket of two neighbouring numbers is a root, too */
            if (next == low[i] || next == high[i]) low[i] = high[i] = next;
            h[i] = least(next, 2 * h[i]);
            h_inverse[i] = 1 / h[i];
        }
        if (open < 0) return -1;
    }
    for (int i = 0; i < range->len; i++) {
        const double target = scheme->eta * m[i] / (constant * h_inverse[i] * sums->m[i]);
        if (!(fabs(h[i] - target) <= 1e-6 * h[i])) return range->first + i;
    }
    return -1;
}

/* One density sum at a predicted h: 1/h = rho/(eta m), extrapolated in time from the last two. */
static ptrdiff_t sum_range(struct simulation *simulation, struct range *range,
                           struct density_sums *sums)
{
    const struct particles *a = &simulation->particles;
    const struct scheme *scheme = &simulation->scheme;
    double *restrict h = a->h + range->first, *restrict h_inverse = a->h_inverse + range->first,
                     *restrict h_inverse_old = a->h_inverse_old + range->first;
    const double ratio = simulation->predict_ratio;
    double found[RANGE_MAX];
    for (int i = 0; i < range->len; i++) {
        const double now =
            a->rho_sum[range->first + i] * a->m_inverse[range->first + i] / scheme->eta;
        const double next = now + ratio * (now - h_inverse_old[i]);
        found[i] = now;
        h_inverse[i] = largest(0.5 * now, least(2 * now, next));
        h[i] = 1 / h_inverse[i];
    }
    if (!cover(simulation, range, h)) return -2;
    simulation->loops.density(&scheme->kernel, a, range->first, range->len, range->reach, h_inverse,
                              sums);
    for (int i = 0; i < range->len; i++) h_inverse_old[i] = found[i];
    return -1;
}

/* Ghosts of what the density sums read, at least count of them. */
static enum status fill_density_ghosts(struct simulation *simulation, ptrdiff_t count,
                                       struct error *error)
{
    struct particles *a = &simulation->particles;
    if (count > a->ghosts) {
        const enum status status = particles_grow_ghosts(a, count + count / 2, error);
        if (status) return status;
    }
    if (count > simulation->ghosts_filled) particles_fill_ghosts(a, a->m, count, 0);
    simulation->ghosts_filled = count;
    particles_fill_ghosts(a, a->x, count, a->period);
    if (simulation->plan.energy_sum) particles_fill_ghosts(a, a->U, count, 0);
    return STATUS_OK;
}

static enum status find_density(struct simulation *simulation, bool newton, struct error *error)
{
    ptrdiff_t ghosts = 8;
    for (ptrdiff_t b = 0; b < simulation->range_count; b++)
        if (simulation->ranges[b].reach + 2 > ghosts) ghosts = simulation->ranges[b].reach + 2;
    if (ghosts < simulation->ghosts_filled) ghosts = simulation->ghosts_filled;
    for (;;) {
        const enum status status = fill_density_ghosts(simulation, ghosts, error);
        if (status) return status;
        ptrdiff_t short_of_ghosts = 0, failed = -1;
#pragma omp parallel for schedule(static) num_threads(threads_for(simulation))                     \
    reduction(max                                                                                  \
              : short_of_ghosts, failed)
        for (ptrdiff_t b = 0; b < simulation->range_count; b++) {
            struct range *range = &simulation->ranges[b];
            struct density_sums sums;
            if (range->pending) {
                const ptrdiff_t result = newton ? solve_range(simulation, range, &sums)
                                                : sum_range(simulation, range, &sums);
                if (result == -2) {
                    short_of_ghosts = largest_index(short_of_ghosts, range->reach + 2);
                } else if (result >= 0) {
                    failed = largest_index(failed, result);
                } else {
                    close_state(simulation, range, &sums);
                    range->pending = false;
                }
            }
        }
        if (failed >= 0)
            return broke_down(simulation, failed, "smoothing length (no root was found)",
                              simulation->particles.h[failed], error);
        if (!short_of_ghosts) return STATUS_OK;
        ghosts = short_of_ghosts + short_of_ghosts / 2;
    }
}

static enum status reserve_scratch(struct simulation *simulation, ptrdiff_t reach,
                                   struct error *error)
{
    const size_t size = force_scratch(reach);
    if (size <= simulation->scratch_size) return STATUS_OK;
    free(simulation->scratch);
    simulation->scratch_size = 2 * size;
    simulation->scratch =
        malloc(simulation->scratch_size * (size_t)simulation->threads * sizeof(double));
    if (simulation->scratch) return STATUS_OK;
    simulation->scratch_size = 0;
    return error_set(error, STATUS_ENVIRONMENT, "no memory for pairs %td apart", reach);
}

/* Pairs visited: both sides of every sum in the own-width sums, each pair once in the forces. */
static void count_work(struct simulation *simulation)
{
    uint64_t pairs = 0;
    const int sums = 1 + (simulation->loops.matrix != NULL);
    for (ptrdiff_t b = 0; b < simulation->range_count; b++) {
        const struct range *range = &simulation->ranges[b];
        pairs += (uint64_t)(range->len * (2 * sums * range->reach + range->force_reach));
    }
    simulation->cost.pair_interactions += pairs;
    simulation->cost.particle_updates += (uint64_t)simulation->particles.n;
}

static enum status find_nan(const struct simulation *simulation, struct error *error)
{
    const struct particles *a = &simulation->particles;
    for (ptrdiff_t i = 0; i < a->n; i++) {
        if (!isfinite(a->F[i])) return broke_down(simulation, i, "force", a->F[i], error);
        if (!(a->h[i] / a->signal[i] >= 0))
            return broke_down(simulation, i, "signal speed", a->signal[i], error);
    }
    return broke_down(simulation, 0, "time step", simulation->time_step, error);
}

/* --- the evaluations -------------------------------------------------------------------------- */

/* Pairs reach as far as the wider of the two: the reach of a range for forces is the largest of all
 * ranges whose own reach touches it. */
static ptrdiff_t find_force_reach(struct simulation *simulation)
{
    struct range *ranges = simulation->ranges;
    const ptrdiff_t count = simulation->range_count, n = simulation->particles.n;
    ptrdiff_t widest = 0;
    for (ptrdiff_t b = 0; b < count; b++) {
        ranges[b].force_reach = ranges[b].reach;
        if (ranges[b].reach > widest) widest = ranges[b].reach;
    }
    for (ptrdiff_t b = 0; b < count; b++) {
        const ptrdiff_t reach = ranges[b].reach;
        ptrdiff_t gap = 0; /* particles between the two ranges */
        for (ptrdiff_t k = 1; k < count && gap < reach && gap < n; k++) {
            struct range *right = &ranges[(b + k) % count];
            struct range *left = &ranges[(b - k + count) % count];
            if (right->force_reach < reach) right->force_reach = reach;
            if (left->force_reach < reach) left->force_reach = reach;
            gap += right->len < left->len ? right->len : left->len;
        }
    }
    return widest;
}

static enum status prepare(struct simulation *simulation, bool newton, struct error *error)
{
    enum status status = restore_order(simulation, error);
    if (!status) status = find_primitives(simulation, error);
    for (ptrdiff_t b = 0; b < simulation->range_count; b++) simulation->ranges[b].pending = true;
    return status ? status : find_density(simulation, newton, error);
}

enum status evaluate_state(struct simulation *simulation, struct error *error)
{
    return prepare(simulation, true, error);
}

static void fill_rate_ghosts(struct simulation *simulation, ptrdiff_t count)
{
    const struct particles *a = &simulation->particles;
    const struct plan *plan = &simulation->plan;
    double *const always[] = {a->v, a->h, a->h_inverse, a->V, a->P, a->c, a->g};
    for (size_t k = 0; k < sizeof always / sizeof *always; k++)
        particles_fill_ghosts(a, always[k], count, 0);
    if (plan->viscosity) {
        particles_fill_ghosts(a, a->rho, count, 0);
        particles_fill_ghosts(a, a->alpha, count, 0);
    }
    if (plan->grad_h) {
        particles_fill_ghosts(a, a->b, count, 0);
        particles_fill_ghosts(a, a->grad_h, count, 0);
    }
}

/* The smallest time step of a range from its signal speeds. */
static double range_time_step(const struct simulation *simulation, const struct range *range)
{
    const double *h = simulation->particles.h + range->first;
    const double *signal = simulation->particles.signal + range->first;
    double step = INFINITY;
    for (int i = 0; i < range->len; i++) {
        const double own = h[i] / signal[i];
        step = own < step ? own : step;
        if (own != own) step = -1; /* NaN: the caller names the particle */
    }
    return step < 0 ? step : simulation->scheme.cfl * step;
}

/* dalpha/dt = max(-div v, 0)(alpha_max - alpha) - (alpha - alpha_min)/tau, tau = h/(0.2 c). */
static void range_dalpha(const struct simulation *simulation, const struct range *range)
{
    const struct particles *a = &simulation->particles;
    const struct scheme *scheme = &simulation->scheme;
    for (ptrdiff_t i = range->first; i < range->first + range->len; i++) {
        const double growth =
            largest(-a->div_v[i], 0) * largest(scheme->alpha_max - a->alpha[i], 0);
        a->dalpha[i] = growth - (a->alpha[i] - scheme->alpha_min) * 0.2 * a->c[i] / a->h[i];
    }
}

enum status evaluate_rates(struct simulation *simulation, struct error *error)
{
    const bool newton = simulation->plan.newton || simulation->last_dt <= 0;
    const enum status status = prepare(simulation, newton, error);
    if (status) return status;
    const struct particles *a = &simulation->particles;
    if (newton && !simulation->plan.newton)
        for (ptrdiff_t i = 0; i < a->n; i++) a->h_inverse_old[i] = a->h_inverse[i];
    const ptrdiff_t reach = find_force_reach(simulation);
    fill_rate_ghosts(simulation, reach + 1);

    const ptrdiff_t count = simulation->range_count;
    const int threads = threads_for(simulation);
    if (simulation->loops.matrix) {
#pragma omp parallel for schedule(static) num_threads(threads)
        for (ptrdiff_t b = 0; b < count; b++) {
            const struct range *range = &simulation->ranges[b];
            simulation->loops.matrix(&simulation->scheme.kernel, a, range->first, range->len,
                                     range->reach);
        }
        particles_fill_ghosts(a, a->g, reach + 1, 0);
        if (simulation->plan.slope) particles_fill_ghosts(a, a->dv, reach + 1, 0);
    }

    const enum status scratch_status = reserve_scratch(simulation, reach, error);
    if (scratch_status) return scratch_status;
    double time_step = INFINITY;
#pragma omp parallel for schedule(static) num_threads(threads) reduction(min : time_step)
    for (ptrdiff_t b = 0; b < count; b++) {
        struct range *range = &simulation->ranges[b];
        double *scratch = simulation->scratch + simulation->scratch_size * (size_t)thread_number();
        simulation->loops.force(&simulation->loops, &simulation->numbers, a, range->first,
                                range->len, range->force_reach, scratch);
        if (simulation->plan.alpha) range_dalpha(simulation, range);
        const double own = range_time_step(simulation, range);
        time_step = own < time_step ? own : time_step;
        if (simulation->cost.steps % 8 == 0) tighten(simulation, range);
    }
    simulation->time_step = time_step;
    count_work(simulation);
    return time_step < 0 ? find_nan(simulation, error) : STATUS_OK;
}

void evaluate_signal(struct simulation *simulation)
{
    const struct particles *a = &simulation->particles;
    for (ptrdiff_t i = 0; i < a->n; i++) a->v[i] = a->p[i] * a->m_inverse[i];
    const ptrdiff_t reach = find_force_reach(simulation);
    particles_fill_ghosts(a, a->v, reach + 1, 0);
    double time_step = INFINITY;
#pragma omp parallel for schedule(static) num_threads(threads_for(simulation))                     \
    reduction(min                                                                                  \
              : time_step)
    for (ptrdiff_t b = 0; b < simulation->range_count; b++) {
        const struct range *range = &simulation->ranges[b];
        loops_signal(a, range->first, range->len, range->force_reach);
        const double own = range_time_step(simulation, range);
        time_step = own < time_step ? own : time_step;
    }
    simulation->time_step = time_step;
}
