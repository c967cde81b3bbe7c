/* SPDX-License-Identifier: GPL-3.0-or-later
 * Tests the public library through its own headers: right kernels, gradients and settings pass, and
 * wrong ones are refused with a message that names the fault. */
#include "test.h"

#include <dirent.h>

#include "sphproof/convergence.h"
#include "sphproof/gradients.h"
#include "sphproof/rates.h"

/* ---- kernels ---- */

static double slope = 1; /* 1: the correct derivative */

/* Epanechnikov's parabola to the third power, which has a smooth edge: (1 - q^2)^3. */
static double bump(double q, int dim)
{
    const double a = 1 - q * q;
    (void)dim;
    return q < 1 ? a * a * a : 0;
}

static double bump_slope(double q, int dim)
{
    const double a = 1 - q * q;
    (void)dim;
    return q < 1 ? -6 * slope * q * a * a : 0;
}

static const struct sphproof_shape shape = {.w = bump,
                                            .dw = bump_slope,
                                            .constant = {0, 35. / 32},
                                            .knot_count = 0,
                                            .smoothness = 2,
                                            .name = "bump",
                                            .dim = 1};

struct seen {
    int figures, failed;
    char first[32]; /* name of the first that fails */
};

static void see(void *context, const struct sphproof_figure *figure)
{
    struct seen *seen = context;
    assert_non_null(figure->formula);
    seen->figures++;
    if (!figure->passed && !seen->failed++)
        snprintf(seen->first, sizeof seen->first, "%s", figure->property);
}

TEST(version)
{
    int numbers[3], end = 0;
    const char *version = sphproof_version();
    assert_int_equal(sscanf(version, "%d.%d.%d%n", &numbers[0], &numbers[1], &numbers[2], &end), 3);
    assert_int_equal(version[end], '\0');
}

TEST(user_kernel_is_certified)
{
    struct sphproof_kernel *kernel;
    struct sphproof_error error;
    struct seen seen = {0};
    slope = 1;
    assert_int_equal(sphproof_kernels_own(&shape, &kernel, &error), SPHPROOF_OK);
    assert_true(fabs(sphproof_kernels_value(kernel, 0.5, 2, 1) - 35. / 64 * bump(0.25, 1)) < 1e-15);
    assert_int_equal(sphproof_kernels_certify(kernel, 1, see, &seen, &error), SPHPROOF_OK);
    assert_true(seen.figures >= 15 && seen.failed == 0);
    assert_int_equal(sphproof_kernels_certify(kernel, 2, see, &seen, &error), SPHPROOF_BAD_INPUT);
    slope = 1 + 1e-7;
    seen = (struct seen){0};
    assert_int_equal(sphproof_kernels_certify(kernel, 1, see, &seen, &error),
                     SPHPROOF_CHECK_FAILED);
    assert_true(seen.failed > 0);
    assert_int_equal(error.status, SPHPROOF_CHECK_FAILED);
    assert_memory_equal(error.message, seen.first, strlen(seen.first));
    assert_int_equal(sphproof_kernels_certify(kernel, 1, NULL, NULL, NULL), SPHPROOF_CHECK_FAILED);
    sphproof_kernels_free(kernel);
    slope = 1;
}

/* ---- gradients ---- */

enum fault { RIGHT, FORGETFUL };

struct own {
    const char *name;
    const struct sphproof_kernel *kernel;
    enum fault fault;
    int calls;
};

static bool gradients(void *context, const struct sphproof_cloud *cloud, const double *f,
                      double *const gradient[])
{
    struct own *own = context;
    struct sphproof_error error;
    own->calls++;
    if (sphproof_gradients_apply(own->name, own->kernel, cloud, f, gradient, &error)) return false;
    for (int a = 0; a < cloud->dim; a++)
        for (size_t i = 0; i < cloud->n; i++) {
            if (own->fault == FORGETFUL) gradient[a][i] *= 1 + 1e-12 * own->calls;
        }
    return true;
}

static int tried(const char *name, enum fault fault, int dim,
                 struct sphproof_gradient_promise promise, struct sphproof_error *error)
{
    struct sphproof_kernel *kernel;
    assert_int_equal(sphproof_kernels_find("wendland_c4", &kernel, NULL), SPHPROOF_OK);
    struct own own = {name, kernel, fault, 0};
    const int status =
        (int)sphproof_gradients_check(gradients, &own, dim, &promise, NULL, NULL, error);
    sphproof_kernels_free(kernel);
    return status;
}

TEST(an_operator_is_held_to_its_promise)
{
    const struct sphproof_gradient_promise linear = {2, 0.85, 2.4, true, true, true, true},
                                           conserving = {0, -1.2, 2.4, true, true, true, true};
    struct sphproof_gradient_promise smaller = linear;
    struct sphproof_error error;
    for (int dim = 1; dim <= 2; dim++) {
        assert_int_equal(tried("linear_exact", RIGHT, dim, linear, &error), SPHPROOF_OK);
        assert_int_equal(tried("ia", RIGHT, dim, conserving, &error), SPHPROOF_OK);
        assert_int_equal(tried("corrected", RIGHT, dim, conserving, &error), SPHPROOF_OK);
    }
    assert_int_equal(tried("ia", RIGHT, 1, linear, &error), SPHPROOF_CHECK_FAILED);
    assert_non_null(strstr(error.message, "exactness: "));
    assert_non_null(strstr(error.message, ", allowed 1e-09 (1D, "));
    smaller.exact = 0;
    assert_int_equal(tried("ia", RIGHT, 1, smaller, &error), SPHPROOF_CHECK_FAILED);
    assert_non_null(strstr(error.message, "order: "));
    assert_non_null(strstr(error.message, ", allowed 0.2 (1D, "));
    assert_int_equal(tried("ia", FORGETFUL, 1, conserving, &error), SPHPROOF_CHECK_FAILED);
    assert_non_null(strstr(error.message, "repeats"));
}

/* ---- convergence ---- */

TEST(an_order_passes_its_gate)
{
    const double spacing[] = {0.1, 0.05, 0.025, 0.0125};
    const struct sphproof_gate gate = {1.8, 2.2, 1}, narrow = {2.1, 2.2, 1},
                               small = {1.8, 2.2, 1e-9};
    double at[4], exact[4] = {0};
    struct sphproof_order order;
    struct sphproof_norms norms;
    struct sphproof_error error;
    for (int l = 0; l < 4; l++) at[l] = 3 * spacing[l] * spacing[l];
    assert_int_equal(sphproof_convergence_order(4, spacing, at, &order, &error), SPHPROOF_OK);
    assert_true(fabs(order.order - 2) < 1e-12 && strcmp(order.kind, "asymptotic") == 0);
    assert_int_equal(sphproof_convergence_gate(&order, &gate, &error), SPHPROOF_OK);
    assert_int_equal(sphproof_convergence_gate(&order, &narrow, &error), SPHPROOF_CHECK_FAILED);
    assert_int_equal(sphproof_convergence_gate(&order, &small, &error), SPHPROOF_CHECK_FAILED);
    assert_int_equal(sphproof_convergence_order(3, spacing, at, &order, &error),
                     SPHPROOF_BAD_INPUT);
    assert_int_equal(sphproof_convergence_norms(4, NULL, at, exact, &norms, &error), SPHPROOF_OK);
    assert_true(norms.linf == at[0] && fabs(norms.l1 - norms.mean) < 1e-15);
    assert_int_equal(sphproof_convergence_norms(4, spacing, at, exact, &norms, &error),
                     SPHPROOF_OK);
    assert_true(norms.l1 > norms.mean); /* volumes are larger where errors are larger */
    at[2] = (double)NAN;
    assert_int_equal(sphproof_convergence_norms(4, NULL, at, exact, &norms, &error), SPHPROOF_OK);
    assert_true(isnan(norms.l1) && isnan(norms.linf));
    assert_int_equal(sphproof_convergence_norms(0, NULL, at, exact, &norms, &error),
                     SPHPROOF_BAD_INPUT);
    static const struct {
        double volume[2];
        const char *says;
    } wrong[] = {{{2, -1}, "volume 1 is -1: allowed: finite, 0 or more"},
                 {{-3, 2}, "volume 0 is -3: allowed: finite, 0 or more"},
                 {{1, (double)NAN}, "volume 1 is nan: allowed: finite, 0 or more"},
                 {{(double)INFINITY, 1}, "volume 0 is inf: allowed: finite, 0 or more"},
                 {{1, (double)INFINITY}, "volume 1 is inf: allowed: finite, 0 or more"},
                 {{0, 0}, "all volumes are 0: one must be above"}};
    const double half[] = {1, 0};
    for (int k = 0; k < 6; k++) {
        assert_int_equal(sphproof_convergence_norms(2, wrong[k].volume, at, exact, &norms, &error),
                         SPHPROOF_BAD_INPUT);
        assert_string_equal(error.message, wrong[k].says);
    }
    assert_int_equal(sphproof_convergence_norms(2, half, at, exact, &norms, &error), SPHPROOF_OK);
    assert_true(fabs(norms.l1 / at[0] - 1) < 1e-15);
}

/* ---- rates and simulations ---- */

enum { N = 64 };
static double x[N], v[N], m[N], u[N], y[N];
static const char *const keys[] = {"kernel=cubic_spline", "eta=2.4", "integrator=leapfrog",
                                   "energy=internal", NULL};

/* Particles are not in the order of their positions. */
static struct sphproof_setup setup_of_a_wave(void)
{
    for (int k = 0; k < N; k++) {
        const int i = (k * 27) % N;
        x[k] = (i + 0.5) / N, m[k] = 1. / N, u[k] = 1 + 0.1 * cos(2 * 3.14159265358979 * x[k]);
        v[k] = 0.01 * k / N, y[k] = 0.5;
    }
    return (struct sphproof_setup){.dim = 1,
                                   .n = N,
                                   .x = {x},
                                   .v = {v},
                                   .m = m,
                                   .u = u,
                                   .lo = {0},
                                   .hi = {1},
                                   .gamma = 1.4,
                                   .keys = keys};
}

TEST(a_simulation_conserves)
{
    struct sphproof_setup setup = setup_of_a_wave();
    struct sphproof_simulation *simulation;
    struct sphproof_error error;
    double place[N], rho[N];
    const struct sphproof_state wanted = {.x = {place}, .rho = rho};
    assert_int_equal(sphproof_simulations_create(&setup, &simulation, &error), SPHPROOF_OK);
    const struct sphproof_sums before = sphproof_simulations_sums(simulation);
    assert_true(sphproof_simulations_state(simulation, &wanted) == 0);
    for (int i = 0; i < N; i++) assert_true(place[i] == x[i] && fabs(rho[i] - 1) < 0.01);
    assert_int_equal(sphproof_simulations_run(simulation, 0.02, &error), SPHPROOF_OK);
    assert_true(sphproof_simulations_state(simulation, &wanted) == 0.02);
    const struct sphproof_sums after = sphproof_simulations_sums(simulation);
    assert_true(fabs(after.momentum[0] - before.momentum[0]) < 1e-14);
    assert_true(fabs(after.energy - before.energy) < 1e-6 && fabs(after.mass - 1) < 1e-14);
    sphproof_simulations_free(simulation);
    sphproof_simulations_free(NULL);
}

#ifdef __linux__
static size_t threads_of_this_process(void)
{
    size_t count = 0;
    DIR *tasks = opendir("/proc/self/task");
    for (struct dirent *task; tasks && (task = readdir(tasks));) count += task->d_name[0] != '.';
    if (tasks) closedir(tasks);
    return count;
}

/* As many threads compute as the setup says; they stay until the process ends. */
TEST(threads_of_a_simulation)
{
    struct sphproof_setup setup = setup_of_a_wave();
    struct sphproof_simulation *simulation;
    struct sphproof_error error;
    setup.dim = 2, setup.x[1] = y, setup.hi[1] = 1;
    for (int k = 0; k < N; k++) x[k] = (k % 8 + 0.5) / 8, y[k] = (k / 8 + 0.5) / 8;
    for (setup.threads = 0; setup.threads <= 3; setup.threads++) {
        assert_int_equal(sphproof_simulations_create(&setup, &simulation, &error), SPHPROOF_OK);
        assert_int_equal(sphproof_simulations_run(simulation, 0.01, &error), SPHPROOF_OK);
        assert_int_equal(threads_of_this_process(), setup.threads ? setup.threads : 1);
        sphproof_simulations_free(simulation);
    }
}
#endif

/* A run to the current time computes nothing, and a run to an earlier time is refused. */
TEST(times_of_a_simulation)
{
    const double refused[] = {-1e-300, 0.01, nextafter(0.02, 0), (double)NAN, HUGE_VAL, -HUGE_VAL};
    struct sphproof_setup setup = setup_of_a_wave();
    struct sphproof_simulation *simulation;
    struct sphproof_error error;
    double place[N], later[N], speed[N], faster[N];
    const struct sphproof_state at_first = {.x = {place}, .v = {speed}},
                                at_last = {.x = {later}, .v = {faster}};
    assert_int_equal(sphproof_simulations_create(&setup, &simulation, &error), SPHPROOF_OK);
    for (int step = 0; step < 2; step++) {
        const double time = step ? 0.02 : 0;
        assert_int_equal(sphproof_simulations_run(simulation, time, &error), SPHPROOF_OK);
        assert_true(sphproof_simulations_state(simulation, &at_first) == time);
        assert_int_equal(sphproof_simulations_run(simulation, time, &error), SPHPROOF_OK);
        for (size_t k = step ? 0 : 3; k < sizeof refused / sizeof *refused; k++)
            assert_int_equal(sphproof_simulations_run(simulation, refused[k], &error),
                             SPHPROOF_BAD_INPUT);
        assert_true(sphproof_simulations_state(simulation, &at_last) == time);
        assert_memory_equal(place, later, sizeof place);
        assert_memory_equal(speed, faster, sizeof speed);
    }
    sphproof_simulations_free(simulation);
}

/* A simulation that breaks down stays at the time of its last valid step. */
TEST(time_of_a_breakdown)
{
    static const char *const own[] = {"viscosity=none", "cfl=0.9", "energy=internal", NULL};
    struct sphproof_setup setup = setup_of_a_wave();
    struct sphproof_simulation *simulation;
    struct sphproof_error error;
    const struct sphproof_state nothing = {.rho = NULL};
    setup.keys = own;
    for (int k = 0; k < N; k++) v[k] = 1e3 * ((k * 5) % 7 - 3);
    assert_int_equal(sphproof_simulations_create(&setup, &simulation, &error), SPHPROOF_OK);
    assert_int_equal(sphproof_simulations_run(simulation, 1, &error), SPHPROOF_BROKE_DOWN);
    const double time = sphproof_simulations_state(simulation, &nothing);
    assert_true(time < 1);
    assert_int_equal(sphproof_simulations_run(simulation, 0.5 * (1 + time), &error),
                     SPHPROOF_BROKE_DOWN);
    assert_int_equal(sphproof_simulations_run(simulation, nextafter(time, -1), &error),
                     SPHPROOF_BAD_INPUT);
    sphproof_simulations_free(simulation);
}

/* Gas that fills a periodic box falls freely along each direction. */
TEST(gas_falls)
{
    for (int dim = 2; dim <= 3; dim++) {
        enum { SIDE = 10, MOST = SIDE * SIDE * SIDE };
        static double place[3][MOST], mass[MOST], energy[MOST];
        const double gravity[] = {0.25, -0.5, 0.75}, time = 0.03;
        struct sphproof_setup setup = {.dim = dim, .n = 1, .m = mass, .u = energy, .gamma = 1.4};
        struct sphproof_simulation *simulation;
        struct sphproof_error error;
        for (int a = 0; a < dim; a++) {
            setup.x[a] = place[a], setup.hi[a] = 1, setup.gravity[a] = gravity[a];
            setup.n *= SIDE;
        }
        for (size_t i = 0; i < setup.n; i++) {
            const size_t cell[] = {i % SIDE, i / SIDE % SIDE, i / SIDE / SIDE};
            for (int a = 0; a < dim; a++) place[a][i] = ((double)cell[a] + 0.5) / SIDE;
            mass[i] = 1. / (double)setup.n, energy[i] = 1;
        }
        if (sphproof_simulations_create(&setup, &simulation, &error)) fail_msg("%s", error.message);
        if (sphproof_simulations_run(simulation, time, &error)) fail_msg("%s", error.message);
        const struct sphproof_sums sums = sphproof_simulations_sums(simulation);
        for (int a = 0; a < 3; a++)
            assert_true(fabs(sums.momentum[a] - (a < dim ? time * gravity[a] : 0)) < 1e-14);
        sphproof_simulations_free(simulation);
    }
}

TEST(impossible_setups_are_refused)
{
    static const char *const unknown[] = {"kernle=ia", NULL};
    const struct sphproof_rates rates = {0};
    struct sphproof_error error;
    struct sphproof_setup setup = setup_of_a_wave();
    setup.keys = unknown;
    assert_int_equal(sphproof_rates_evaluate(&setup, &rates, &error), SPHPROOF_BAD_INPUT);
    setup = setup_of_a_wave(), setup.dim = 2;
    setup.x[1] = y, setup.v[1] = NULL, setup.hi[1] = 1, setup.boundary[1] = "reflecting";
    assert_int_equal(sphproof_rates_evaluate(&setup, &rates, &error), SPHPROOF_OK);
    setup = setup_of_a_wave(), m[3] = (double)NAN;
    assert_int_equal(sphproof_rates_evaluate(&setup, &rates, &error), SPHPROOF_BAD_INPUT);
    setup = setup_of_a_wave(), setup.gamma = 1;
    assert_int_equal(sphproof_rates_evaluate(&setup, &rates, NULL), SPHPROOF_BAD_INPUT);
}
