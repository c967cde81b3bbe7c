/* SPDX-License-Identifier: GPL-3.0-or-later
 * Tests tables as reference solutions: on random grids linear fields are exact, smooth ones
 * converge with their order, and the error of the interpolation is estimated. */
#include "test.h"

#include "draw.h"
#include "own_folder.h"
#include "user_table.h"

/* rho = 1 + a x + b y + c sin(2 pi x), P = 2 rho, v = (rho, -rho). */
static double field(double x, double y, const double c[3])
{
    return 3 + c[0] * x + c[1] * y + c[2] * sin(2 * M_PI * x);
}

enum shape { LINE, GRID_X_FAST, GRID_Y_FAST, RADIUS };

/* n ascending positions between 0 and 1, unevenly spaced. */
static void places(size_t n, double *x)
{
    double sum = 0;
    for (size_t i = 0; i < n; i++) x[i] = sum += draw(0.5, 1.5);
    for (size_t i = 0; i < n; i++) x[i] = (x[i] - 0.5) / sum;
}

static struct user_table *make(enum shape shape, size_t nx, size_t ny, const double c[3])
{
    double x[400], y[400];
    struct error error = {0};
    FILE *file = fopen(path_of("t"), "w");
    assert_non_null(file);
    places(nx, x), places(ny, y);
    fprintf(file, "#time=0\n# time = 0.25\n%s,a,vx,P,vy,rho\n",
            shape == LINE     ? "x"
            : shape == RADIUS ? "r"
                              : "x,y");
    if (shape == LINE || shape == RADIUS) ny = 1, y[0] = 0;
    for (size_t k = 0; k < nx * ny; k++) {
        const size_t i = shape == GRID_X_FAST ? k % nx : k / ny;
        const size_t j = shape == GRID_X_FAST ? k / nx : k % ny;
        const double rho = field(x[i], y[j], c);
        fprintf(file, "%.17g,", x[i]);
        if (shape == GRID_X_FAST || shape == GRID_Y_FAST) fprintf(file, "%.17g,", y[j]);
        fprintf(file, "7,%.17g,%.17g,%.17g,%.17g\n", rho, 2 * rho, -rho, rho);
    }
    assert_int_equal(fclose(file), 0);
    struct user_table *table = user_table_read(path_of("t"), &error);
    if (!table) fail_msg("%s", error.message);
    return table;
}

static struct prepared box(int dim, enum boundary boundary)
{
    struct prepared p = {.gamma = 1.5, .domain.dim = dim, .window.dim = dim};
    for (int d = 0; d < dim; d++) {
        p.domain.hi[d] = p.window.hi[d] = 1;
        p.window.centre[d] = 0.5;
        p.boundary[d] = boundary;
    }
    return p;
}

TEST(linear_fields_are_exact)
{
    for (int round = 0; round < 60; round++) {
        const enum shape shape = (enum shape)draw_count(LINE, GRID_Y_FAST);
        const double c[3] = {draw(-1, 1), shape == LINE ? 0 : draw(-1, 1), 0};
        const size_t nx = (size_t)draw_count(2, 40), ny = (size_t)draw_count(2, 40);
        struct user_table *table = make(shape, nx, ny, c);
        const struct prepared p = box(2, BOUNDARY_OPEN);
        assert_true(user_table_time(table) == 0.25);
        for (int k = 0; k < 50; k++) {
            const double x[3] = {draw(0.51, 0.6), draw(0.51, 0.6)};
            const double rho = field(x[0], x[1], c);
            struct problem_state s;
            user_table_sample(table, &p, x, &s);
            near_below(fabs(s.rho - (rho)), 1e-14);
            near_below(fabs(s.P - (2 * rho)), 1e-13);
            near_below(fabs(s.u - (2 / 0.5)), 1e-13);
            near_below(fabs(s.v[0] - (rho)), 1e-14);
            near_below(fabs(s.v[1] - (-rho)), 1e-14);
        }
        user_table_free(table);
    }
}

/* Returns the largest error in the box; *miss: the table's own estimate of its error. */
static double worst(size_t n, enum boundary boundary, double *miss)
{
    static const double c[3] = {0, 0, 1};
    struct user_table *table = make(LINE, n, 1, c);
    const struct prepared p = box(1, boundary);
    const struct snapshot none = {.n = 0};
    struct problem_state s;
    double largest = 0, misses[FIELDS];
    for (int k = 0; k < 2000; k++) {
        const double x[3] = {draw(0, 1)};
        user_table_sample(table, &p, x, &s);
        largest = fmax(largest, fabs(s.rho - field(x[0], 0, c)));
    }
    user_table_error(table, &p, &none, misses);
    *miss = misses[FIELD_DENSITY];
    user_table_free(table);
    return largest;
}

TEST(smooth_fields_to_their_order)
{
    double miss[2];
    const double coarse = worst(20, BOUNDARY_PERIODIC, &miss[0]);
    const double fine = worst(320, BOUNDARY_PERIODIC, &miss[1]);
    assert_true(coarse < 0.3 && fine < coarse / 100); /* linear across the ends: order 2 */
    assert_true(miss[1] < miss[0] / 50 && miss[0] > 0.003 && miss[1] > 1e-6);
}

TEST(interpolation_across_periodic_ends)
{
    static const double c[3] = {0, 0, 1};
    struct user_table *table = make(LINE, 100, 1, c);
    struct prepared p = box(1, BOUNDARY_PERIODIC);
    struct problem_state in, out;
    for (int k = 0; k < 100; k++) {
        const double x[3] = {draw(-0.002, 0.002)}, image[3] = {x[0] + 1};
        user_table_sample(table, &p, x, &in);
        user_table_sample(table, &p, image, &out);
        near_below(fabs(in.rho - field(x[0], 0, c)), 2e-3);
        near_below(fabs(in.rho - (out.rho)), 1e-12);
    }
    /* nothing is known beyond two spacings from the ends of a box that is not periodic */
    p.boundary[0] = BOUNDARY_OPEN;
    user_table_sample(table, &p, (double[3]){-0.1}, &out);
    assert_true(isnan(out.rho) && isnan(out.v[0]) && isnan(out.u));
    user_table_free(table);
}

TEST(tables_over_radius)
{
    FILE *file = fopen(path_of("t"), "w");
    struct error error = {0};
    fputs("# time = 1\nr,vr,vphi,rho,u\n0,0,0,1,2\n0.5,1,2,3,4\n0.8,1.6,3.2,3,4\n", file);
    assert_int_equal(fclose(file), 0);
    struct user_table *table = user_table_read(path_of("t"), &error);
    const struct prepared p = box(2, BOUNDARY_OPEN);
    for (int k = 0; k < 100; k++) { /* vr = 2 r, vphi = 4 r */
        const double x[3] = {draw(0, 1), draw(0, 1)}, dx = x[0] - 0.5, dy = x[1] - 0.5;
        struct problem_state s;
        user_table_sample(table, &p, x, &s);
        near_below(fabs(s.v[0] - (2 * dx - 4 * dy)), 0.02);
        near_below(fabs(s.v[1] - (2 * dy + 4 * dx)), 0.02);
        near_below(fabs(s.P - (0.5 * s.rho * s.u)), 1e-14);
    }
    user_table_free(table);
}
