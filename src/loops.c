/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "loops.h"

#include "loop.h"

void loops_choose(const struct scheme *scheme, bool stamped, struct loops *loops)
{
    const int kernel = stamped ? kernel_stamp(&scheme->kernel) : -1;
    const bool grad_h = scheme->formulation == FORMULATION_LAGRANGIAN;
    const bool energy_element = scheme->volume_element == VOLUME_ENERGY;
    const bool reconstruct = scheme->viscosity == VISCOSITY_RECONSTRUCTED;
    const bool varies = scheme->viscosity == VISCOSITY_TIME_DEPENDENT;
    *loops = (struct loops){
        .kernel = &scheme->kernel,
        .formulation = scheme->formulation,
        .viscosity = scheme->viscosity,
        .energy = scheme->energy,
        .energy_element = energy_element,
        .want_div_v = varies,
        .numbers = {.alpha = scheme->alpha,
                    .beta = scheme->beta,
                    .beta_ratio = !varies             ? 0
                                  : scheme->alpha > 0 ? scheme->beta / scheme->alpha
                                                      : 2,
                    .near = 1 / scheme->eta},
    };
    loops->density_newton =
        loop_density(kernel, energy_element ? DENSITY_ENERGY : DENSITY_DERIVATIVE);
    loops->density = energy_element || grad_h || scheme->h_method == H_CORRECTED
                         ? loops->density_newton
                         : loop_density(kernel, DENSITY_VALUE);
    if (scheme->gradient == GRADIENT_IA)
        loops->matrix = loop_matrix(kernel, reconstruct ? MATRIX_BOTH : MATRIX_MOMENT);
    else if (reconstruct)
        loops->matrix = loop_matrix(kernel, MATRIX_SLOPE);
    loops->gradient =
        loop_gradient(kernel, scheme->gradient, grad_h ? PAIR_WIDTH_OWN : (int)scheme->pair_width);
    loops->force = loop_force(kernel >= 0, scheme->formulation, loops->viscosity, scheme->energy);
}

void loops_signal(const struct particles *particles, ptrdiff_t first, int len, ptrdiff_t D)
{
    const double *x = particles->x + first, *v = particles->v + first, *c = particles->c + first,
                 *h = particles->h + first;
    double *signal = particles->signal + first;
    for (int i = 0; i < len; i++) signal[i] = 2 * c[i];
    for (ptrdiff_t d = 1; d <= D; d++)
        for (int i = 0; i < len; i++) {
            const double right = pair_signal_speed(c[i], c[i + d], v[i] - v[i + d]);
            const double left = pair_signal_speed(c[i], c[i - d], v[i - d] - v[i]);
            if (x[i + d] - x[i] < largest(h[i], h[i + d])) signal[i] = largest(signal[i], right);
            if (x[i] - x[i - d] < largest(h[i], h[i - d])) signal[i] = largest(signal[i], left);
        }
}
