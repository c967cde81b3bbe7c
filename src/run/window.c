/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "window.h"

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
