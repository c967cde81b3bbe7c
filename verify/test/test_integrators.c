/* SPDX-License-Identifier: GPL-3.0-or-later
 * What integrators say of themselves: those that keep the start of a step, and no others, write to
 * the arrays that an estimate of memory counts for them. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#include "hydro_scene.h"
#include "solver.h"

static bool is_used(const double *array, ptrdiff_t n)
{
    for (ptrdiff_t i = 0; i < n; i++)
        if (array[i] != 0) return true;
    return false;
}

static void test_start_of_a_step(void **state)
{
    (void)state;
    size_t keep = 0;
    for (size_t k = 0; k < integrator_family.n; k++) {
        static struct hydro_state start;
        struct scheme scheme = hydro_scheme();
        struct simulation *simulation = NULL;
        struct error error;
        hydro_disordered(&start, 100);
        scheme.integrator = hydro_integrator(integrator_family.members[k]->name);
        const struct scene scene = hydro_scene(&start, &scheme);
        assert_int_equal(simulation_create(&scene, &simulation, &error), STATUS_OK);
        assert_int_equal(simulation_run(simulation, 1e-3, NULL, NULL, &error), STATUS_OK);
        const struct particles *a = &simulation->particles;
        assert_int_equal(is_used(a->p_old[0], a->n), scheme.integrator->keeps_start);
        assert_int_equal(is_used(a->e_old, a->n), scheme.integrator->keeps_start);
        keep += scheme.integrator->keeps_start;
        simulation_destroy(simulation);
    }
    assert_in_range(keep, 1, integrator_family.n - 1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_start_of_a_step)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
