/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "start_gas.h"

#include <gsl/gsl_math.h>
#include <math.h>

/* Densities that differ by less are those of one gas. */
static const double alike = 1e-9;

size_t start_gas_of(const struct start_gas *gas, double rho)
{
    size_t k = 0;
    while (k < gas->gases && !(fabs(rho / gas->of[k].rho - 1) <= alike)) k++;
    return k;
}

double start_relative(double value, double exact)
{
    return exact > 0 ? fabs(value / exact - 1) : value > 0 ? 1 : 0;
}

double start_apart(const double v[3], const double other[3])
{
    return gsl_hypot3(v[0] - other[0], v[1] - other[1], v[2] - other[2]);
}

double start_mass(const struct start_gas *gas, double rho)
{
    const size_t k = start_gas_of(gas, rho);
    if (k < gas->gases) return gas->of[k].mass;
    return gas->volume > 0 ? rho * gas->volume : gas->mass;
}

double start_pressure(const struct start_gas *gas, size_t i)
{
    return (gas->problem->gamma - 1) * gas->snapshot->rho[i] * gas->snapshot->u[i];
}

double start_off(const struct start_gas *gas, enum start_field field, size_t i,
                 const struct problem_state *exact)
{
    const struct snapshot *s = gas->snapshot;
    double squares = 0;
    switch (field) {
    case START_VELOCITY:
        for (int d = 0; d < gas->problem->domain.dim; d++)
            squares += (s->v[d][i] - exact->v[d]) * (s->v[d][i] - exact->v[d]);
        return sqrt(squares) / gas->speed;
    case START_ENERGY:
        return start_relative(s->u[i], exact->u);
    case START_MASS:
        return fabs(s->m[i] / start_mass(gas, exact->rho) - 1);
    default:
        return start_relative(s->P[i], start_pressure(gas, i));
    }
}
