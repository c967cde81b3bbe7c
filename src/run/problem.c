/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "problem.h"

#include <math.h>

#include "norm.h"

enum status problem_check_state(const struct settings *settings, enum setting key,
                                struct error *error)
{
    const double *state = settings->value[key].real;
    if (state[0] > 0 && state[2] > 0) return STATUS_OK;
    return error_set(error, STATUS_BAD_INPUT,
                     "%s=\"%g %g %g\": rho v P with rho > 0 and P > 0 is needed%s",
                     setting_keys[key].name, state[0], state[1], state[2],
                     state[0] == 0 ? " (particles cannot fill a vacuum)" : "");
}

enum status problem_check_square(const struct prepared *p, struct error *error)
{
    const double width = domain_length(&p->domain, 0), height = domain_length(&p->domain, 1);
    if (fabs(width - height) <= 1e-12 * width) return STATUS_OK;
    return error_set(error, STATUS_BAD_INPUT,
                     "lo, hi: the layers lie in a square box, and this one has sides of %g and %g",
                     width, height);
}

/* Position without the boost, in the box. */
static void unboosted_position(const struct prepared *p, const double x[3], double t,
                               double position[3])
{
    for (int d = 0; d < 3; d++) {
        position[d] = x[d];
        if (p->boost[d] == 0) continue;
        position[d] = domain_wrap(&p->domain, d, x[d] - p->boost[d] * t);
    }
}

void problem_sample(const struct prepared *p, const double x[3], double t,
                    struct problem_state *state)
{
    double position[3];
    unboosted_position(p, x, t, position);
    p->problem->sample(p, position, t, state);
    for (int d = 0; d < p->domain.dim; d++)
        if (p->boost[d] != 0) state->v[d] += p->boost[d];
}

void problem_sample_start(const struct prepared *p, const double x[3], struct problem_state *state)
{
    problem_sample(p, x, 0, state);
}

void problem_sample_particle(const struct prepared *p, const struct snapshot *s, size_t i,
                             struct problem_state *state)
{
    double x[3] = {0};
    for (int d = 0; d < p->domain.dim; d++) x[d] = s->x[d][i];
    problem_sample(p, x, s->time, state);
}

bool problem_knows(const struct problem *problem, enum field field)
{
    return !problem->fieldless && !problem->unknown[field];
}

double problem_field(const struct problem_state *state, enum field field)
{
    const double values[FIELDS] = {state->rho, state->v[0], state->P, state->u};
    return values[field];
}

struct field_at {
    const struct prepared *p;
    double time;
    enum field field;
};

static double field_value(const void *context, double x)
{
    const struct field_at *at = context;
    struct problem_state state;
    problem_sample(at->p, (double[3]){x}, at->time, &state);
    return problem_field(&state, at->field);
}

void problem_means(const struct prepared *p, enum field field, double t, size_t bins, double *means)
{
    const struct field_at at = {p, t, field};
    const double window[2] = {p->window.lo[0], p->window.hi[0]};
    norm_bin_means(field_value, &at, window, bins, means);
}

enum status problem_check_time(const struct prepared *p, double t, struct error *error)
{
    const struct problem *problem = p->problem;
    if (!problem->holds || problem->holds(p, t)) return STATUS_OK;
    double longest = 0, reached = t;
    for (int i = 0; i < 160; i++) { /* t is 1e30 at most */
        const double middle = 0.5 * (longest + reached);
        *(problem->holds(p, middle) ? &longest : &reached) = middle;
    }
    longest *= 1 - 1e-3; /* so that the value as printed is allowed */
    return problem->refuse(p, t, longest, error);
}

void problem_position(const struct prepared *p, const struct snapshot *s, size_t i, double x[3])
{
    double position[3];
    for (int d = 0; d < 3; d++) position[d] = d < p->domain.dim ? s->x[d][i] : 0;
    unboosted_position(p, position, s->time, x);
}

void problem_velocity(const struct prepared *p, const struct snapshot *s, size_t i, double v[3])
{
    for (int d = 0; d < 3; d++) v[d] = d < p->domain.dim ? s->v[d][i] - p->boost[d] : 0;
}

double problem_radius(const struct prepared *p, const double x[3])
{
    double square = 0;
    for (int d = 0; d < p->domain.dim; d++)
        square += (x[d] - p->window.centre[d]) * (x[d] - p->window.centre[d]);
    return sqrt(square);
}

/* Fraction of [x - side/2, x + side/2] and its images that is in the window along d. */
static double part_along(const struct prepared *p, int d, double x, double side)
{
    const double lo = p->window.lo[d], hi = p->window.hi[d];
    const bool periodic = p->boundary[d] == BOUNDARY_PERIODIC;
    double sum = 0;
    /* a particle of a wall, or above a liquid's mean surface */
    if (p->walled && !periodic && !(x >= p->domain.lo[d] && x <= p->domain.hi[d])) return 0;
    if (lo <= p->domain.lo[d] && hi >= p->domain.hi[d] && p->boundary[d] != BOUNDARY_OPEN) return 1;
    for (int image = periodic ? -1 : 0; image <= periodic; image++) {
        const double centre = x + image * domain_length(&p->domain, d);
        sum += fmax(0, fmin(centre + side / 2, hi) - fmax(centre - side / 2, lo));
    }
    return sum / side;
}

double problem_window_part(const struct prepared *p, const struct snapshot *s, size_t i)
{
    const double side = pow(s->volume[i], 1. / p->domain.dim);
    double x[3], part = s->volume[i];
    problem_position(p, s, i, x);
    for (int d = 0; d < p->domain.dim; d++) {
        if (!isfinite(x[d])) return (double)NAN; /* fmin and fmax ignore NaN */
        part *= part_along(p, d, x[d], side);
    }
    if (!(p->window.radius > 0) || !isfinite(part)) return part;
    const double inside = (p->window.radius - problem_radius(p, x)) / side + 0.5;
    return part * fmin(1, fmax(0, inside));
}

bool problem_is_circular(const struct prepared *p)
{
    return p->problem->circular && p->domain.dim > 1;
}

void problem_circular(const struct prepared *p, const double x[3], const double v[3],
                      double *azimuthal, double *radial)
{
    const double R = problem_radius(p, x);
    double away[3], out = 0, squares = 0;
    for (int d = 0; d < p->domain.dim; d++) {
        away[d] = R > 0 ? (x[d] - p->window.centre[d]) / R : 0;
        out += away[d] * v[d];
    }
    *radial = out;
    /* not |v|^2 - out^2, since its round-off gives a root of 1e-8 |v| */
    for (int d = 0; d < p->domain.dim; d++)
        squares += (v[d] - out * away[d]) * (v[d] - out * away[d]);
    const double dx = x[0] - p->window.centre[0], dy = x[1] - p->window.centre[1];
    if (p->domain.dim == 2)
        *azimuthal = R > 0 ? (dx * v[1] - dy * v[0]) / R : 0;
    else
        *azimuthal = sqrt(squares);
}

enum status problem_direction(const struct prepared *p, struct settings *settings, double n[3],
                              double *length, struct error *error)
{
    struct setting_value *direction = &settings->value[SETTING_direction];
    const int dim = p->domain.dim;
    double square = 0;
    if (direction->automatic) {
        direction->given = dim;
        for (int d = 0; d < dim; d++) direction->real[d] = d == 0;
    }
    for (int d = 0; d < dim; d++) {
        const double whole = settings_along(settings, SETTING_direction, d);
        if (whole != nearbyint(whole))
            return error_set(error, STATUS_BAD_INPUT,
                             "direction: %g is no integer, and the wave would not be periodic",
                             whole);
        n[d] = whole / domain_length(&p->domain, d);
        square += n[d] * n[d];
    }
    if (square == 0)
        return error_set(error, STATUS_BAD_INPUT, "direction=\"0\": the wave runs nowhere");
    for (int d = 0; d < dim; d++) n[d] /= sqrt(square);
    *length = 1 / sqrt(square);
    return STATUS_OK;
}
