/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "sphproof/convergence.h"

#include <math.h>
#include <stdlib.h>

#include "library.h"
#include "norm.h"
#include "order.h"

enum sphproof_status sphproof_convergence_norms(size_t n, const double *volume, const double *value,
                                                const double *exact, struct sphproof_norms *norms,
                                                struct sphproof_error *error)
{
    static const double window[2] = {0, 0};
    bool any = false;
    if (n == 0) return library_fail(error, STATUS_BAD_INPUT, "norms of no values");
    for (size_t i = 0; volume && i < n; i++) {
        if (!(volume[i] >= 0) || isinf(volume[i]))
            return library_fail(error, STATUS_BAD_INPUT,
                                "volume %zu is %g: allowed: finite, 0 or more", i, volume[i]);
        any = any || volume[i] > 0;
    }
    if (volume && !any)
        return library_fail(error, STATUS_BAD_INPUT, "all volumes are 0: one must be above");
    double *room = calloc(2 * n, sizeof *room); /* positions, all in the window; equal volumes */
    if (!room) return library_fail(error, STATUS_ENVIRONMENT, "no memory for %zu values", n);
    for (size_t i = 0; i < n; i++) room[n + i] = 1;
    const struct norms found =
        norm_errors(n, room, window, volume ? volume : room + n, value, exact);
    free(room);
    *norms = (struct sphproof_norms){found.l1, found.l2, found.linf, found.particle_mean};
    return SPHPROOF_OK;
}

enum sphproof_status sphproof_convergence_order(size_t n, const double *spacing,
                                                const double *error_at,
                                                struct sphproof_order *order,
                                                struct sphproof_error *error)
{
    struct order_fit fit;
    struct error ours;
    const enum status status = order_fit(n, spacing, error_at, NULL, &fit, &ours);
    if (!status)
        *order = (struct sphproof_order){fit.order, fit.low, fit.high, fit.finest,
                                         order_class_name(fit.class)};
    return library_pass(status, &ours, error);
}

enum sphproof_status sphproof_convergence_gate(const struct sphproof_order *order,
                                               const struct sphproof_gate *gate,
                                               struct sphproof_error *error)
{
    const struct order_fit fit = {
        .order = order->order, .low = order->low, .high = order->high, .finest = order->finest};
    const struct order_gate asked = {gate->low, gate->high, gate->bound};
    char why[ORDER_GATE_TEXT];
    if (order_passes(&fit, &asked, why)) return SPHPROOF_OK;
    return library_fail(error, STATUS_CHECK_FAILED, "%s", why);
}
