/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "field.h"

#define MEMBERS(...)                                                                               \
    (const struct member *const[])                                                                 \
    {                                                                                              \
        __VA_ARGS__                                                                                \
    }
#define MEMBER(name, label)                                                                        \
    &(const struct member)                                                                         \
    {                                                                                              \
        name, label, ""                                                                            \
    }

const struct family field_family = {"fields", "fields whose errors are measured",
                                    MEMBERS(MEMBER("density", "rho"), MEMBER("velocity", "v"),
                                            MEMBER("pressure", "P"),
                                            MEMBER("internal_energy", "u = P/((gamma - 1) rho)")),
                                    FIELDS};
const struct family norm_family = {
    "norms", "error norms over the measure window",
    MEMBERS(MEMBER("l1", "sum V |q - exact| / sum V"),
            MEMBER("l2", "sqrt(sum V (q - exact)^2 / sum V)"), MEMBER("linf", "max |q - exact|"),
            MEMBER("particle_mean", "sum |q - exact| / number of particles")),
    NORMS};

double domain_length(const struct domain *domain, int direction)
{
    return domain->hi[direction] - domain->lo[direction];
}

bool window_contains(const struct window *window, const double x[3])
{
    double square = 0;
    for (int d = 0; d < window->dim; d++) {
        if (!(x[d] >= window->lo[d] && x[d] <= window->hi[d])) return false;
        square += (x[d] - window->centre[d]) * (x[d] - window->centre[d]);
    }
    return window->radius == 0 || square <= window->radius * window->radius;
}

static json_t *place_json(int dim, const double x[3])
{
    json_t *place = json_array();
    for (int d = 0; d < dim; d++) json_array_append_new(place, json_real(x[d]));
    return place;
}

json_t *window_json(const struct window *window)
{
    if (window->radius > 0)
        return json_pack("{s:o, s:f}", "centre", place_json(window->dim, window->centre), "radius",
                         window->radius);
    if (window->dim == 1) return json_pack("[f, f]", window->lo[0], window->hi[0]);
    return json_pack("{s:o, s:o}", "lo", place_json(window->dim, window->lo), "hi",
                     place_json(window->dim, window->hi));
}
