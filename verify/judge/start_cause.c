/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "start_gas.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "list.h"
#include "text.h"

/* A cause may leave a few particles unexplained. */
static bool nearly_all(size_t explained, size_t wrong)
{
    return 100 * explained >= 95 * wrong;
}

/* ---- number of particles in words ---- */

void start_share(size_t part, size_t n, char *text, size_t size)
{
    static const struct {
        double share;
        const char *words;
    } usual[] = {{3. / 4, "three quarters"}, {2. / 3, "two thirds"}, {1. / 2, "half"},
                 {1. / 3, "a third"},        {1. / 4, "a quarter"},  {1. / 5, "a fifth"},
                 {1. / 8, "an eighth"},      {1. / 10, "a tenth"}};
    const double share = (double)part / (double)n;
    snprintf(text, size, "%.2g %%", 100 * share);
    for (size_t k = 0; k < sizeof usual / sizeof *usual; k++)
        if (fabs(share / usual[k].share - 1) <= 0.03) snprintf(text, size, "%s", usual[k].words);
    if (part == n) snprintf(text, size, "all");
    if (part == 1) snprintf(text, size, "one");
}

/* ---- position of the wrong particles in words ---- */

/* Particles sorted by one coordinate. */
struct rank {
    double at;
    bool wrong;
};

static int by_number(const void *a, const void *b)
{
    const double x = ((const struct rank *)a)->at, y = ((const struct rank *)b)->at;
    return (x > y) - (x < y);
}

/* Half way from the particle before. */
static double edge(const struct rank *rank, size_t i)
{
    return 0.5 * (rank[i - 1].at + rank[i].at);
}

/* Names the range from the first to the last wrong particle, if hardly any particle in it is
 * right; particles at one position have that. */
static bool name_range(struct rank *rank, size_t n, const char *what, char *text, size_t size)
{
    size_t first = 0, end = n, right = 0;
    qsort(rank, n, sizeof *rank, by_number);
    while (!rank[first].wrong) first++;
    while (!rank[end - 1].wrong) end--;
    for (size_t i = first; i < end; i++) right += !rank[i].wrong;
    if (50 * right > end - first || end - first == n) return false;
    const double from = rank[first].at;
    if (rank[end - 1].at - from <= 1e-9 * fabs(from))
        snprintf(text, size, ", at %s = %.4g", what, from);
    else if (first == 0)
        snprintf(text, size, ", at %s < %.4g", what, edge(rank, end));
    else if (end == n)
        snprintf(text, size, ", at %s > %.4g", what, edge(rank, first));
    else
        snprintf(text, size, ", at %.4g < %s < %.4g", edge(rank, first), what, edge(rank, end));
    return true;
}

/* Names a constant stride between the wrong rows of the file, two at least. */
static bool name_stride(const struct start_gas *gas, unsigned fields, char *text, size_t size)
{
    const size_t n = gas->snapshot->n;
    size_t first = 0, stride = 1;
    while (!(gas->wrong[first] & fields)) first++;
    while (!(gas->wrong[first + stride] & fields)) stride++;
    if (stride < 2) return false;
    for (size_t i = first; i < n; i++)
        if (((gas->wrong[i] & fields) != 0) != ((i - first) % stride == 0)) return false;
    snprintf(text, size, ", each %zuth in the file", stride);
    if (stride < 4) snprintf(text, size, ", each %s in the file", stride == 2 ? "second" : "third");
    return true;
}

/* Coordinates by which particles can be sorted. */
enum way { WAY_X, WAY_Y, WAY_Z, WAY_RADIUS, WAY_ROW };

static bool has_way(const struct problem *problem, int dim, enum way way)
{
    if (way == WAY_RADIUS) return problem->circular;
    return way == WAY_ROW ? dim > 1 : (int)way < dim; /* in 1D rows say no more than x */
}

static double along(const struct start_gas *gas, enum way way, size_t i)
{
    if (way == WAY_RADIUS) return problem_radius(gas->problem, gas->x[i]);
    return way == WAY_ROW ? (double)i : gas->x[i][way];
}

void start_where(const struct start_gas *gas, unsigned fields, char *text, size_t size)
{
    static const char *const names[] = {"x", "y", "z", "r", "row"};
    const size_t n = gas->snapshot->n;
    struct rank *rank = malloc(n * sizeof *rank);
    size_t wrong = 0;
    bool named = !rank; /* without memory nothing is said */
    *text = '\0';
    for (size_t i = 0; i < n; i++) wrong += (gas->wrong[i] & fields) != 0;
    for (enum way way = 0; !named && way <= WAY_ROW; way++) {
        if (!has_way(gas->problem->problem, gas->problem->domain.dim, way)) continue;
        for (size_t i = 0; i < n; i++)
            rank[i] = (struct rank){along(gas, way, i), (gas->wrong[i] & fields) != 0};
        named = name_range(rank, n, names[way], text, size);
    }
    free(rank);
    if (named || wrong == n || name_stride(gas, fields, text, size)) return;
    snprintf(text, size, ", scattered over the box");
}

/* ---- wrong values ---- */

typedef double expected(const struct start_gas *gas, size_t i, double factor);

/* True if nearly all wrong particles would be right if these were the case's values. */
static bool fits(const struct start_gas *gas, enum start_field field, const double *value,
                 expected *value_of, double factor)
{
    size_t wrong = 0, near = 0;
    for (size_t i = 0; i < gas->snapshot->n; i++) {
        if (!(gas->wrong[i] & 1u << field)) continue;
        const double want = value_of(gas, i, factor);
        wrong++;
        near += fabs(value[i] - want) <= START_WRONG * fabs(want);
    }
    return nearly_all(near, wrong);
}

static double exact_energy(const struct start_gas *gas, size_t i, double factor)
{
    return factor * gas->exact[i].u;
}
static double exact_pressure(const struct start_gas *gas, size_t i, double factor)
{
    return factor * gas->exact[i].P;
}
static double exact_temperature(const struct start_gas *gas, size_t i, double factor)
{
    return factor * gas->exact[i].P / gas->exact[i].rho;
}
static double exact_entropy(const struct start_gas *gas, size_t i, double factor)
{
    return factor * gas->exact[i].P / pow(gas->exact[i].rho, gas->problem->gamma);
}
static double energy_of_volume(const struct start_gas *gas, size_t i, double factor)
{
    return factor * gas->exact[i].rho * gas->exact[i].u;
}
static double whole_energy(const struct start_gas *gas, size_t i, double factor)
{
    const double *v = gas->exact[i].v;
    return factor * (gas->exact[i].u + 0.5 * (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]));
}
static double exact_mass(const struct start_gas *gas, size_t i, double factor)
{
    return factor * start_mass(gas, gas->exact[i].rho);
}
static double exact_density(const struct start_gas *gas, size_t i, double factor)
{
    return factor * gas->exact[i].rho;
}
static double law(const struct start_gas *gas, size_t i, double factor)
{
    return factor * start_pressure(gas, i);
}

static const struct {
    enum start_field field;
    expected *value;
    const char *words;
} usual[] = {{START_ENERGY, exact_pressure, "the pressure"},
             {START_ENERGY, exact_temperature, "P/rho, a temperature"},
             {START_ENERGY, exact_entropy, "P/rho^gamma, an entropy"},
             {START_ENERGY, energy_of_volume, "rho u, the energy of a volume"},
             {START_ENERGY, whole_energy, "the total energy, u + v^2/2"},
             {START_MASS, exact_density, "the density"},
             {START_MASS, exact_energy, "the internal energy"}};

/* Median of the ratios of the values to the expected ones; NaN if there are none. */
static double factor_of(const struct start_gas *gas, enum start_field field, const double *value,
                        expected *value_of)
{
    double *factors = malloc(gas->snapshot->n * sizeof *factors), found = (double)NAN;
    size_t n = 0;
    for (size_t i = 0; factors && i < gas->snapshot->n; i++) {
        const double want = value_of(gas, i, 1);
        if (gas->wrong[i] & 1u << field && want != 0) factors[n++] = value[i] / want;
    }
    if (n) {
        list_sort(factors, n);
        found = factors[n / 2];
    }
    free(factors);
    return found;
}

static void scalar_cause(const struct start_gas *gas, enum start_field field, char *text,
                         size_t size)
{
    const struct snapshot *s = gas->snapshot;
    const double *value = field == START_ENERGY ? s->u : field == START_MASS ? s->m : s->P;
    expected *exact = field == START_ENERGY ? exact_energy : field == START_MASS ? exact_mass : law;
    const char *should = field == START_PRESSURE ? "(gamma - 1) rho u" : "the case's";
    const double factor = factor_of(gas, field, value, exact);
    for (size_t k = 0; k < sizeof usual / sizeof *usual; k++)
        if (usual[k].field == field && fits(gas, field, value, usual[k].value, 1))
            text_add(text, size, "%s%s", *text ? ", or " : "it is ", usual[k].words);
    if (!*text && fits(gas, field, value, exact, factor))
        snprintf(text, size, "it is %.6g times %s", factor, should);
    double more = (double)NAN; /* at the first wrong particle; an offset if it is constant */
    size_t all = 0, near = 0;
    for (size_t i = 0; i < s->n; i++) {
        if (!(gas->wrong[i] & 1u << field)) continue;
        if (!all++) more = value[i] - exact(gas, i, 1);
        near += fabs(value[i] - exact(gas, i, 1) - more) <= 1e-3 * fabs(more);
    }
    if (*text || all < 2) return; /* any offset or multiple fits one value */
    const double multiple = factor_of(gas, field, value, exact_density);
    if (nearly_all(near, all))
        snprintf(text, size, "it is %.4g %s than %s", fabs(more), more > 0 ? "more" : "less",
                 should);
    else if (field == START_ENERGY && fits(gas, field, value, exact_density, multiple))
        snprintf(text, size, "it is the mass, or another multiple of the density");
}

/* True if nearly all wrong velocities are the case's with axes `from`, times the factor (and the
 * density if `density`), plus `more`. */
static bool fits_velocity(const struct start_gas *gas, const int from[3], double factor,
                          const double more[3], bool density)
{
    size_t wrong = 0, near = 0;
    const int dim = gas->problem->domain.dim;
    for (size_t i = 0; i < gas->snapshot->n; i++) {
        if (!(gas->wrong[i] & 1u << START_VELOCITY)) continue;
        double squares = 0;
        for (int d = 0; d < dim; d++) {
            const double want =
                             factor * gas->exact[i].v[from[d]] * (density ? gas->exact[i].rho : 1) +
                             more[d],
                         off = gas->snapshot->v[d][i] - want;
            squares += off * off;
        }
        wrong++;
        near += sqrt(squares) <= START_WRONG * gas->speed;
    }
    return nearly_all(near, wrong);
}

static void velocity_cause(const struct start_gas *gas, char *text, size_t size)
{
    static const int same[] = {0, 1, 2};
    static const int turns[][3] = {{1, 0, 2}, {2, 1, 0}, {0, 2, 1}};
    static const char *const turned[] = {"x and y", "x and z", "y and z"};
    const double none[3] = {0};
    const int dim = gas->problem->domain.dim;
    double product = 0, square = 0, more[3] = {0};
    size_t wrong = 0;
    for (size_t i = 0; i < gas->snapshot->n; i++) {
        if (!(gas->wrong[i] & 1u << START_VELOCITY)) continue;
        for (int d = 0; d < dim; d++) {
            product += gas->snapshot->v[d][i] * gas->exact[i].v[d];
            square += gas->exact[i].v[d] * gas->exact[i].v[d];
            if (!wrong) more[d] = gas->snapshot->v[d][i] - gas->exact[i].v[d];
        }
        wrong++;
    }
    const double factor =
        product / square; /* NaN, which fits nothing, if the exact gas is at rest */
    int turn = 0;
    while (turn < dim * (dim - 1) / 2 && !fits_velocity(gas, turns[turn], 1, none, false)) turn++;
    if (fits_velocity(gas, same, 0, none, false))
        snprintf(text, size, "it is 0");
    else if (turn < dim * (dim - 1) / 2)
        snprintf(text, size, "%s are exchanged", turned[turn]);
    else if (fits_velocity(gas, same, factor, none, false) && fabs(factor + 1) <= START_WRONG)
        snprintf(text, size, "it has the other sign");
    else if (fits_velocity(gas, same, factor, none, false))
        snprintf(text, size, "it is %.6g times the case's", factor);
    else if (fits_velocity(gas, same, 1, none, true))
        snprintf(text, size, "it is rho v, a momentum");
    else if (fits_velocity(gas, same, 1, more, false)) {
        snprintf(text, size, "it is the case's and");
        for (int d = 0; d < dim; d++) text_add(text, size, "%s%.4g", d ? ", " : " ", more[d]);
    }
}

bool start_cause(const struct start_gas *gas, enum start_field field, char *text, size_t size)
{
    *text = '\0';
    if (field == START_VELOCITY)
        velocity_cause(gas, text, size);
    else
        scalar_cause(gas, field, text, size);
    return *text;
}

/* ---- states of other positions ---- */

/* Particles for which displacements are tried. */
struct trial {
    const struct start_gas *gas;
    size_t n, id[96];
};

static void take(struct trial *trial, bool all)
{
    const struct start_gas *gas = trial->gas;
    const size_t most = sizeof trial->id / sizeof *trial->id;
    size_t wrong = 0;
    for (size_t i = 0; i < gas->snapshot->n; i++) wrong += all || gas->wrong[i];
    const size_t stride = wrong / most + 1;
    wrong = trial->n = 0;
    for (size_t i = 0; i < gas->snapshot->n; i++)
        if ((all || gas->wrong[i]) && wrong++ % stride == 0) trial->id[trial->n++] = i;
}

/* Mean misfit, from 0 to 1, of the particles displaced by `by`; *near: the number of those that
 * fit. */
static double miss(const struct trial *trial, const double by[3], size_t *near)
{
    const struct start_gas *gas = trial->gas;
    double sum = 0;
    *near = 0;
    for (size_t k = 0; k < trial->n; k++) {
        const size_t i = trial->id[k];
        struct problem_state there;
        double x[3] = {0};
        for (int d = 0; d < gas->problem->domain.dim; d++) x[d] = gas->x[i][d] - by[d];
        for (int d = 0; d < gas->problem->domain.dim; d++) {
            const double length = domain_length(&gas->problem->domain, d);
            x[d] -= length * floor((x[d] - gas->problem->domain.lo[d]) / length);
        }
        problem_sample_start(gas->problem, x, &there);
        double off = start_off(gas, START_VELOCITY, i, &there);
        if (!gas->problem->problem->mean_energy)
            off = fmax(off, start_off(gas, START_ENERGY, i, &there));
        sum += fmin(off, 1);
        *near += off <= START_WRONG;
    }
    return sum / (double)trial->n;
}

/* Pattern search for the least misfit from the best grid point; step: over the box's lengths. */
static size_t settle(const struct trial *trial, double by[3], double step)
{
    const int dim = trial->gas->problem->domain.dim;
    size_t near;
    double best = miss(trial, by, &near);
    for (int rounds = 0; rounds < 80; rounds++) {
        bool moved = false;
        for (int k = 0; k < 2 * dim; k++) {
            const int d = k / 2;
            double to[3];
            memcpy(to, by, sizeof to);
            to[d] += (k % 2 ? step : -step) * domain_length(&trial->gas->problem->domain, d);
            size_t now;
            const double other = miss(trial, to, &now);
            if (other >= best) continue;
            best = other, near = now, moved = true;
            memcpy(by, to, sizeof to);
        }
        if (!moved) step /= 2;
    }
    return near;
}

/* Finds the shift that explains the particles best; true if it explains nearly all of them. */
static bool find_shift(const struct trial *trial, double by[3])
{
    enum { SIDE_LINE = 480, SIDE_PLANE = 40, SIDE_SPACE = 12 };
    const struct domain *box = &trial->gas->problem->domain;
    const int side = box->dim == 1 ? SIDE_LINE : box->dim == 2 ? SIDE_PLANE : SIDE_SPACE;
    int cells = 1;
    double best = INFINITY;
    for (int d = 0; d < box->dim; d++) cells *= side;
    for (int c = 0; c < cells; c++) {
        const int position[3] = {c % side, c / side % side, c / side / side};
        double to[3] = {0};
        size_t near;
        for (int d = 0; d < box->dim; d++)
            to[d] =
                domain_length(box, d) * (position[d] - (position[d] > side / 2 ? side : 0)) / side;
        const double now = miss(trial, to, &near);
        if (now >= best) continue;
        best = now;
        memcpy(by, to, sizeof to);
    }
    return nearly_all(settle(trial, by, 0.5 / side), trial->n);
}

/* True if nearly all wrong particles have the exact state of the position with x and y exchanged,
 * or of the mirrored position. */
static bool turned(const struct start_gas *gas, int mirror)
{
    const struct domain *box = &gas->problem->domain;
    size_t wrong = 0, near = 0;
    for (size_t i = 0; i < gas->snapshot->n; i++) {
        if (!gas->wrong[i]) continue;
        struct problem_state there;
        double x[3];
        memcpy(x, gas->x[i], sizeof x);
        if (mirror < 0)
            x[0] = gas->x[i][1], x[1] = gas->x[i][0];
        else
            x[mirror] = box->lo[mirror] + box->hi[mirror] - x[mirror];
        problem_sample_start(gas->problem, x, &there);
        wrong++;
        near += start_off(gas, START_VELOCITY, i, &there) <= START_WRONG &&
                start_off(gas, START_ENERGY, i, &there) <= START_WRONG;
    }
    return nearly_all(near, wrong);
}

bool start_cause_positions(const struct start_gas *gas, char *text, size_t size)
{
    const int dim = gas->problem->domain.dim;
    struct trial trial = {.gas = gas};
    double by[3] = {0};
    size_t near;
    take(&trial, false);
    miss(&trial, by, &near);
    if (nearly_all(near, trial.n)) return false; /* their places are right; masses may be wrong */
    if (dim > 1 && turned(gas, -1)) {
        snprintf(text, size, "x and y of their places are exchanged");
        return true;
    }
    for (int d = 0; d < dim; d++) {
        if (!turned(gas, d)) continue;
        snprintf(text, size, "%c of their places is mirrored", "xyz"[d]);
        return true;
    }
    for (int all = 1; all >= 0; all--) {
        take(&trial, all);
        if (!find_shift(&trial, by)) continue;
        take(&trial, false); /* a sample of all particles may consist mostly of right ones */
        miss(&trial, by, &near);
        if (!nearly_all(near, trial.n)) continue;
        snprintf(text, size,
                 all ? "all particles of the file are shifted by" : "they are shifted by");
        for (int d = 0; d < dim; d++)
            text_add(text, size, "%s%.4g", d ? ", " : " ",
                     fabs(by[d]) < 1e-6 * domain_length(&gas->problem->domain, d) ? 0 : by[d]);
        return true;
    }
    return false;
}
