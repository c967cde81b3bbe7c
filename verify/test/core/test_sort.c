/* SPDX-License-Identifier: GPL-3.0-or-later
 * Tests the sort of positions: it is stable and takes n log n comparisons for any initial order. A
 * simulation starts from particles in any order. */
#include "test.h"

#include "hydro_setup.h"
#include "simulation.h"
#include "sort.h"

enum { N = 1 << 14 };

static unsigned random_next(unsigned *state)
{
    *state = *state * 1664525u + 1013904223u;
    return *state >> 8;
}

static double x[N];
static size_t order[N], other[N];

/* Sorts x[0..n-1] and verifies the result; returns the number of comparisons. */
static size_t sorted(size_t n)
{
    for (size_t i = 0; i < n; i++) order[i] = i;
    const size_t compared = sort_indices(x, n, order, other);
    static unsigned char seen[N];
    memset(seen, 0, n);
    for (size_t i = 0; i < n; i++) {
        assert_true(order[i] < n && !seen[order[i]]);
        seen[order[i]] = 1;
        if (i == 0) continue;
        assert_true(x[order[i - 1]] <= x[order[i]]);
        if (x[order[i - 1]] == x[order[i]]) assert_true(order[i - 1] < order[i]);
    }
    return compared;
}

/* The largest number of comparisons: each pass compares every index at most twice and halves the
 * number of sorted stretches. */
static size_t most(size_t n)
{
    return 2 * n * ((size_t)ceil(log2((double)n)) + 1);
}

TEST(any_order)
{
    unsigned seed = 7;
    for (size_t n = 2; n <= N; n *= 2) {
        for (size_t i = 0; i < n; i++) x[i] = (double)random_next(&seed);
        assert_true(sorted(n) <= most(n));
        for (size_t i = 0; i < n; i++) x[i] = (double)(random_next(&seed) % 10); /* many equal */
        assert_true(sorted(n) <= most(n));
        for (size_t i = 0; i < n; i++) x[i] = -(double)i; /* no two in order */
        assert_true(sorted(n) <= most(n));
    }
    for (size_t n = 0; n < 40; n++)
        for (int k = 0; k < 20; k++) {
            for (size_t i = 0; i < n; i++) x[i] = (double)(random_next(&seed) % 30);
            sorted(n);
        }
}

TEST(nearly_in_order)
{
    for (size_t i = 0; i < N; i++) x[i] = (double)i;
    assert_true(sorted(N) <= N);
    for (size_t i = N / 2; i + 1 < N / 2 + 10; i += 2) /* five pairs of neighbours have crossed */
        x[i] = (double)(i + 1), x[i + 1] = (double)i;
    assert_true(sorted(N) <= 8 * (size_t)N);
}

/* A rotation: particles have left the box at one end. There are two sorted stretches. */
TEST(across_the_ends)
{
    for (size_t i = 0; i < N; i++) x[i] = (double)((i + 77) % N);
    assert_true(sorted(N) <= 4 * (size_t)N);
}

/* The same particles in another order give the same simulation, except for the round-off of where
 * the box begins. */
TEST(shuffled_particles)
{
    static struct hydro_state plain, shuffled;
    const struct scheme scheme = hydro_scheme();
    struct simulation *a = NULL, *b = NULL;
    struct snapshot left, right;
    struct error error;
    unsigned seed = 3;
    size_t number[HYDRO_MAX], place[HYDRO_MAX];
    hydro_disordered(&plain, 500);
    shuffled = plain;
    for (size_t i = 0; i < plain.n; i++) number[i] = i;
    for (size_t i = plain.n; i > 1; i--) {
        const size_t j = random_next(&seed) % i, t = number[i - 1];
        number[i - 1] = number[j], number[j] = t;
    }
    for (size_t i = 0; i < plain.n; i++) {
        shuffled.x[0][i] = plain.x[0][number[i]];
        shuffled.v[0][i] = plain.v[0][number[i]];
        shuffled.m[i] = plain.m[number[i]], shuffled.u[i] = plain.u[number[i]];
    }
    const struct setup setups[] = {hydro_setup(&plain, &scheme), hydro_setup(&shuffled, &scheme)};
    assert_int_equal(simulation_create(&setups[0], &a, &error), STATUS_OK);
    assert_int_equal(simulation_create(&setups[1], &b, &error), STATUS_OK);
    simulation_snapshot(a, &left);
    simulation_snapshot(b, &right);
    for (size_t i = 0; i < plain.n; i++) place[left.id[i]] = i;
    for (size_t i = 0; i < plain.n; i++) {
        const size_t k = place[number[right.id[i]]];
        assert_true(fabs(left.x[0][k] - right.x[0][i]) <= 1e-13);
        assert_true(fabs(left.rho[k] / right.rho[i] - 1) <= 1e-11);
        const size_t next = (i + 1) % plain.n;
        assert_true(place[number[right.id[next]]] == (k + 1) % plain.n);
    }
    simulation_destroy(a);
    simulation_destroy(b);
}
