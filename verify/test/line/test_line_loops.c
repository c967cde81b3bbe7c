/* SPDX-License-Identifier: GPL-3.0-or-later
 * Tests which loops in 1D a plan and a scheme select. The checks hydro/rates and hydro/specialised
 * compare the sums themselves. */
#include "test.h"

#include "line/loops.h"

static struct kernel kernel_of(size_t k)
{
    struct kernel kernel;
    struct error error;
    if (kernel_select(&kernel, kernel_family.members[k]->name, 6, &error))
        fail_msg("%s", error.message);
    return kernel;
}

TEST(chosen_by_plan_and_scheme)
{
    for (size_t k = 0; k < kernel_family.n; k++)
        for (int way = 0; way < 128; way++) {
            const struct plan plan = {.specialised = way & 1,
                                      .energy_sum = way & 2,
                                      .matrix = way & 4,
                                      .slope = way & 8,
                                      .grad_h = way & 16,
                                      .alpha = way & 32};
            const struct scheme scheme = {.kernel = kernel_of(k),
                                          .gradient = way & 64 ? GRADIENT_IA : GRADIENT_STANDARD,
                                          .formulation = FORMULATION_LAGRANGIAN,
                                          .viscosity = VISCOSITY_FADING,
                                          .energy = ENERGY_TOTAL,
                                          .pair_width = PAIR_WIDTH_MAX,
                                          .alpha = way & 64 ? 0 : 0.5,
                                          .beta = 1.25,
                                          .eta = 1.6};
            const int specialisation = way & 1 ? (int)k : -1;
            struct loops loops;
            loops_choose(&plan, &scheme, &loops);
            assert_true(loops.kernel == &scheme.kernel);
            assert_int_equal(loops.formulation, FORMULATION_LAGRANGIAN);
            assert_int_equal(loops.viscosity, VISCOSITY_FADING);
            assert_int_equal(loops.energy, ENERGY_TOTAL);
            assert_true(loops.energy_element == plan.energy_sum && loops.div_v == plan.alpha);
            assert_true(loops.numbers.alpha == scheme.alpha && loops.numbers.beta == 1.25);
            assert_true(loops.numbers.near == 1 / 1.6);
            assert_true(loops.numbers.beta_ratio == (!plan.alpha ? 0 : way & 64 ? 2 : 2.5));
            assert_true(loops.density ==
                        loop_density(specialisation, way & 2 ? DENSITY_ENERGY : DENSITY_MASS));
            matrix_loop *const matrices_of[] = {NULL,
                                                loop_matrix(specialisation, scheme.gradient, false),
                                                loop_matrix(specialisation, scheme.gradient, true),
                                                loop_matrix(specialisation, scheme.gradient, true)};
            assert_true(loops.matrix == matrices_of[way / 4 % 4]);
            assert_true(loops.gradient ==
                        loop_gradient(specialisation, scheme.gradient,
                                      plan.grad_h ? PAIR_WIDTH_OWN : (int)PAIR_WIDTH_MAX));
            assert_true(loops.force == loop_force(way & 1, FORMULATION_LAGRANGIAN, VISCOSITY_FADING,
                                                  ENERGY_TOTAL));
        }
}
