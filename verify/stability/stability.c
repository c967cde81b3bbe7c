/* SPDX-License-Identifier: GPL-3.0-or-later
 * Derivation. A wave is a complex amplitude a, the perturbation Re(a exp(i kappa j)); at offset k
 * the neighbour's is a e, e = exp(i kappa k). Each equation of CONVENTIONS sections 3 to 5 is
 * varied term by term: density and width together (h rho = eta m), volume, pressure, the matrix of
 * ia, grad-h factors, then the pair force. */
#include "stability.h"

#include <complex.h>
#include <math.h>
#include <stdlib.h>

#include "pieces.h"

enum { WAVES = 96 };
static const double growth_floor = 1e-6; /* growth below it is round-off of a stable wave */

/* --- the kernel's derivatives on the lattice -------------------------------------------------- */

/* w''(q) within its piece; at a knot the mean of both sides. */
static double curvature(const struct pieces *pieces, double q)
{
    double floor, below = 0, above = 1;
    if (q >= 1) return 0;
    for (int i = 0; i <= pieces->n; i++) {
        if (pieces->edge[i] < q) below = pieces->edge[i];
        if (pieces->edge[i] > q && pieces->edge[i] < above) above = pieces->edge[i];
    }
    if (q - below < 1e-9) return pieces_derivative(pieces, q, above, 2, &floor);
    const double left = pieces_derivative(pieces, q, below, 2, &floor);
    for (int i = 0; i <= pieces->n; i++)
        if (fabs(pieces->edge[i] - q) < 1e-12)
            return 0.5 * (left + pieces_derivative(pieces, q, above, 2, &floor));
    return q - below > above - q ? left : pieces_derivative(pieces, q, above, 2, &floor);
}

static struct stability_pair pair_at(const struct pieces *pieces, double r, double h)
{
    const struct kernel *kernel = pieces->kernel;
    const double q = r / h, C = kernel->constant[1];
    const double w = kernel->w(kernel, q, 1), dw = q < 1 ? kernel->dw(kernel, q, 1) : 0;
    const double ddw = curvature(pieces, q);
    return (struct stability_pair){
        .W = C / h * w,
        .r = C / (h * h) * dw,
        .rr = C / (h * h * h) * ddw,
        .h = -C / (h * h) * (w + q * dw),
        .rh = -C / (h * h * h) * (2 * dw + q * ddw),
        .hh = C / (h * h * h) * (2 * w + 4 * q * dw + q * q * ddw),
    };
}

/* Sum of W over the lattice at width h. */
static double lattice_density(const struct kernel *kernel, double h)
{
    double rho = kernel_value(kernel, 0, h, 1);
    for (int k = 1; k < h; k++) rho += 2 * kernel_value(kernel, k, h, 1);
    return rho;
}

/* h rho(h) = eta; h rho(h) rises with h from C w(0). */
static bool find_width(const struct scheme *scheme, double *h)
{
    double low = 0, high = 1;
    const double eta = scheme->eta;
    while (high * lattice_density(&scheme->kernel, high) < eta)
        if ((high *= 2) > STABILITY_REACH_MAX) return false;
    for (int i = 0; i < 200 && low < high; i++) {
        *h = 0.5 * (low + high);
        if (*h == low || *h == high) break;
        *(*h * lattice_density(&scheme->kernel, *h) < eta ? &low : &high) = *h;
    }
    return true;
}

bool stability_covers(enum gradient gradient)
{
    return gradient == GRADIENT_STANDARD || gradient == GRADIENT_IA;
}

enum status stability_begin(struct stability *lattice, const struct scheme *scheme, double gamma,
                            struct error *error)
{
    *lattice = (struct stability){.scheme = *scheme, .gamma = gamma, .approaching = 0.5};
    if (scheme_check(scheme, 1, error)) return error->status;
    if (!stability_covers(scheme->gradient))
        return error_set(
            error, STATUS_BAD_INPUT,
            "linear stability: there is no theory of gradient %s; allowed: standard ia",
            scheme_gradient_family.members[scheme->gradient]->name);
    if (scheme->viscosity != VISCOSITY_NONE && scheme->viscosity != VISCOSITY_CONSTANT)
        return error_set(error, STATUS_BAD_INPUT,
                         "linear stability: viscosity %s is not linear; allowed: none constant",
                         scheme_viscosity_family.members[scheme->viscosity]->name);
    if (!find_width(scheme, &lattice->h) || lattice->h > STABILITY_REACH_MAX)
        return error_set(error, STATUS_BAD_INPUT, "linear stability: eta = %g is too wide",
                         scheme->eta);
    lattice->reach = (int)ceil(lattice->h) - 1;
    struct pieces pieces;
    if (pieces_find(&pieces, &lattice->scheme.kernel, 1, NULL, error)) return error->status;
    for (int k = 0; k <= lattice->reach; k++) lattice->pair[k] = pair_at(&pieces, k, lattice->h);
    pieces_free(&pieces);
    lattice->rho = scheme->eta / lattice->h;
    lattice->u = 1 / (gamma * (gamma - 1)); /* sound speed 1 */
    lattice->P = lattice->rho / gamma;
    return STATUS_OK;
}

/* --- variation of all quantities that depend on the state
 * --------------------------------------- */

/* Phase factor between neighbouring particles. */
static double complex phase(double angle)
{
    return cos(angle) + (double complex)I * sin(angle);
}

/* The given amplitudes, and those that follow from them. */
struct wave {
    double complex x, v, u, h;
    double complex rho, rho_h, y, y_h, V, P, C, factor;
};

/* Sums of the unperturbed lattice. */
struct sums {
    double rho_h, C, factor;
};

static struct sums sums_of(const struct stability *lattice)
{
    struct sums sums = {.rho_h = lattice->pair[0].h};
    double T = 0;
    for (int k = 1; k <= lattice->reach; k++) {
        sums.rho_h += 2 * lattice->pair[k].h;
        T += 2 * k * k * lattice->pair[k].W / lattice->rho;
    }
    const double y_h =
        lattice->scheme.volume_element == VOLUME_ENERGY ? lattice->u * sums.rho_h : sums.rho_h;
    sums.C = T > 0 ? 1 / T : 0;
    sums.factor = lattice->h * y_h / (lattice->rho + lattice->h * sums.rho_h);
    return sums;
}

/* Kernel sums at the wave's own h. */
static void vary_sums(const struct stability *lattice, double kappa, struct wave *w)
{
    const struct sums sums = sums_of(lattice);
    const double rho = lattice->rho, h = lattice->h, u = lattice->u;
    const bool energy = lattice->scheme.volume_element == VOLUME_ENERGY;
    double complex energy_sum = w->u * lattice->pair[0].W, energy_sum_h = w->u * lattice->pair[0].h;
    double complex T = 0;
    double rho_hh = lattice->pair[0].hh, k2W_h = 0;
    w->rho = w->rho_h = 0;
    for (int s = -lattice->reach; s <= lattice->reach; s++) {
        if (s == 0) continue;
        const struct stability_pair *p = &lattice->pair[abs(s)];
        const int sign = s > 0 ? 1 : -1;
        const double complex e = phase(kappa * s), dx = w->x * (e - 1);
        w->rho += sign * p->r * dx;
        w->rho_h += sign * p->rh * dx;
        rho_hh += p->hh;
        energy_sum += w->u * e * p->W;
        energy_sum_h += w->u * e * p->h;
        T += (2 * s * p->W + sign * s * s * p->r) * dx / rho;
        k2W_h += s * s * p->h;
    }
    w->rho += sums.rho_h * w->h;
    w->rho_h += rho_hh * w->h;
    w->y = energy ? u * w->rho + energy_sum : w->rho;
    w->y_h = energy ? u * w->rho_h + energy_sum_h : w->rho_h;
    w->V = energy ? w->u / (u * rho) - w->y / (u * rho * rho) : -w->rho / (rho * rho);
    w->P = energy ? (lattice->gamma - 1) * w->y : lattice->P * (w->u / u + w->rho / rho);
    for (int s = -lattice->reach; s <= lattice->reach; s++)
        T += w->V * phase(kappa * s) * (s * s * lattice->pair[abs(s)].W);
    T += k2W_h * w->h / rho;
    w->C = -sums.C * sums.C * T;
    const double y_h = energy ? u * sums.rho_h : sums.rho_h, below = rho + h * sums.rho_h;
    w->factor =
        (w->h * y_h + h * w->y_h - sums.factor * (w->rho + w->h * sums.rho_h + h * w->rho_h)) /
        below;
}

/* --- the pair force --------------------------------------------------------------------------- */

struct gradient_terms {
    double G;                  /* at offset s */
    double complex at_i, at_j; /* its variation with the width of i and of j */
};

static struct gradient_terms vary_gradient(const struct stability *lattice, const struct sums *sums,
                                           const struct wave *w, int s, double complex e)
{
    const struct stability_pair *p = &lattice->pair[abs(s)];
    const int sign = s > 0 ? 1 : -1;
    const double complex dx = w->x * (e - 1);
    if (lattice->scheme.gradient == GRADIENT_STANDARD)
        return (struct gradient_terms){-sign * p->r, -p->rr * dx - sign * p->rh * w->h,
                                       -p->rr * dx - sign * p->rh * w->h * e};
    const double complex moved = sums->C * (p->W + sign * s * p->r) * dx;
    const double complex own = sums->C * s * p->h * w->h + w->C * s * p->W;
    return (struct gradient_terms){sums->C * s * p->W, moved + own, moved + own * e};
}

/* dv/dt and dU/dt of a wave. */
static void vary_force(const struct stability *lattice, double kappa, const struct wave *w,
                       double complex *force, double complex *energy)
{
    const struct sums sums = sums_of(lattice);
    const struct scheme *scheme = &lattice->scheme;
    const bool element = scheme->volume_element == VOLUME_ENERGY;
    const double V = 1 / lattice->rho, P = lattice->P, Z = element ? lattice->u : 1;
    const double b = P * V * V / Z, D2_h = 0.01 * 0.25 * lattice->h * lattice->h;
    const double alpha = scheme->viscosity == VISCOSITY_NONE ? 0 : scheme->alpha;
    const double complex z = element ? w->u : 0;
    const double complex b_w = b * (w->P / P + 2 * w->V / V - z / Z);
    *force = *energy = 0;
    for (int s = -lattice->reach; s <= lattice->reach; s++) {
        if (s == 0) continue;
        const double complex e = phase(kappa * s);
        const struct gradient_terms g = vary_gradient(lattice, &sums, w, s, e);
        if (scheme->formulation == FORMULATION_VANILLA_ICE) {
            *force -=
                (2 * P * V * w->V + V * V * w->P) * (1 + e) * g.G + P * V * V * (g.at_i + g.at_j);
            *energy += P * V * V * (w->v - w->v * e) * g.G;
        } else {
            const double a = b * (Z - sums.factor);
            *force -= b_w * (1 + e) * (Z - sums.factor) * g.G + a * (g.at_i + g.at_j) +
                      b * (z * e - w->factor + z - w->factor * e) * g.G;
            *energy += a * (w->v - w->v * e) * g.G;
        }
        *force -= lattice->approaching * alpha * (0.5 * lattice->h) * V * (w->v - w->v * e) *
                  (s * g.G / (s * s + D2_h));
    }
}

/* --- rates, growth ---------------------------------------------------------------------------- */

/* Real waves: cos for x, v and forces (amplitude a), sin for U, h and sums (amplitude -i a). */
static void respond(const struct stability *lattice, double kappa, struct wave w, double *force,
                    double *energy, double *found)
{
    double complex f, e;
    vary_sums(lattice, kappa, &w);
    vary_force(lattice, kappa, &w, &f, &e);
    *force = creal(f);
    *energy = -cimag(e);
    *found = -cimag(w.rho) / lattice->scheme.eta;
}

void stability_response(const struct stability *lattice, double kappa, struct stability_response *r)
{
    double zero;
    const struct wave x = {.x = 1}, v = {.v = 1}, u = {.u = -(double complex)I},
                      h = {.h = -(double complex)I};
    respond(lattice, kappa, x, &r->force_x, &zero, &r->found_x);
    respond(lattice, kappa, v, &r->force_v, &r->energy_v, &zero);
    respond(lattice, kappa, u, &r->force_u, &zero, &zero);
    respond(lattice, kappa, h, &r->force_h, &zero, &r->found_h);
}

void stability_rates(const struct stability *lattice, double kappa, struct stability_rates *rates)
{
    struct stability_response r;
    stability_response(lattice, kappa, &r);
    /* h follows density at once: -H/h^2 = found_x X + found_h H */
    const double width = -r.found_x / (1 / (lattice->h * lattice->h) + r.found_h);
    *rates =
        (struct stability_rates){r.force_x + width * r.force_h, r.force_v, r.force_u, r.energy_v};
}

double stability_growth(const struct stability *lattice, double kappa, double *frequency)
{
    /* eigenvalues: 0 (entropy) and l^2 - v l - (x + u energy) = 0 */
    struct stability_rates r;
    stability_rates(lattice, kappa, &r);
    const double complex root = csqrt(0.25 * r.v * r.v + r.x + r.u * r.energy);
    if (frequency) *frequency = fabs(cimag(root));
    return 0.5 * r.v + fabs(creal(root));
}

double stability_worst(const struct stability *lattice, double *kappa)
{
    double worst = -HUGE_VAL;
    for (int i = 1; i <= WAVES; i++) {
        const double growth = stability_growth(lattice, M_PI * i / WAVES, NULL);
        if (growth > worst) {
            worst = growth;
            if (kappa) *kappa = M_PI * i / WAVES;
        }
    }
    return worst;
}

/* --- intervals of eta ------------------------------------------------------------------------- */

static bool stable_at(const struct scheme *scheme, double gamma, double eta)
{
    struct stability lattice;
    struct scheme wider = *scheme;
    struct error error;
    wider.eta = eta;
    return !stability_begin(&lattice, &wider, gamma, &error) &&
           stability_worst(&lattice, NULL) <= growth_floor;
}

static double border(const struct scheme *scheme, double gamma, double stable, double unstable)
{
    for (int i = 0; i < 20; i++) {
        const double middle = 0.5 * (stable + unstable);
        *(stable_at(scheme, gamma, middle) ? &stable : &unstable) = middle;
    }
    return stable;
}

int stability_intervals(const struct scheme *scheme, double gamma, double to,
                        struct stability_interval *intervals, int max)
{
    const double least = kernel_least_eta(&scheme->kernel, 1);
    const int steps = (int)ceil((to - least) / 0.05);
    int count = 0;
    bool before = false;
    double last = least;
    for (int i = 1; i <= steps; i++) {
        const double eta = least + (to - least) * i / steps;
        const bool now = stable_at(scheme, gamma, eta);
        if (now && !before) {
            if (count == max) return count;
            intervals[count++].from = i == 1 ? least : border(scheme, gamma, eta, last);
        }
        if (before && !now) intervals[count - 1].to = border(scheme, gamma, last, eta);
        if (now && i == steps) intervals[count - 1].to = to;
        before = now;
        last = eta;
    }
    return count;
}
