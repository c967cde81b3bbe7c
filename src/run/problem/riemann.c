/* SPDX-License-Identifier: GPL-3.0-or-later
 * Two uniform gases that meet in the middle of the box (Toro 2009, ch. 4). At the ends of a
 * periodic box a mirrored tube starts; walls produce waves in moving gas and reflect waves that
 * reach them. The window must be free of both. In 1D particles have equal masses, cell-centred on
 * each side, or are graded towards the jumps; in 2D and 3D each gas has its own lattice with a
 * spacing for equal masses. */
#include "riemann.h"

#include <math.h>

#include "functional.h"
#include "initial.h"
#include "lattice.h"
#include "problem.h"

struct tube {
    double x0; /* initial position of the contact */
    struct riemann_solution main;
    struct riemann_solution ends[2]; /* solutions at the left and the right end */
    double returning[2]; /* Mach numbers of waves reflected by walls; see find_returning() */
};
PROBLEM_OWN(tube)

static enum status solve(struct riemann_solution *solution, double gamma, const double *left,
                         const double *right, struct error *error)
{
    const struct riemann_state l = {left[0], left[1], left[2]}, r = {right[0], right[1], right[2]};
    const char *fault = riemann_solve(gamma, &l, &r, solution);
    return fault ? error_set(error, STATUS_BAD_INPUT, "no exact solution: %s", fault) : STATUS_OK;
}

/* Mass of the right over the left particles that makes the spacings equal on both sides of the
 * contact. Limited, since beyond the limits one side is resolved at the cost of the other (measured
 * on sod, sod_standard, lax and strong_shock). The limits are reciprocal so that a mirrored tube is
 * the same problem. */
static double mass_ratio_at_contact(const struct riemann_solution *tube)
{
    if (tube->vacuum) return 1;
    const double most = 1.5;
    return fmin(fmax(tube->rho_star_right / tube->rho_star_left, 1 / most), most);
}

/* Solution at a wall on one side: the state meets its mirror image. */
static enum status solve_wall(struct riemann_solution *solution, double gamma, int side,
                              const double *state, struct error *error)
{
    const double image[3] = {state[0], -state[1], state[2]};
    return side ? solve(solution, gamma, state, image, error)
                : solve(solution, gamma, image, state, error);
}

/* Mach number of the reflected wave relative to the gas behind the main tube's wave: a shock is
 * reflected as a shock, anything else as sound. */
static enum status find_returning(struct tube *tube, double gamma, int side, struct error *error)
{
    const struct riemann_solution *main = &tube->main;
    const bool shock = (side ? main->right_wave : main->left_wave) == RIEMANN_SHOCK;
    const double rho = side ? main->rho_star_right : main->rho_star_left;
    const double state[3] = {rho, main->v_star, main->p_star};
    struct riemann_solution back;
    tube->returning[side] = 1;
    if (!shock) return STATUS_OK;
    if (solve_wall(&back, gamma, side, state, error)) return error->status;
    const double head = side ? -back.left_head : back.right_head;
    const double along = side ? -main->v_star : main->v_star;
    if (!isnan(head))
        tube->returning[side] = fmax(1, (head - along) / sqrt(gamma * main->p_star / rho));
    return STATUS_OK;
}

static bool has_walls(const struct prepared *p)
{
    return p->boundary[0] == BOUNDARY_REFLECTING;
}

/* Solves for the waves that start at the ends. */
static enum status find_ends(struct tube *tube, const struct prepared *p, const double *left,
                             const double *right, struct error *error)
{
    for (int side = 0; side < 2; side++)
        if (has_walls(p)
                ? solve_wall(&tube->ends[side], p->gamma, side, side ? right : left, error) ||
                      find_returning(tube, p->gamma, side, error)
                : solve(&tube->ends[side], p->gamma, right, left, error))
            return error->status;
    return STATUS_OK;
}

static enum status prepare(struct prepared *p, struct settings *settings, struct error *error)
{
    struct tube *tube = (struct tube *)p->own.bytes;
    const double *left = settings->value[SETTING_left].real;
    const double *right = settings->value[SETTING_right].real;
    struct setting_value *mass_ratio = &settings->value[SETTING_mass_ratio];
    tube->x0 = p->window.centre[0];
    const double reach = 0.25 * domain_length(&p->domain, 0);
    const bool at_rest = left[1] == 0 && right[1] == 0;
    if (settings->value[SETTING_window].automatic && !(has_walls(p) && at_rest))
        p->window.lo[0] = tube->x0 - reach, p->window.hi[0] = tube->x0 + reach;
    if (problem_check_state(settings, SETTING_left, error) ||
        problem_check_state(settings, SETTING_right, error) ||
        solve(&tube->main, p->gamma, left, right, error) || find_ends(tube, p, left, right, error))
        return error->status;
    if (mass_ratio->automatic)
        mass_ratio->real[0] =
            settings_real(settings, SETTING_grade) < 1 ? mass_ratio_at_contact(&tube->main) : 1;
    return STATUS_OK;
}

static void sample(const struct prepared *p, const double x[3], double t,
                   struct problem_state *state)
{
    const struct tube *tube = tube_of(p);
    const struct riemann_state s = riemann_sample(&tube->main, x[0], tube->x0, t);
    *state = (struct problem_state){.rho = s.rho,
                                    .v = {s.rho > 0 ? s.v : (x[0] - tube->x0) / t},
                                    .P = s.P,
                                    .u = s.rho > 0 ? s.P / ((p->gamma - 1) * s.rho) : 0};
}

/* ---- particles ---- */

/* Mass of particle i of n on one side relative to ungraded particles: min(1, g q^k), where k counts
 * from the nearer jump (the main or the mirrored one). */
struct grading {
    double g, q;
};

static double grading_weight(const struct grading *grading, size_t i, size_t n)
{
    const double k = fmin((double)i, (double)(n - 1 - i));
    return fmin(1, grading->g * pow(grading->q, k)); /* q > 1: equal masses for g = 1 */
}

/* Sum of the weights of a side with n particles. */
static double grading_sum(const struct grading *grading, size_t n)
{
    double sum = 0;
    size_t k = 0;
    for (; 2 * k < n; k++) {
        const double weight = grading_weight(grading, k, n);
        if (weight == 1) break;
        sum += 2 * k + 1 == n ? weight : 2 * weight;
    }
    return sum + (2 * k < n ? (double)(n - 2 * k) : 0);
}

/* Number of particles on the left that makes the ungraded mass nearly equal on both sides; for
 * equal masses round(n rho_L/(rho_L + rho_R)). */
static size_t left_share(const struct grading *grading, size_t n, double rho_left, double rho_right)
{
    const double fraction = rho_left / (rho_left + rho_right);
    size_t lo = 1, hi = n - 1;
    if (grading->g == 1)
        lo = (size_t)fmin(fmax(round((double)n * fraction), 1), (double)(n - 1));
    else
        while (lo < hi) { /* the left side's share rises with its number */
            const size_t middle = (lo + hi) / 2;
            const double left = grading_sum(grading, middle);
            const double right = grading_sum(grading, n - middle);
            const double next_left = grading_sum(grading, middle + 1);
            const double next_right = grading_sum(grading, n - middle - 1);
            const double here = left / (left + right), next = next_left / (next_left + next_right);
            if (fabs(here - fraction) <= fabs(next - fraction))
                hi = middle;
            else
                lo = middle + 1;
        }
    return lo;
}

/* A side of uniform gas: extent, state, and n particles from index `first`. */
struct side {
    double lo, length;
    const double *state;
    size_t first, n;
};

static void fill_side(struct initial *initial, const struct side *side, double gamma,
                      const struct grading *grading)
{
    const size_t n = side->n;
    const double lo = side->lo, length = side->length, *state = side->state;
    const double unit = state[0] * length / grading_sum(grading, n);
    double edge = lo;
    for (size_t i = 0; i < n; i++) {
        const size_t at = side->first + i;
        const double mass = unit * grading_weight(grading, i, n);
        initial->m[at] = mass;
        /* equal masses: no accumulated round-off of the widths */
        initial->x[0][at] = grading->g < 1 ? edge + 0.5 * mass / state[0]
                                           : lo + ((double)i + 0.5) * (length / (double)n);
        edge += mass / state[0];
        initial->v[0][at] = state[1];
        initial->u[at] = state[2] / ((gamma - 1) * state[0]);
        initial->rho[at] = state[0];
    }
}

/* Plans a lattice of about n points in one half of the domain. */
static enum status plan_side(struct lattice_plan *plan, const struct prepared *p, bool right,
                             size_t n, enum lattice kind, struct error *error)
{
    struct domain half = p->domain;
    *(right ? &half.lo[0] : &half.hi[0]) = tube_of(p)->x0;
    return lattice_plan_make(plan, &half, kind, n, error);
}

static enum status fill_cloud(const struct prepared *p, const struct settings *settings,
                              struct initial *initial, struct error *error)
{
    const double ratio = settings_real(settings, SETTING_mass_ratio);
    const double left = settings->value[SETTING_left].real[0];
    const double right = settings->value[SETTING_right].real[0] / ratio;
    const enum lattice kind = (enum lattice)settings_choice(settings, SETTING_lattice);
    const size_t n = (size_t)settings_real(settings, SETTING_n);
    const double share = fmin(fmax(round((double)n * left / (left + right)), 1), (double)(n - 1));
    const size_t n_left = (size_t)share;
    struct lattice_plan sides[2];
    if (plan_side(&sides[0], p, false, n_left, kind, error) ||
        plan_side(&sides[1], p, true, n - n_left, kind, error) ||
        initial_allocate(initial, p->domain.dim, sides[0].n + sides[1].n, error))
        return error->status;
    if (initial_lay(initial, p, &sides[0], 0, settings, error) ||
        initial_lay(initial, p, &sides[1], sides[0].n, settings, error))
        return error->status;
    return STATUS_OK;
}

static enum status fill(const struct prepared *p, const struct settings *settings,
                        struct initial *initial, struct error *error)
{
    if (p->domain.dim > 1) return fill_cloud(p, settings, initial, error);
    const double x0 = tube_of(p)->x0, lo = p->domain.lo[0], hi = p->domain.hi[0];
    const double *left = settings->value[SETTING_left].real;
    const double *right = settings->value[SETTING_right].real;
    const struct grading grading = {settings_real(settings, SETTING_grade),
                                    settings_real(settings, SETTING_grade_ratio)};
    const size_t n = (size_t)settings_real(settings, SETTING_n);
    const size_t n_left =
        left_share(&grading, n, left[0], right[0] / settings_real(settings, SETTING_mass_ratio));
    if (initial_allocate(initial, 1, n, error)) return error->status;
    fill_side(initial, &(struct side){lo, x0 - lo, left, 0, n_left}, p->gamma, &grading);
    fill_side(initial, &(struct side){x0, hi - x0, right, n_left, n - n_left}, p->gamma, &grading);
    return STATUS_OK;
}

/* ---- how long the window stays free of the mirrored tube ---- */

/* Upper bound of the speed of a signal that enters a solution at `mach` times the sound speed: the
 * largest v + mach c over the constant states. (Beyond a vacuum, gas recedes faster than the edge
 * of the gas that expands into it.) */
static double fastest(const struct riemann_solution *s, double mach, double sign)
{
    const struct riemann_state states[] = {s->left,
                                           s->right,
                                           {s->rho_star_left, s->v_star, s->p_star},
                                           {s->rho_star_right, s->v_star, s->p_star}};
    double speed = 0;
    for (size_t i = 0; i < (s->vacuum ? 2 : 4); i++) {
        const double c = sqrt(s->gamma * states[i].P / states[i].rho);
        speed = fmax(speed, sign * states[i].v + mach * c);
    }
    return speed;
}

/* Distance that a front from an end of the box has travelled towards the middle at t; sign: its
 * direction. The bound is sharp until the front meets the waves of the main tube, and safe later. A
 * wall beside gas at rest emits no front until those waves reach it. */
static double front(const struct prepared *p, double sign, double t)
{
    const struct riemann_solution *tube = &tube_of(p)->main;
    const struct riemann_solution *end = &tube_of(p)->ends[sign < 0];
    const struct riemann_state *gas = sign > 0 ? &tube->left : &tube->right;
    const double length = tube_of(p)->x0 - p->domain.lo[0];
    const double c = sqrt(tube->gamma * gas->P / gas->rho);
    const double head = sign > 0 ? end->right_head : -end->left_head;
    const bool quiet = has_walls(p) && gas->v == 0;
    const double ahead = sign > 0 ? -tube->left_head : tube->right_head;
    const double speed = quiet ? 0 : isnan(head) ? sign * gas->v + c : head;
    /* infinite if both recede from each other or there is no wave in the gas ahead */
    const double meet = length / fmax(0, speed + ahead);
    if (t <= meet) return speed * t;
    const double mach =
        fmax(has_walls(p) ? tube_of(p)->returning[sign < 0] : 1, (speed - sign * gas->v) / c);
    return speed * meet + fmax(speed, fastest(tube, mach, sign)) * (t - meet);
}

static bool holds(const struct prepared *p, double t)
{
    return p->domain.lo[0] + front(p, 1, t) <= p->window.lo[0] &&
           p->domain.hi[0] - front(p, -1, t) >= p->window.hi[0];
}

static enum status refuse(const struct prepared *p, double t, double longest, struct error *error)
{
    if (has_walls(p))
        return error_set(error, STATUS_BAD_INPUT,
                         "t_end=%g: waves from the walls at the ends of the box reach the window "
                         "[%g, %g] at t = %.4g; allowed: t_end <= %.4g, or a narrower window",
                         t, p->window.lo[0], p->window.hi[0], longest, longest);
    return error_set(error, STATUS_BAD_INPUT,
                     "t_end=%g: the box is periodic, and waves of the mirrored tube at its ends "
                     "reach the window [%g, %g] at t = %.4g; allowed: t_end <= %.4g, or a narrower "
                     "window",
                     t, p->window.lo[0], p->window.hi[0], longest, longest);
}

/* ---- position of the shock ---- */

static bool shock_runs_right(const struct prepared *p)
{
    return p->domain.dim == 1 && tube_of(p)->main.right_wave == RIEMANN_SHOCK;
}

/* Rightmost position where the pressure crosses the mean of the two sides of the shock. */
static double shock_measured(const struct prepared *p, const struct snapshot *s)
{
    const struct riemann_solution *tube = &tube_of(p)->main;
    const double level = 0.5 * (tube->p_star + tube->right.P);
    for (size_t i = s->n; i-- > 1;) {
        const double x0 = s->x[0][i - 1], x1 = s->x[0][i], p0 = s->P[i - 1], p1 = s->P[i];
        if (x1 <= p->window.hi[0] && p0 >= level && p1 < level)
            return x0 + (x1 - x0) * (p0 - level) / (p0 - p1);
    }
    return NAN;
}

static double shock_exact(const struct prepared *p, double t)
{
    return tube_of(p)->x0 + tube_of(p)->main.right_head * t;
}

static const struct functional shock_position = {"shock_position", shock_runs_right, shock_measured,
                                                 shock_exact};

/* ---- transverse velocity in 2D and 3D, in gas that waves have passed ---- */

static bool has_width(const struct prepared *p)
{
    return p->domain.dim > 1;
}

static double transverse_measured(const struct prepared *p, const struct snapshot *s)
{
    const struct riemann_solution *tube = &tube_of(p)->main;
    double sum = 0, volume = 0;
    for (size_t i = 0; i < s->n; i++) {
        const double x = s->x[0][i] - tube_of(p)->x0;
        if (!(x > tube->left_head * s->time && x < tube->right_head * s->time)) continue;
        for (int d = 1; d < p->domain.dim; d++) sum += s->volume[i] * s->v[d][i] * s->v[d][i];
        volume += s->volume[i];
    }
    return volume > 0 ? sqrt(sum / volume) : 0;
}

static const struct functional transverse_noise = {"transverse_noise", has_width,
                                                   transverse_measured, functional_zero};

/* ---- regions of the error budget ---- */

enum { UNDISTURBED, FAN, PLATEAU, CONTACT, SHOCK };

/* False for a missing wave, whose position is NaN. */
static bool near(double x, double position, double reach)
{
    return fabs(x - position) <= reach;
}

static size_t region_at(const struct prepared *p, const double position[3], double reach, double t)
{
    const struct riemann_solution *tube = &tube_of(p)->main;
    const double x = position[0] - tube_of(p)->x0;
    const double speeds[2][2] = {{tube->left_head, tube->left_tail},
                                 {tube->right_tail, tube->right_head}};
    const enum riemann_wave waves[2] = {tube->left_wave, tube->right_wave};
    for (int side = 0; side < 2; side++)
        if (waves[side] == RIEMANN_SHOCK && near(x, speeds[side][0] * t, reach)) return SHOCK;
    if (near(x, tube->contact * t, reach)) return CONTACT;
    for (int side = 0; side < 2; side++)
        if (waves[side] == RIEMANN_RAREFACTION && x >= speeds[side][0] * t - reach &&
            x <= speeds[side][1] * t + reach)
            return FAN;
    return x < tube->left_head * t || x > tube->right_head * t ? UNDISTURBED : PLATEAU;
}

/* Speed of the outermost wave on one side, sign 1 for the right. */
static double edge(const struct riemann_solution *tube, double sign)
{
    return sign > 0 ? fmax(tube->right_head, tube->right_tail)
                    : -fmin(tube->left_head, tube->left_tail);
}

/* The same for the waves from an end of the box; sign: their direction. */
static double end_edge(const struct prepared *p, double sign)
{
    const struct tube *tube = tube_of(p);
    const double v = sign > 0 ? tube->main.left.v : tube->main.right.v;
    return has_walls(p) && v == 0 ? 0 : edge(&tube->ends[sign < 0], sign);
}

/* True if gas at a position must still be at rest ahead of a wave that has travelled `way` (< 0:
 * backwards). The margin is the largest of three lengths: some h, since the precursor of a shock
 * decreases tenfold per particle; a fraction of `way`, since the head of a fan is dispersed over
 * many h; and the reach of the widest particle, which may be a single one in light gas behind the
 * wave. */
static bool far_ahead(double position, double way, double h, double widest)
{
    const double still_widths = 12, still_way = 0.25, reaches = 2;
    return position - way > fmax(fmax(still_widths * h, still_way * fabs(way)), reaches * widest);
}

/* Distance to the nearer of the main tube's wave and the wave from the end of the box. */
static double ahead(const struct prepared *p, const double position[3], double t)
{
    const struct tube *tubes = tube_of(p);
    const double x = position[0], sign = x > tubes->x0 ? 1 : -1;
    const double from_end = sign > 0 ? p->domain.hi[0] - x : x - p->domain.lo[0];
    return fmin(sign * (x - tubes->x0) - edge(&tubes->main, sign) * t,
                from_end - end_edge(p, -sign) * t);
}

/* Undisturbed gas lies between the main tube's wave and the wave from the end of the box. */
static double stillness(const struct prepared *p, const struct snapshot *s)
{
    const struct tube *tubes = tube_of(p);
    const struct riemann_solution *tube = &tubes->main;
    double moved = NAN, widest = 0;
    for (size_t i = 0; i < s->n; i++) widest = fmax(widest, s->h[i]);
    for (size_t i = 0; i < s->n; i++) {
        const double x = s->x[0][i], sign = x > tubes->x0 ? 1 : -1;
        const struct riemann_state *gas = sign > 0 ? &tube->right : &tube->left;
        const double from_end = sign > 0 ? p->domain.hi[0] - x : x - p->domain.lo[0];
        if (!far_ahead(sign * (x - tubes->x0), edge(tube, sign) * s->time, s->h[i], widest) ||
            !far_ahead(from_end, end_edge(p, -sign) * s->time, s->h[i], widest))
            continue;
        const double c = sqrt(tube->gamma * gas->P / gas->rho);
        moved = fmax(moved, fabs(s->v[0][i] - gas->v) / c);
    }
    return moved;
}

static const struct regions regions = {
    .names = {[UNDISTURBED] = "undisturbed", /* no wave has passed */
              [FAN] = "fan",                 /* in a rarefaction or near its ends */
              [PLATEAU] = "plateau",         /* constant states between the waves; vacuum */
              [CONTACT] = "contact",         /* near the contact */
              [SHOCK] = "shock"},            /* near a shock */
    .at = region_at,
    .still = stillness,
};

const struct problem problem_riemann = {
    .member = {"riemann", "two uniform gases that meet in the middle of the box", "Toro 2009"},
    .reference = "riemann",
    .least_dim = 1,
    .most_dim = 3,
    .ends = {{.also = PROBLEM_END(REFLECTING)},
             {.also = PROBLEM_END(REFLECTING)},
             {.also = PROBLEM_END(REFLECTING)}},
    PROBLEM_KEYS({SETTING_left, ROLE_NEEDED}, {SETTING_right, ROLE_NEEDED},
                 {SETTING_grade, ROLE_PARTICLES}, {SETTING_grade_ratio, ROLE_PARTICLES},
                 {SETTING_mass_ratio, ROLE_PARTICLES}),
    .prepare = prepare,
    .sample = sample,
    .fill = fill,
    .ahead = ahead,
    .holds = holds,
    .refuse = refuse,
    .functionals = {&functional_mean_internal_energy, &functional_mean_pressure, &shock_position,
                    &transverse_noise},
    .regions = &regions,
};
