/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "judge.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "riemann.h"

/* near_end: the gas within this fraction of the tube's length from an end is tested; undisturbed:
 * the largest change that counts as none, relative to density and sound speed; far_enough: the
 * fraction of the length that sound must have travelled before the test means anything. */
static const double near_end = 0.02, undisturbed = 0.03, far_enough = 0.05;
/* No signal, reflected ones included, is faster than this times the greatest |v| + c. */
static const double safety = 1.5;

struct tube {
    struct riemann_solution main;
    double time;
    double fastest; /* the fastest signal */
};

/* NaN in a vacuum: nothing is below it, and fmin and fmax ignore it. */
static double sound(const struct riemann_solution *s, const struct riemann_state *gas)
{
    return sqrt(s->gamma * gas->P / gas->rho);
}

static double fastest_in(const struct riemann_solution *s, const struct riemann_state *gas)
{
    return fabs(gas->v) + sound(s, gas);
}

/* The fastest signal in the right gas and beside the contact: no wave between them is faster. The
 * left gas is the right one of the mirrored tube. */
static double fastest_of(const struct riemann_solution *s)
{
    const struct riemann_state left = {s->rho_star_left, s->v_star, s->p_star},
                               right = {s->rho_star_right, s->v_star, s->p_star};
    return fmax(fastest_in(s, &s->right), fmax(fastest_in(s, &left), fastest_in(s, &right)));
}

static bool solve(const struct settings *settings, struct tube *tube)
{
    struct riemann_state sides[2];
    struct riemann_solution mirror;
    const double gamma = settings_real(settings, SETTING_gamma);
    for (int side = 0; side < 2; side++) {
        const double *given = settings->value[side ? SETTING_right : SETTING_left].real;
        sides[side] = (struct riemann_state){given[0], given[1], given[2]};
    }
    tube->time = settings_real(settings, SETTING_t_end);
    if (riemann_solve(gamma, &sides[0], &sides[1], &tube->main) ||
        riemann_solve(gamma, &sides[1], &sides[0], &mirror))
        return false;
    tube->fastest = safety * fmax(fastest_of(&tube->main), fastest_of(&mirror));
    return true;
}

/* True if the gas near one end is unchanged apart from particle noise. False where there is hardly
 * any gas. */
static bool still_there(const struct judged *judged, const struct tube *tube, const double ends[2],
                        int side)
{
    const struct snapshot_file *file = &judged->file;
    const double *x = file->column[SNAPSHOT_X], *v = file->column[SNAPSHOT_VX],
                 *rho = file->column[SNAPSHOT_RHO];
    const struct riemann_state *gas = side ? &tube->main.right : &tube->main.left;
    const double reach = near_end * (ends[1] - ends[0]), c = sound(&tube->main, gas);
    double there = 0, of_v = 0, of_rho = 0;
    for (size_t i = 0; i < file->n; i++) {
        /* density is often too low at an end, where the neighbourhood is cut in half */
        const double from = fabs(x[i] - ends[side]);
        if (!(from <= 2 * reach && from >= reach / 2)) continue;
        there++, of_v += v[i] - gas->v, of_rho += rho[i] - gas->rho;
    }
    return there >= 2 && fabs(of_v) <= undisturbed * c * there &&
           fabs(of_rho) <= undisturbed * gas->rho * there;
}

bool judge_tube_ends(const struct judge_request *request, struct judged *judged,
                     const struct settings *settings, const double ends[2])
{
    struct tube tube;
    if (request->boundary) {
        snapshot_note(&judged->file.notes, "ends", request->boundary, "--boundary or the case's");
        return strcmp(request->boundary, "periodic") != 0;
    }
    if (judged->file.boundary[0] || !solve(settings, &tube)) return false;
    const struct riemann_state *l = &tube.main.left, *r = &tube.main.right;
    const double c = fmin(sound(&tube.main, l), sound(&tube.main, r));
    const bool differ = fabs(l->rho - r->rho) > 0.1 * fmax(l->rho, r->rho) ||
                        fabs(l->P - r->P) > 0.1 * fmax(l->P, r->P);
    if (!differ || !(c * tube.time > far_enough * (ends[1] - ends[0])) ||
        !still_there(judged, &tube, ends, 0) || !still_there(judged, &tube, ends, 1))
        return false;
    snapshot_note(&judged->file.notes, "ends", "open or walls",
                  "the gas at both is undisturbed: no mirrored tube begins there; --boundary says "
                  "otherwise");
    return true;
}

/* Distance from one end that waves may have reached: waves that the end excites in moving gas, and
 * waves reflected there. */
static double reached_by_waves(const struct tube *tube, double x0, const double ends[2], int side)
{
    const struct riemann_state *gas = side ? &tube->main.right : &tube->main.left;
    const double head = side ? tube->main.right_head : -tube->main.left_head;
    double arrival = head > 0 ? fabs(ends[side] - x0) / head : (double)INFINITY;
    if (!(fabs(gas->v) <= 1e-9 * sound(&tube->main, gas)) || isnan(head)) arrival = 0;
    return tube->fastest * fmax(0, tube->time - arrival);
}

enum status judge_tube_window(const struct judge_request *request, struct judged *judged,
                              const struct settings *settings, double x0, const double ends[2],
                              double window[2], double box[2], struct error *error)
{
    struct tube tube;
    char value[80];
    if (!solve(settings, &tube))
        return error_set(error, STATUS_BAD_INPUT, "%.200s: its tube has no exact solution",
                         judged->path);
    const double from[2] = {reached_by_waves(&tube, x0, ends, 0),
                            reached_by_waves(&tube, x0, ends, 1)};
    window[0] = request->window ? request->ends[0] : ends[0] + from[0];
    window[1] = request->window ? request->ends[1] : ends[1] - from[1];
    if (!(window[0] < window[1]))
        return error_set(
            error, STATUS_BAD_INPUT,
            "%.200s: at t = %g waves may have come back from the ends to everywhere in "
            "[%g, %g]; --window A:B measures all the same",
            judged->path, tube.time, ends[0], ends[1]);
    snprintf(value, sizeof value, "%.6g to %.6g", window[0], window[1]);
    snapshot_note(&judged->file.notes, "window", value, "%s",
                  request->window         ? "--window or the case's"
                  : from[0] + from[1] > 0 ? "but for what waves from the ends may have reached"
                                          : "from end to end: no wave has reached one");
    const double half = fmax(fabs(ends[0] - x0), fabs(ends[1] - x0)) +
                        fmax(fabs(window[0] - x0), fabs(window[1] - x0)) +
                        4 * tube.fastest * tube.time;
    box[0] = x0 - half, box[1] = x0 + half;
    return STATUS_OK;
}
