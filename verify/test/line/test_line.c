/* SPDX-License-Identifier: GPL-3.0-or-later
 * Tests what surrounds the sums in 1D (order, images at the ends, reach, inactive particles)
 * against plain searches over all particles, on random setups. */
#include "test.h"

#include <float.h>

#include "draw.h"
#include "line/line.h"
#include "sample_simulation.h"

enum { GHOSTS = 256, SETUPS = 40 };

/* A simulation that makes no steps: n sorted particles in a period of 2. */
static void made(struct simulation *simulation, int n)
{
    struct error error;
    memset(simulation, 0, sizeof *simulation);
    simulation->team.size = simulation->team.most = 1;
    if (particles_create(&simulation->particles, 1, n, GHOSTS, &error))
        fail_msg("%s", error.message);
    struct particles *a = &simulation->particles;
    struct line *line = simulation->workspace = calloc(1, sizeof *line);
    assert_non_null(line);
    a->period[0] = 2;
    double x = 0.1;
    for (int i = 0; i < n; i++) {
        a->x[0][i] = x;
        x += draw(0.2, 1.8) * 1.99 / (1.8 * n);
        a->x_old[0][i] = a->x[0][i] - 0.01;
        a->id[i] = (size_t)i;
        a->m[i] = 100 + i;
        a->h[i] = draw(0.5, 6) * 2 / n;
        a->h_inverse[i] = 1 / a->h[i];
    }
    line->range_count = (n + BATCH_MAX - 1) / BATCH_MAX;
    line->ranges = calloc((size_t)(n / GROUP + 2), sizeof *line->ranges);
    for (int b = 0; b < line->range_count; b++)
        line->ranges[b] = (struct range){.first = (ptrdiff_t)b * BATCH_MAX, .reach = 1};
    for (int b = 0; b < line->range_count; b++)
        line->ranges[b].len = b + 1 < line->range_count ? BATCH_MAX : n - b * BATCH_MAX;
}

static void unmade(struct simulation *simulation)
{
    line_sums.free(simulation);
    particles_destroy(&simulation->particles);
    free(simulation->sleep.spans);
}

/* --- order ------------------------------------------------------------------------------------ */

TEST(nan_positions_are_not_sorted)
{
    static const double bad[] = {NAN, INFINITY, -INFINITY};
    for (int k = 0; k < 3; k++)
        for (int at = 0; at < 3; at++) {
            struct simulation s;
            struct error error;
            made(&s, 70);
            struct particles *a = &s.particles;
            const int i = at == 0 ? 0 : at == 1 ? 64 : 69;
            a->x[0][5] = a->x[0][9];
            a->x[0][i] = bad[k];
            const double kept = a->x[0][30];
            assert_true(!order_sort(a) && a->x[0][30] == kept && a->id[30] == 30);
            assert_int_equal(order_arrange(&s, &error), STATUS_BROKE_DOWN);
            char said[100];
            snprintf(said, sizeof said,
                     "broke down at t = 0: position of particle %d at x = %g is %g", i, bad[k],
                     bad[k]);
            assert_string_equal(error.message, said);
            unmade(&s);
        }
}

/* If the kernel's self-contribution exceeds what `count` coincident particles allow, their guessed
 * widths are those of particles a thousandth of a spacing apart, or evenly spread over half of the
 * distance to the nearer neighbour. */
TEST(widths_of_coincident_particles)
{
    enum { MEMBERS = 12 };
    const struct kernel *kernel =
        (const struct kernel *)kernel_family.members[kernel_index("cubic_spline")];
    const double least = kernel_least_eta(kernel, 1);
    int binding = 0;
    for (int count = 1; count <= 5; count++)
        for (int first = 0; first + count <= MEMBERS; first++)
            for (int wide = 0; wide < 7; wide++) {
                struct simulation s;
                made(&s, MEMBERS);
                struct particles *a = &s.particles;
                if (wide == 6) /* the nearer neighbour may lie beyond an end of the box */
                    for (int i = 1; i < MEMBERS; i++)
                        a->x[0][i] = first ? a->x[0][0] + 1.99 - 0.1 * (MEMBERS - 1 - i)
                                           : a->x[0][0] + 1.999 - 0.1 * (MEMBERS - 1 - i);
                for (int i = first; wide == 6 && first + count == MEMBERS && i < MEMBERS; i++)
                    a->x[0][i] = a->x[0][0] + 1.999;
                s.scheme.eta = wide == 3   ? 0.5 * least
                               : wide == 4 ? count * least /* exactly the limit */
                               : wide == 5 ? nextafter(count * least, 9)
                                           : 2;
                s.scheme.kernel = *kernel;
                const double at = a->x[0][first];
                for (int i = 0; i < count; i++) a->x[0][first + i] = at;
                for (int i = 0; i < MEMBERS; i++) {
                    a->h[i] = (wide == 1   ? 3000
                               : wide == 2 ? 100
                               : wide == 6 ? 9000
                                           : 0.3) *
                              (1 + 0.01 * i);
                    a->x_old[0][i] = 7 + i;
                }
                const double below = first ? a->x[0][first - 1] : a->x[0][MEMBERS - 1] - 2;
                const double above =
                    first + count < MEMBERS ? a->x[0][first + count] : a->x[0][0] + 2;
                const double even = 0.5 * fmin(at - below, above - at) / count;
                const double gap = fmin(1e-3 * a->h[first] / s.scheme.eta, even);
                const bool apart = count > 1 && count * least >= s.scheme.eta;
                binding += apart && gap == even;
                order_begin(&s);
                for (int i = 0; i < count; i++)
                    near_absolute(a->x[0][first + i],
                                  at + (apart ? gap * (i - 0.5 * (count - 1)) : 0), 1e-15);
                for (int i = 0; i < MEMBERS; i++)
                    assert_true(a->x_old[0][i] ==
                                (apart && i >= first && i < first + count ? a->x[0][i] : 7 + i));
                assert_true(order_crossings(a, 0, MEMBERS - 1) == 0);
                unmade(&s);
            }
    assert_true(binding > 20);
}

/* While some particles are inactive, the order of those at rest is not checked, and that of moving
 * ones is; if the order has changed all become active. */
TEST(order_of_inactive_particles)
{
    struct error error;
    for (int at_rest = 0; at_rest < 2; at_rest++)
        for (int at = -1; at < 149; at++) {
            struct simulation s;
            made(&s, 150);
            double *x = s.particles.x[0];
            struct groups *groups = &line_of(&s)->groups;
            s.plan.sleep = false;
            assert_int_equal(groups_begin(&s, &error), STATUS_OK);
            s.sleep.on = true, s.sleep.at_rest = at_rest;
            groups->awake[3] = 0;
            line_of(&s)->range_count = 1;
            line_of(&s)->ranges[0] = (struct range){.first = 64, .len = 16};
            if (at >= 0) {
                const double kept = x[at];
                x[at] = x[at + 1], x[at + 1] = kept;
            }
            assert_int_equal(order_arrange(&s, &error), STATUS_OK);
            const bool seen = at >= 0 && (!at_rest || (at >= 63 && at < 80));
            assert_int_equal(groups->awake[3], seen);
            assert_int_equal(s.sleep.on, !seen);
            assert_int_equal(s.particles.id[at < 0 ? 0 : at],
                             !seen || !at ? (at < 0 ? 0 : at) : at + 1);
            unmade(&s);
        }
}

/* --- images and reach ------------------------------------------------------------------------- */

/* Particles are divided into ranges that are full except for the last one. */
TEST(particles_are_divided_into_ranges)
{
    for (size_t n = 20; n<330; n += n % 64> 61 || n % 64 < 3 ? 1 : 7) {
        struct simulation *s = sample_simulation(n);
        const struct line *line = line_of(s);
        assert_true(line->range_count * BATCH_MAX >= (ptrdiff_t)n);
        assert_true((line->range_count - 1) * BATCH_MAX < (ptrdiff_t)n);
        for (ptrdiff_t b = 0; b < line->range_count; b++) {
            const bool last = b == line->range_count - 1;
            assert_int_equal(line->ranges[b].first, BATCH_MAX * b);
            assert_int_equal(line->ranges[b].len, last ? (ptrdiff_t)n - BATCH_MAX * b : BATCH_MAX);
        }
        assert_true(s->particles.ghosts == 64 && s->particles.n == (ptrdiff_t)n);
        assert_true(line_sums.bytes(s, 1000) == 125. * sizeof(struct range));
        simulation_destroy(s);
        struct simulation bare = {0};
        struct error error;
        assert_int_equal(line_sums.create(&bare, (ptrdiff_t)n, &error), STATUS_OK);
        const struct range *ranges = line_of(&bare)->ranges;
        assert_int_equal(line_of(&bare)->range_count, (ptrdiff_t)(n + BATCH_MAX - 1) / BATCH_MAX);
        for (ptrdiff_t b = 0; b < line_of(&bare)->range_count; b++)
            assert_true(ranges[b].reach == 1 && ranges[b].first == BATCH_MAX * b);
        assert_int_equal(ranges[line_of(&bare)->range_count].reach, 0);
        unmade(&bare);
    }
    struct simulation none = {0};
    line_sums.free(&none); /* a line that was not created */
}

/* The largest offset in the order at which a neighbour is within a particle's own h. */
static int farthest(const struct particles *a, const struct range *range)
{
    int most = 0;
    for (ptrdiff_t i = range->first; i < range->first + range->len; i++)
        for (int d = 1; d < GHOSTS - 8; d++)
            if ((a->x[0][i + d] - a->x[0][i]) * a->h_inverse[i] < 1 ||
                (a->x[0][i] - a->x[0][i - d]) * a->h_inverse[i] < 1)
                if (d > most) most = d;
    return most;
}

TEST(reach_covers_the_widths)
{
    for (int setup = 0; setup < SETUPS; setup++) {
        struct simulation s;
        made(&s, draw_count(20, 300));
        const struct particles *a = &s.particles;
        struct line *line = line_of(&s);
        ghosts_fill(a, a->x[0], GHOSTS - 8, 2);
        for (ptrdiff_t b = 0; b < line->range_count; b++) {
            struct range *range = &line->ranges[b];
            const int most = farthest(a, range);
            for (int d = 1; d < 12; d++) {
                int count = 0;
                for (ptrdiff_t i = range->first; i < range->first + range->len; i++)
                    count += (a->x[0][i + d] - a->x[0][i]) * a->h_inverse[i] < 1 ||
                             (a->x[0][i] - a->x[0][i - d]) * a->h_inverse[i] < 1;
                assert_int_equal((int)reach_inside(a, range->first, range->len, d), count);
            }
            /* the reach is raised as far as necessary if there are images for one more offset */
            const int needed = most < 1 ? 1 : most;
            range->reach = 1;
            line->ghosts_filled = needed + 1;
            assert_true(reach_cover(&s, range));
            assert_int_equal(range->reach, needed);
            range->reach = 1;
            line->ghosts_filled = needed;
            assert_false(reach_cover(&s, range));
            range->reach = needed + draw_count(0, 3);
            reach_tighten(&s, range);
            assert_int_equal(range->reach, needed);
        }
        unmade(&s);
    }
}

/* The reach of a range's pairs is the widest reach of all ranges that extend to it. To their
 * distance, the k-th ranges on the left and right of it both add the shorter one's length. */
TEST(pairs_reach_as_far_as_the_wider_one)
{
    for (int setup = 0; setup < 10 * SETUPS; setup++) {
        struct simulation s;
        made(&s, draw_count(40, 700));
        struct line *line = line_of(&s);
        const ptrdiff_t count = line->range_count;
        for (ptrdiff_t b = 0; b < count; b++) {
            struct range *range = &line->ranges[b];
            if (setup % 2) range->len = draw_count(1, range->len); /* spans may end anywhere */
            range->reach = draw(0, 1) < 0.2   ? draw_count(1, 150)
                           : draw(0, 1) < 0.2 ? BATCH_MAX * draw_count(1, 2)
                                              : draw_count(1, 4);
            if (range->reach > line->reach) line->reach = range->reach;
        }
        for (ptrdiff_t b = 0; b < count; b++) {
            ptrdiff_t most = line->ranges[b].reach, between = 0;
            for (ptrdiff_t k = 1; k < count; k++) {
                const struct range *sides[] = {&line->ranges[(b + k) % count],
                                               &line->ranges[(b + count - k) % count]};
                for (int side = 0; side < 2; side++)
                    if (between < sides[side]->reach && sides[side]->reach > most)
                        most = sides[side]->reach;
                between += sides[0]->len < sides[1]->len ? sides[0]->len : sides[1]->len;
            }
            assert_int_equal(reach_of_pairs(&s, &line->ranges[b]), most);
        }
        unmade(&s);
    }
}

/* A particle at a distance of exactly h is not inside. */
TEST(widths_end_at_h)
{
    struct simulation s;
    made(&s, 70);
    const struct particles *a = &s.particles;
    for (int i = -GHOSTS; i < 70 + GHOSTS; i++)
        a->x[0][i] = 0.25 * i, a->h_inverse[i] = i == 3 ? 2 - 0x1p-50 : 2;
    assert_true(reach_inside(a, 0, 64, 1) == 64 && reach_inside(a, 0, 64, 2) == 1);
    assert_true(reach_inside(a, 4, 60, 2) == 0 && reach_inside(a, 0, 64, 3) == 0);
    for (int reach = 1; reach < 4; reach++) { /* no neighbour is inside: the reach is 1 */
        struct range range = {.first = 20, .len = 20, .reach = reach};
        for (int i = 0; i < 70; i++) a->h_inverse[i] = 5;
        reach_tighten(&s, &range);
        assert_int_equal(range.reach, 1);
    }
    unmade(&s);
}

static double counted;

static void see_all(void *context, size_t i, const struct description *of)
{
    const double want[] = {70 + 2 * GHOSTS, 3, 1};
    const bool *matrix = context;
    assert_true(of->neighbours == want[i < 2 ? i : 2]);
    assert_true(*matrix ? of->condition == 1 && of->angle == 0
                        : isnan(of->condition) && isnan(of->angle));
    counted++;
}

/* The search ends with the last image and does not count particles at a distance of exactly h. */
TEST(search_ends_at_the_last_image)
{
    struct simulation s;
    made(&s, 70);
    const struct particles *a = &s.particles;
    for (int i = -GHOSTS; i < 70 + GHOSTS; i++)
        a->x[0][i] = 0.25 * i, a->h_inverse[i] = i == 0 ? 1e-9 : i == 1 ? 2 : 4;
    for (int matrix = 0; matrix < 2; matrix++) {
        s.plan.matrix = matrix, counted = 0;
        line_sums.describe(&s, see_all, &s.plan.matrix);
        assert_true(counted == 70);
    }
    unmade(&s);
}

/* --- inactive particles ----------------------------------------------------------------------- */

/* Each limit exactly, and the next number beyond it, in d dimensions; the setup's mean sound speed
 * and pressure count if they are larger than the particle's own. */
TEST(limits_of_disturbances)
{
    for (int dim = 1; dim <= 3; dim++)
        for (int n = 10; n < 9000; n += 1700)
            for (int what = 0; what < 6; what++)
                for (int beyond = 0; beyond < 2; beyond++)
                    for (int at = 2; at < 8; at++) {
                        const bool mean = what >= 3;
                        struct simulation s = {.plan.alpha = what % 3 == 2, .plan.dim = dim};
                        struct error error;
                        struct particles *a = &s.particles;
                        if (particles_create(a, dim, n, 0, &error)) fail_msg("%s", error.message);
                        const double limit = fmax(1e-11, 30 * DBL_EPSILON * pow(n, 1. / dim));
                        s.sleep.tolerance = sleep_least_tolerance(&s);
                        if (mean) s.sleep.sound = 20;
                        for (int i = 0; i < 9; i++) {
                            a->P[i] = 3 + i, a->c[i] = 2 + i, a->h[i] = 0.25 + 0.125 * i;
                            a->v[0][i] = -4, a->m[i] = 1 + i;
                            const double c = mean ? 20 : a->c[i];
                            const double force = a->m[i] * c * c / a->h[i];
                            double *of = what % 3 == 0   ? &a->F[0][i]
                                         : what % 3 == 1 ? &a->de[i]
                                                         : &a->dalpha[i];
                            *of = what % 3 == 0   ? limit * force
                                  : what % 3 == 1 ? limit * force * (c + 4)
                                                  : limit * c / a->h[i];
                            *of *= 1 - 8 * DBL_EPSILON;
                            if (beyond && i == at) *of *= 1 + 16 * DBL_EPSILON;
                            if (i % 2) *of = -*of;
                        }
                        const double worst = sleep_disturbance(&s, 3, 4);
                        near_relative(worst, 1, 1e-14);
                        assert_int_equal(worst > 1, beyond && at >= 3 && at < 7);
                        if (what % 3 == 2) {
                            s.plan.alpha = false;
                            assert_true(sleep_disturbance(&s, 3, 4) == 0);
                        }
                        a->c[5] = NAN;
                        assert_true(isnan(sleep_disturbance(&s, 3, 4)));
                        particles_destroy(a);
                    }
}

/* A setup at speed v in which all groups can be inactive except those given: in each of them one
 * particle has dp/dt != 0. */
static void at_rest(struct simulation *s, const bool *disturbed, double v)
{
    struct particles *a = &s->particles;
    s->plan.sleep = true, s->plan.dim = 1;
    for (ptrdiff_t i = -GHOSTS; i < a->n + GHOSTS; i++)
        a->P[i] = a->c[i] = 1, a->v[0][i] = v, a->p[0][i] = v, a->m[i] = a->h[i];
    ghosts_fill(a, a->x[0], GHOSTS - 8, 2);
    ghosts_fill(a, a->h_inverse, GHOSTS - 8, 0);
    for (ptrdiff_t i = 0; i < a->n; i++) {
        a->F[0][i] = 1e-12, a->de[i] = -1e-12;
        if (disturbed[i / GROUP] && (i % GROUP == (i / GROUP) % GROUP || i == a->n - 1))
            a->F[0][i] = -1e-10;
    }
}

/* Compares active groups, spans and ranges with the groups expected to be active. */
static void sleeps(const struct simulation *s, const bool *awake)
{
    const struct line *line = line_of(s);
    const ptrdiff_t n = s->particles.n, groups = (n + GROUP - 1) / GROUP;
    ptrdiff_t spans = 0, ranges = 0, count = 0;
    double rate = 0;
    for (ptrdiff_t g = 0; g < groups; g++) {
        assert_int_equal(line->groups.awake[g] != 0, awake[g]);
        double rate_of = 0; /* the rate 2/h of inactive gas */
        for (ptrdiff_t i = g * GROUP; i < n && i < (g + 1) * GROUP; i++)
            rate_of = fmax(rate_of, 2 * s->particles.h_inverse[i]);
        if (awake[g]) rate_of = 0;
        assert_true(fabs(line->groups.rate[g] - rate_of) <= 1e-10 * rate_of);
        rate = fmax(rate, line->groups.rate[g]);
        for (ptrdiff_t i = g * GROUP; !awake[g] && i < n && i < (g + 1) * GROUP; i++)
            assert_true(s->particles.F[0][i] == 0 && s->particles.de[i] == 0);
    }
    for (ptrdiff_t g = 0, end; g < groups; g = end) {
        for (end = g + 1; end < groups && awake[end] == awake[g];) end++;
        if (!awake[g]) continue;
        const ptrdiff_t first = g * GROUP, last = end * GROUP < n ? end * GROUP : n;
        assert_true(spans < s->sleep.span_count);
        assert_int_equal(s->sleep.spans[spans].first, first);
        assert_int_equal(s->sleep.spans[spans].len, last - first);
        for (ptrdiff_t at = first; at < last; at += BATCH_MAX) {
            assert_true(ranges < line->range_count);
            assert_int_equal(line->ranges[ranges].first, at);
            assert_int_equal(line->ranges[ranges].len,
                             last - at < BATCH_MAX ? last - at : BATCH_MAX);
            assert_int_equal(line->ranges[ranges].reach, 1);
            ranges++;
        }
        spans++;
        count += last - first;
    }
    assert_int_equal(s->sleep.span_count, spans);
    assert_int_equal(line->range_count, ranges);
    assert_int_equal(s->sleep.awake_count, count);
    assert_true(s->sleep.on == (count < n) && s->sleep.rate == rate);
}

static void wake_around(bool *awake, ptrdiff_t groups, ptrdiff_t g, ptrdiff_t margin)
{
    for (ptrdiff_t k = -margin; k <= margin; k++)
        awake[((g + k) % groups + groups) % groups] = true;
}

static ptrdiff_t margin_of(ptrdiff_t reach)
{
    ptrdiff_t margin = 0;
    while (margin * GROUP < 2 * reach + 2) margin++;
    return margin;
}

/* Active groups become inactive again far from disturbed groups (above a quarter of the tolerance,
 * in a rate or in a velocity relative to the neighbour); that is checked every 16 steps. */
static void sleep_once_calm(struct simulation *s, ptrdiff_t reach, bool sheared)
{
    const ptrdiff_t n = s->particles.n, groups = (n + GROUP - 1) / GROUP;
    bool awake[100] = {false};
    const double limit = fmax(1e-11, 30 * DBL_EPSILON * (double)n), v = s->particles.v[0][0];
    for (ptrdiff_t i = 0; i < n; i++) s->particles.F[0][i] = 0.24 * limit, s->particles.de[i] = 0;
    for (ptrdiff_t g = 0; g < groups; g++) {
        const ptrdiff_t at = g * GROUP + draw_count(0, GROUP - 1);
        if (draw(0, 1) > 0.06 || at >= n) continue;
        if (sheared) {
            s->particles.v[0][at] = v + 0.3 * limit;
            if (at % GROUP == 0) wake_around(awake, groups, g - 1, margin_of(reach));
        } else {
            s->particles.F[0][at] = -0.26 * limit;
        }
        wake_around(awake, groups, g, margin_of(reach));
    }
    line_of(s)->ranges[0].reach = 1; /* as in a new arrangement */
    s->cost.steps = 14;
    groups_update(s);
    assert_int_equal(s->sleep.awake_count, n);
    s->cost.steps = 31;
    groups_update(s);
    for (ptrdiff_t i = 0; i < n; i++) {
        if (!awake[i / GROUP]) assert_true(s->particles.F[0][i] == 0);
        s->particles.v[0][i] = v;
    }
    sleeps(s, awake);
}

/* Groups that are inactive at the start, and groups that become active when a signal comes near the
 * end of a span. */
TEST(groups_become_inactive_and_active)
{
    enum { MOST = 100 };
    for (int setup = 0; setup < 10 * SETUPS; setup++) {
        struct simulation s;
        struct error error;
        const int n = setup % 4 ? draw_count(16, MOST * GROUP)
                                : GROUP * draw_count(2, MOST - 1) + (setup % 8 == 0);
        const ptrdiff_t groups = (n + GROUP - 1) / GROUP;
        bool disturbed[MOST] = {false}, awake[MOST] = {false};
        made(&s, n);
        struct line *line = line_of(&s);
        const bool narrow =
            setup % 5 == 0; /* spans shorter than the margin that is checked later */
        const ptrdiff_t reach = line->reach = narrow ? 1 : draw_count(1, 12);
        for (ptrdiff_t g = 0; g < groups; g++) disturbed[g] = draw(0, 1) < 0.06;
        at_rest(&s, disturbed, setup % 3 ? 0 : 0.1);
        for (ptrdiff_t g = 0; g < groups; g++)
            if (disturbed[g]) wake_around(awake, groups, g, margin_of(reach));
        for (ptrdiff_t i = n; i < n + GROUP; i++) s.particles.F[0][i] = 77; /* beyond n */
        assert_int_equal(groups_begin(&s, &error), STATUS_OK);
        sleeps(&s, awake);
        for (ptrdiff_t i = n; i < n + GROUP; i++) assert_true(s.particles.F[0][i] == 77);
        assert_true(s.sleep.at_rest == (setup % 3 != 0 || !s.sleep.on));

        /* a span wakes groups around its first and its last disturbed particle within the margin */
        bool later[MOST];
        memcpy(later, awake, sizeof later);
        for (ptrdiff_t i = 0; i < n; i++)
            s.particles.F[0][i] = (narrow || awake[i / GROUP]) && draw(0, 1) < 0.02 ? 1 : 0;
        if (awake[groups - 1]) s.particles.F[0][n - 1] = setup % 2;
        for (ptrdiff_t b = 0; b < line->range_count; b++)
            line->ranges[b].force_reach = draw_count(narrow ? 10 : 1, 12);
        for (ptrdiff_t k = 0, b = 0; k < s.sleep.span_count; k++) {
            const struct span *span = &s.sleep.spans[k];
            const ptrdiff_t first = span->first / GROUP,
                            last = (span->first + span->len - 1) / GROUP,
                            from = margin_of(line->ranges[b].force_reach);
            b += (span->len + BATCH_MAX - 1) / BATCH_MAX;
            const ptrdiff_t to = margin_of(line->ranges[b - 1].force_reach);
            bool moved[MOST] = {false};
            for (ptrdiff_t i = 0; i < n; i++) moved[i / GROUP] |= s.particles.F[0][i] > 0;
            ptrdiff_t g = first;
            while (g <= last && g < first + from && !moved[g]) g++;
            if (g <= last && g < first + from) wake_around(later, groups, g, from);
            for (g = last; g >= first && g > last - to && !moved[g];) g--;
            if (g >= first && g > last - to) wake_around(later, groups, g, to);
        }
        groups_update(&s);
        for (ptrdiff_t i = 0; i < n; i++)
            if (!later[i / GROUP]) s.particles.F[0][i] = 0;
        sleeps(&s, later);
        groups_wake_all(&s);
        for (ptrdiff_t g = 0; g < groups; g++) later[g] = true;
        sleeps(&s, later);
        s.particles.F[0][3] = 1, line->ranges[0].reach = 5;
        groups_update(&s); /* all are active: nothing to do */
        assert_int_equal(line->ranges[0].reach, 5);
        sleep_once_calm(&s, reach, setup % 2);
        unmade(&s);
    }
}
