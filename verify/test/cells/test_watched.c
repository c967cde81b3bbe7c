/* SPDX-License-Identifier: GPL-3.0-or-later
 * Runs searches and sums on clouds with the checked allocator of watched.h: nothing is read before
 * it is written, nothing is written beyond an array, everything is freed, and each allocation that
 * fails gives the status and message of missing memory. */
#include "test.h"

#include "draw.h"
#include "cells/cells.h"
#include "grid.h"
#include "sample_lattice.h"
#include "operator.h"
#include "shapes.h"
#include "summation.h"
#include "watched.h"

enum { POINTS_MAX = 3000 };

static double place[3][POINTS_MAX], field[POINTS_MAX], volume[POINTS_MAX], width[POINTS_MAX],
    out[3][POINTS_MAX];

/* n points in a box of side 1, in units of `unit`. */
static void make(size_t n, double h, double unit)
{
    for (size_t i = 0; i < n; i++) {
        for (int a = 0; a < 3; a++) place[a][i] = unit * draw(0, 1);
        field[i] = draw(-1, 1), volume[i] = draw(0.5, 1) / (double)n, width[i] = unit * h;
    }
}

static struct points points_of(int dim, size_t n, bool periodic)
{
    return (struct points){dim, n, {place[0], place[1], place[2]}, periodic, {0}, {1, 1, 1}};
}

static struct kernel kernel;

/* A function that allocates memory, for n points in dim dimensions. */
typedef enum status work(int dim, size_t n, struct error *error);

static enum status find(int dim, size_t n, struct error *error)
{
    const struct points points = points_of(dim, n, true);
    struct neighbours *nb;
    struct candidates c = {0};
    enum status status = neighbours_create(&points, &nb, error);
    if (status) assert_null(nb);
    for (size_t b = 0; !status && b < nb->blocks; b++)
        status = neighbours_gather(nb, b, width[0] + (double)b * 1e-3, &c, error);
    neighbours_candidates_free(&c);
    neighbours_destroy(nb);
    return status;
}

static enum status differentiate(int dim, size_t n, struct error *error)
{
    const struct cloud cloud = {points_of(dim, n, false), volume, width};
    const double *f[] = {field};
    double *gradient[] = {out[0], out[1], out[2]};
    uint64_t pairs;
    enum status status = STATUS_OK;
    for (size_t o = n < 100 ? 0 : operator_family.n - 1; !status && o < operator_family.n; o++) {
        const struct operator_settings settings = {
            (const struct operator_form *)operator_family.members[o], &kernel, false, 1};
        status = operator_apply(&settings, &cloud, 1, f, gradient, NULL, &pairs, error);
        for (int a = 0; !status && settings.form->corrected == false && a < dim; a++)
            for (size_t i = 0; i < n; i++) assert_true(isfinite(gradient[a][i]));
    }
    return status;
}

/* Points with few neighbours, then with many, then with few. */
static enum status differentiate_clump(int dim, size_t n, struct error *error)
{
    for (size_t i = 0; i < n; i++) {
        const bool clumped = i > n / 4 && i < n - n / 4;
        for (int a = 0; a < 3; a++)
            place[a][i] = clumped ? 400 + draw(0, 1) : (double)i * (i < n / 2 ? 1 : 10);
        width[i] = clumped ? 3 : 1.5;
    }
    return differentiate(dim, n, error);
}

/* In units so extreme that scaled copies are made. */
static enum status far_away(int dim, size_t n, struct error *error)
{
    make(n, 0.3, 1e90);
    const enum status status = differentiate(dim, n, error);
    make(n, 0.3, 1);
    return status;
}

/* All points are within reach of all others. */
static enum status differentiate_all(int dim, size_t n, struct error *error)
{
    for (size_t i = 0; i < n; i++) width[i] = 2;
    return differentiate(dim, n, error);
}

static enum status weigh(int dim, size_t n, struct error *error)
{
    const struct summation sum = {points_of(dim, n, false), &kernel, volume, 1.6, 1e-8, 1};
    return summation_solve(&sum, out[0], out[1], error);
}

static enum status list(int dim, size_t n, struct error *error)
{
    const struct grid_box box = {dim, {0}, {1, 1, 1}, {true, false, true}};
    const double *const at[] = {place[0], place[1], place[2]};
    struct grid *grid = grid_create(&box, n / 3, 1);
    if (!grid) return error_set(error, STATUS_ENVIRONMENT, "no memory");
    enum status status = STATUS_OK;
    for (int more = 3; !status && more > 0; more--) /* more capacity each time */
        status = grid_search(grid, n / (size_t)more, n / (size_t)more, at, width, NULL, error);
    const long calls = watched_calls;
    for (int again = 0; !status && again < 9; again++) /* no allocation the next time */
        status = grid_search(grid, n, n, at, width, NULL, error);
    if (!status) assert_int_equal(watched_calls, calls);
    if (status == STATUS_ENVIRONMENT) { /* a call that is repeated with memory succeeds */
        struct error later;
        assert_int_equal(grid_search(grid, n, n, at, width, NULL, &later), STATUS_OK);
    }
    grid_destroy(grid);
    return status;
}

/* Particles and their images in walls, with capacity for fewer of them. */
static enum status arrange(int dim, size_t n, struct error *error)
{
    static double h_inverse[POINTS_MAX];
    const struct cells_method method = {.box = {dim, {0}, {1, 1, 1}, {true}},
                                        .wall = {false, true, true},
                                        .kernel = &kernel,
                                        .threads = 1};
    const struct cells_fields fields = {.n = n,
                                        .x = {place[0], place[1], place[2]},
                                        .m = volume,
                                        .h_inverse = h_inverse,
                                        .sum_m = out[0],
                                        .sum_m_dh = out[1]};
    for (size_t i = 0; i < n; i++) h_inverse[i] = 1 / width[i];
    struct cells *cells = cells_create(&method, n / 3);
    if (!cells) return error_set(error, STATUS_ENVIRONMENT, "no memory");
    const enum status status = cells_arrange(cells, &fields, width, NULL, error);
    struct error later;
    if (status == STATUS_ENVIRONMENT) /* a call that is repeated with memory succeeds */
        assert_int_equal(cells_arrange(cells, &fields, width, NULL, &later), STATUS_OK);
    cells_density(cells, &fields);
    for (size_t i = 0; i < n; i++) assert_true(isfinite(out[0][i]) && out[0][i] > 0);
    cells_destroy(cells);
    return status;
}

/* The first steps of a simulation, with a scheme that needs every array, or few. */
static enum status flow(int dim, const struct scheme *scheme, enum boundary ends,
                        struct error *error)
{
    struct setup setup = lattice_of(dim, dim == 2 ? 8 : 6, 0, scheme);
    setup.boundary[1] = ends;
    setup.skip = true;
    for (int a = 0; a < dim; a++) v[a][0] = 0.01;
    struct simulation *simulation;
    enum status status = simulation_create(&setup, &simulation, error);
    if (status) return status;
    status = simulation_run(simulation, 0.02, NULL, NULL, error);
    struct conservation sums;
    conservation_sums(simulation, &sums);
    if (!status) assert_true(isfinite(sums.energy) && sums.energy > 0);
    simulation_destroy(simulation);
    return status;
}

static enum status flow_of_all(int dim, size_t n, struct error *error)
{
    struct scheme scheme = plain_scheme();
    scheme.gradient = GRADIENT_BLENDED;
    scheme.viscosity = VISCOSITY_CULLEN_DEHNEN;
    scheme.balsara = BALSARA_ON;
    scheme.volume_element = VOLUME_ENERGY;
    scheme.formulation = FORMULATION_LAGRANGIAN;
    scheme.energy = ENERGY_TOTAL;
    (void)n; /* the lattice decides the number */
    return flow(dim, &scheme, BOUNDARY_FIXED, error);
}

static enum status flow_of_little(int dim, size_t n, struct error *error)
{
    struct scheme scheme = plain_scheme();
    scheme.viscosity = VISCOSITY_PROJECTED;
    scheme.noise = 0.4;
    (void)n;
    return flow(dim, &scheme, BOUNDARY_REFLECTING, error);
}

/* Refuses every call for memory in turn. Returns how many calls there are. */
static long refused_in_turn(work *doing, int dim, size_t n)
{
    for (long refuse = 1;; refuse++) {
        struct error error = {0};
        watched_begin(refuse);
        const enum status status = doing(dim, n, &error);
        const long live = watched_live, broken = watched_broken, calls = watched_calls;
        if (live || broken)
            fail_msg("call %ld in %d dimensions refused: %ld blocks kept, %ld overrun", refuse, dim,
                     live, broken);
        if (calls < refuse) {
            if (status) fail_msg("%s", error.message);
            return calls;
        }
        if (status != STATUS_ENVIRONMENT)
            fail_msg("call %ld in %d dimensions: '%s'", refuse, dim, error.message);
        assert_non_null(strstr(error.message, "no memory"));
    }
}

TEST(every_allocation_fails_once)
{
    static const struct {
        work *doing;
        int least_dim;
        size_t n;
        long least, most; /* bounds of calls; few if capacity is left */
    } all[] = {{find, 1, 90, 8, 45},
               {differentiate, 1, 60, 105, 160},
               {differentiate_clump, 1, 200, 25, 45},
               {differentiate_all, 1, 128, 24, 26},
               {far_away, 1, 60, 130, 210},
               {weigh, 1, 60, 15, 25},
               {flow_of_all, 2, 0, 20, 99},
               {flow_of_little, 2, 0, 20, 99},
               {list, 2, 90, 20, 30},
               {arrange, 2, 90, 20, 70}};
    for (size_t k = 0; k < sizeof all / sizeof *all; k++)
        for (int dim = all[k].least_dim; dim <= 3; dim++) {
            make(POINTS_MAX, 0.3, 1);
            const long calls = refused_in_turn(all[k].doing, dim, all[k].n);
            if (calls < all[k].least || calls > all[k].most)
                fail_msg("%zu in %d dimensions: %ld calls", k, dim, calls);
        }
}

/* For any number of points, from zero: no access goes beyond an array. */
TEST(no_access_beyond_arrays)
{
    static work *const all[] = {find, differentiate, differentiate_all, weigh, list, arrange};
    for (size_t k = 0; k < sizeof all / sizeof *all; k++)
        for (int dim = all[k] == list || all[k] == arrange ? 2 : 1; dim <= 3; dim++)
            for (size_t n = all[k] == list      ? 3
                            : all[k] == arrange ? 1
                                                : 0;
                 n < 140; n = n < 20 ? n + 1 : n + 12) {
                struct error error = {0};
                make(n, 0.45, 1);
                watched_begin(0);
                const enum status status = all[k](dim, n, &error);
                if (status && !(all[k] == weigh && status == STATUS_BROKE_DOWN))
                    fail_msg("%s", error.message);
                assert_int_equal(watched_live, 0);
                assert_int_equal(watched_broken, 0);
            }
}

static struct grid_box open_box(int dim)
{
    return (struct grid_box){dim, {0}, {1, 1, 1}, {false}};
}

/* All n points at one position, within each other's reach. Returns the calls for memory of a
 * search. */
static long search_together(struct grid *grid, size_t n)
{
    const double *const at[] = {place[0], place[1], place[2]};
    const long before = watched_calls;
    for (size_t i = 0; i < n; i++)
        for (int a = 0; a < 3; a++) place[a][i] = 0.5, width[i] = 0.3;
    assert_int_equal(grid_search(grid, n, n, at, width, NULL, NULL), STATUS_OK);
    return watched_calls - before;
}

/* Likewise, with points in `cells` cells along the last axis. */
static long search_in_cells(struct grid *grid, int dim, int cells)
{
    const size_t n = 200;
    const double *const at[] = {place[0], place[1], place[2]};
    const long before = watched_calls;
    for (size_t i = 0; i < n; i++)
        place[dim - 1][i] = (double)i / (double)(n - 1), width[i] = 1 / (cells + 0.5);
    assert_int_equal(grid_search(grid, n, n, at, width, NULL, NULL), STATUS_OK);
    return watched_calls - before;
}

static long reserve(const struct grid *grid, struct grid_reader *reader)
{
    const long before = watched_calls;
    assert_true(grid_reader_reserve(grid, reader));
    return watched_calls - before;
}

/* Entries up to the capacity need no call for memory; one more needs a call for each array that is
 * full, and leaves spare capacity. */
TEST(capacity_of_grids)
{
    for (int dim = 2; dim <= 3; dim++) {
        const struct grid_box box = open_box(dim);
        static const struct {
            size_t n;
            long calls;
        } points[] = {{188, 0}, {189, 10}, {299, 0}, {300, 10}},
          reader[] = {{9, 2}, {17, 0}, {34, 2}, {59, 0}, {60, 1}, {97, 1}},
          other[] = {{17, 2}, {33, 0}, {34, 2}, {49, 0}, {73, 2}, {105, 0}};
        watched_begin(0);
        struct grid *grid = grid_create(&box, 100, 1);
        search_together(grid, 150);
        for (int k = 0; k < 4; k++)
            assert_int_equal(search_together(grid, points[k].n), points[k].calls);
        struct grid_reader readers[2] = {{0}, {0}};
        for (int k = 0; k < 6; k++) {
            search_together(grid, reader[k].n);
            assert_int_equal(reserve(grid, &readers[0]), reader[k].calls);
            search_together(grid, other[k].n);
            assert_int_equal(reserve(grid, &readers[1]), other[k].calls);
        }
        for (int k = 0; k < 2; k++) grid_reader_free(&readers[k]);
        grid_destroy(grid);
        grid = grid_create(&box, 1000, 1);
        search_together(grid, 150);
        assert_int_equal(search_together(grid, 448), 0);
        assert_int_equal(search_together(grid, 449), 1);
        search_in_cells(grid, dim, 10);
        assert_int_equal(search_in_cells(grid, dim, 20), 0);
        assert_int_equal(search_in_cells(grid, dim, 21), 7);
        grid_destroy(grid);
        assert_int_equal(watched_live, 0);
    }
}

static long arrange_together(struct cells *cells, size_t n)
{
    const struct cells_fields fields = {.n = n, .x = {place[0], place[1], place[2]}};
    const long before = watched_calls;
    for (size_t i = 0; i < n; i++)
        for (int a = 0; a < 3; a++) place[a][i] = 0.5, width[i] = 0.3;
    assert_int_equal(cells_arrange(cells, &fields, width, NULL, NULL), STATUS_OK);
    return watched_calls - before;
}

TEST(capacity_of_cells)
{
    static const struct {
        size_t n;
        long calls;
    } steps[] = {{132, 0}, {133, 2}, {173, 0}, {174, 2}, {185, 0}, {195, 14}};
    for (int dim = 2; dim <= 3; dim++) {
        struct cells_method method = {.box = open_box(dim), .kernel = &kernel, .threads = 1};
        watched_begin(0);
        struct cells *cells = cells_create(&method, 100);
        arrange_together(cells, 120);
        for (size_t k = 0; k < sizeof steps / sizeof *steps; k++)
            assert_int_equal(arrange_together(cells, steps[k].n), steps[k].calls);
        cells_destroy(cells);
        method.wall[1] = true; /* images have capacity of their own */
        cells = cells_create(&method, 400);
        arrange_together(cells, 100);
        assert_int_equal(arrange_together(cells, 150), 0);
        assert_int_equal(arrange_together(cells, 151), 6);
        cells_destroy(cells);
        assert_int_equal(watched_live, 0);
    }
}

/* Operators use unspecialised loops on request: they are the reference for the specialised ones. */
static bool specialised_asked;
struct shapes __real_shapes_of(const struct kernel *of, int dim, bool specialised);
struct shapes __wrap_shapes_of(const struct kernel *of, int dim, bool specialised);
struct shapes __wrap_shapes_of(const struct kernel *of, int dim, bool specialised)
{
    specialised_asked = specialised;
    return __real_shapes_of(of, dim, specialised);
}

TEST(unspecialised_loops_on_request)
{
    const struct cloud cloud = {points_of(2, 30, false), volume, width};
    make(30, 0.45, 1);
    for (int generic = 0; generic < 2; generic++) {
        const struct operator_settings settings = {
            (const struct operator_form *)operator_family.members[0], &kernel, generic, 1};
        assert_int_equal(operator_apply(&settings, &cloud, 0, NULL, NULL, NULL, NULL, NULL),
                         STATUS_OK);
        assert_int_equal(specialised_asked, !generic);
    }
}

static int select_kernel(void **state)
{
    (void)state;
    return kernel_select(&kernel, "cubic_spline", 5, NULL) != STATUS_OK;
}

TEST_BETWEEN(select_kernel, NULL);
