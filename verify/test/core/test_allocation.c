/* SPDX-License-Identifier: GPL-3.0-or-later
 * Tests that no memory is allocated or freed while a simulation steps. The linker's --wrap
 * redirects all such calls of the project, and simulation_run, to this file, which counts those
 * inside of simulation_run. */
#include "test.h"

#include <stdatomic.h>

#include "keyed.h"

static atomic_bool stepping;
static atomic_int calls;

static void count(void)
{
    if (stepping) calls++;
}

/* WRAP(type, name, parameters, arguments) defines the function that the linker calls in place of
 * name. */
#define WRAP(type, name, parameters, arguments)                                                    \
    type __real_##name parameters;                                                                 \
    type __wrap_##name parameters;                                                                 \
    type __wrap_##name parameters                                                                  \
    {                                                                                              \
        count();                                                                                   \
        return __real_##name arguments;                                                            \
    }
WRAP(void *, malloc, (size_t size), (size))
WRAP(void *, calloc, (size_t n, size_t size), (n, size))
WRAP(void *, realloc, (void *memory, size_t size), (memory, size))
WRAP(void *, aligned_alloc, (size_t alignment, size_t size), (alignment, size))

void __real_free(void *memory);
void __wrap_free(void *memory);
void __wrap_free(void *memory)
{
    count();
    __real_free(memory);
}

enum status __real_simulation_run(struct simulation *simulation, double t_end,
                                  simulation_progress *progress, void *context,
                                  struct error *error);
enum status __wrap_simulation_run(struct simulation *simulation, double t_end,
                                  simulation_progress *progress, void *context,
                                  struct error *error);
enum status __wrap_simulation_run(struct simulation *simulation, double t_end,
                                  simulation_progress *progress, void *context, struct error *error)
{
    stepping = true;
    const enum status status = __real_simulation_run(simulation, t_end, progress, context, error);
    stepping = false;
    return status;
}

/* Calls for memory while a case with these keys (words, separated by spaces) steps. */
static int calls_in(const char *case_name, const char *keys, int threads,
                    simulation_progress *progress)
{
    struct run run = keyed_run(case_name, keys);
    struct run_result result;
    struct error error;
    run.asked.threads = threads;
    run.asked.progress = progress;
    calls = 0;
    const enum status status = run_execute(&run, &result, &error);
    /* cold gas that collides: some schemes break down early */
    if (status && status != STATUS_BROKE_DOWN)
        fail_msg("%s %s: %s", case_name, keys, error.message);
    assert_true(result.cost.steps > 0);
    run_free(&result);
    return calls;
}

/* A progress report that allocates memory. */
static bool waste(void *context, double time, uint64_t steps)
{
    (void)context, (void)time, (void)steps;
    char *volatile memory = malloc(100);
    free(memory);
    return true;
}

TEST(allocations_are_counted)
{
    if (calls_in("sod", "n=200", 1, waste) < 2) {
        print_message("this linker does not wrap: allocations cannot be counted here\n");
        skip();
    }
}

TEST(no_calls)
{
    static const char *const schemes[] = {
        "",
        "skip=none lattice=clustered jitter=0.3",
        "kernel=cubic_spline gradient=ia viscosity=reconstructed",
        "kernel=cubic_spline eta=4.8 integrator=modified_leapfrog",
        "kernel=quintic_spline eta=6 integrator=rk3 formulation=lagrangian volume_element=energy",
        "kernel=wendland_c6 eta=16 integrator=vl2 viscosity=time_dependent gradient=ia",
    };
    for (const struct case_builtin *file = case_builtins; file->name; file++)
        for (size_t s = 0; s < sizeof schemes / sizeof *schemes; s++) {
            char keys[256] = "n=100 ";
            struct case_file of;
            struct error error;
            if (case_load(&of, file->name, &error)) fail_msg("%s", error.message);
            if (of.dimension > 1) continue; /* lists of neighbours may grow */
            strcat(keys, schemes[s]);
            if (calls_in(file->name, keys, 1, NULL))
                fail_msg("%s %s: %d calls of malloc, calloc, realloc, aligned_alloc or free",
                         file->name, keys, calls);
        }
    assert_int_equal(calls_in("sod", "n=3000 t_end=0.01 skip=none", 2, NULL), 0);
}

/* Widths of half the box, whose neighbours are images of images: memory is extended rarely. */
TEST(memory_is_extended_rarely)
{
    const int found = calls_in("two_rarefactions", "n=100 kernel=cubic_spline eta=40", 1, NULL);
    assert_in_range(found, 0, 8);
}

/* In 2D and 3D lists of neighbours may grow by half of their first length without a call for
 * memory. */
TEST(no_calls_in_2d_and_3d)
{
    static const char *const flows[][2] = {
        {"gresho", "n=16^2 t_end=0.1"},
        {"gresho", "n=16^2 t_end=0.05 viscosity=cullen_dehnen h_method=newton"},
        {"rest_3d", "n=8^3 t_end=0.05 kernel=cubic_spline eta=2.4 gradient=standard"},
        {"sod_2d", "n=1000 t_end=0.1"},
        {"square", "n=20^2 t_end=0.1"},
    };
    for (size_t k = 0; k < sizeof flows / sizeof *flows; k++)
        for (int threads = 1; threads <= 2; threads++) {
            const int found = calls_in(flows[k][0], flows[k][1], threads, NULL);
            /* a second thread may compute its first share of a pass late */
            if (found > (threads == 1 ? 0 : 12))
                fail_msg("%s %s, %d threads: %d calls", flows[k][0], flows[k][1], threads, found);
        }
}
