/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "loops.h"

#include "specialise.h"

void loops_choose(const struct plan *plan, const struct scheme *scheme, struct loops *loops)
{
    const int kernel = plan->specialised ? kernel_specialisation(&scheme->kernel) : -1;
    *loops = (struct loops){
        .kernel = &scheme->kernel,
        .formulation = scheme->formulation,
        .viscosity = scheme->viscosity,
        .energy = scheme->energy,
        .energy_element = plan->energy_sum,
        .div_v = plan->alpha,
        .numbers = {.alpha = scheme->alpha,
                    .beta = scheme->beta,
                    .beta_ratio = !plan->alpha        ? 0
                                  : scheme->alpha > 0 ? scheme->beta / scheme->alpha
                                                      : 2,
                    .near = 1 / scheme->eta},
    };
    loops->density = loop_density(kernel, plan->energy_sum ? DENSITY_ENERGY : DENSITY_MASS);
    if (plan->matrix || plan->slope)
        loops->matrix = loop_matrix(kernel, scheme->gradient, plan->slope);
    if (plan->matrix) loops->matrix_receding = loop_matrix(kernel, scheme->gradient, false);
    loops->gradient = loop_gradient(kernel, scheme->gradient,
                                    plan->grad_h ? PAIR_WIDTH_OWN : (int)scheme->pair_width);
    loops->force = loop_force(kernel >= 0, scheme->formulation, loops->viscosity, scheme->energy);
    loops->force_receding = loop_force(true, scheme->formulation, VISCOSITY_NONE, scheme->energy);
}

void loops_signal(const struct particles *particles, ptrdiff_t first, int len, ptrdiff_t D)
{
    const double *x = particles->x[0] + first, *v = particles->v[0] + first,
                 *c = particles->c + first, *h_inverse = particles->h_inverse + first;
    double *signal = particles->signal + first;
    for (int i = 0; i < len; i++) signal[i] = 0;
    for (ptrdiff_t d = -D; d <= D; d++) { /* d = 0: the pair with itself gives 2 c */
        const double side = d < 0 ? -1 : 1;
        for (int i = 0; i < len; i++) {
            const double r = side * (x[i + d] - x[i]), closing = side * (v[i] - v[i + d]);
            if (pair_within(r, h_inverse[i], h_inverse[i + d]))
                signal[i] = largest(signal[i], pair_signal_speed(c[i], c[i + d], closing));
        }
    }
}
