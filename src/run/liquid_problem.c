/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "liquid_problem.h"

struct liquid liquid_of(const struct settings *settings)
{
    return (struct liquid){settings_real(settings, SETTING_rho0),
                           settings_real(settings, SETTING_sound)};
}

struct problem_state liquid_state(const struct liquid *liquid, double gamma)
{
    const double energy = liquid->sound * liquid->sound / (gamma * (gamma - 1));
    return (struct problem_state){
        .rho = liquid->rho0, .P = (gamma - 1) * liquid->rho0 * energy, .u = energy};
}

enum status liquid_check_gravity(struct prepared *p, const struct settings *settings,
                                 struct error *error)
{
    if (settings->value[SETTING_gravity].automatic) p->gravity[1] = -1;
    if (p->gravity[1] < 0 && p->gravity[0] == 0 && p->gravity[2] == 0) return STATUS_OK;
    return error_set(error, STATUS_BAD_INPUT,
                     "gravity=\"%g %g %g\": allowed: downwards, along y, below 0", p->gravity[0],
                     p->gravity[1], p->gravity[2]);
}

double liquid_amplitude(const struct prepared *p, const struct snapshot *s, liquid_mode *mode)
{
    double sum = 0, whole = 0;
    for (size_t i = 0; i < s->n; i++) {
        const double part = problem_window_part(p, s, i);
        double x[3], v[3], m[3] = {0};
        if (!(part > 0)) continue;
        problem_position(p, s, i, x);
        problem_velocity(p, s, i, v);
        mode(p, x, m);
        for (int d = 0; d < p->domain.dim; d++) {
            sum += part * v[d] * m[d];
            whole += part * m[d] * m[d];
        }
    }
    return sum / whole;
}
