/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "user_table.h"

#include <gsl/gsl_interp.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "csv.h"

enum column { RHO, VX, VY, VZ, P_, U, VR, VPHI, COLUMNS };
static const char *const column_names[COLUMNS] = {"rho", "vx", "vy", "vz", "P", "u", "vr", "vphi"};

enum over { OVER_X, OVER_XY, OVER_R };

struct user_table {
    enum over over;
    double time;
    size_t n[2];                /* rows along x or r; rows along y, or 1 */
    double *axis[2];            /* n each, increasing */
    double *value[COLUMNS];     /* n[0]*n[1] each, y fastest; NULL: missing */
    gsl_interp *curve[COLUMNS]; /* along x or r */
    char path[200];
};

/* ---- reading ---- */

/* Reads a line "# time = T"; NaN: none. */
static double read_time(const char *path)
{
    char line[256], rest;
    double time = (double)NAN, found;
    FILE *file = fopen(path, "r");
    while (file && fgets(line, sizeof line, file))
        if (sscanf(line, " # time = %lf %c", &found, &rest) == 1) time = found;
    if (file) fclose(file);
    return time;
}

static enum status unsorted(const struct user_table *table, const char *path, const struct csv *csv,
                            const double *const at[2], size_t row, struct error *error)
{
    const char *name = table->over == OVER_R ? "r" : "x";
    if (table->over != OVER_XY)
        return error_set(error, STATUS_BAD_INPUT,
                         "%.200s:%zu: %s = %.9g: allowed: rising, row after row", path,
                         csv->line[row], name, at[0][row]);
    return error_set(error, STATUS_BAD_INPUT,
                     "%.200s:%zu: x = %.9g, y = %.9g: allowed: the rows of a rectangular grid, all "
                     "pairs of rising x and rising y",
                     path, csv->line[row], at[0][row], at[1][row]);
}

/* Reads the positions of the rows: one increasing coordinate, or all pairs of two. order: index of
 * row i in the table. */
static enum status read_positions(struct user_table *table, const char *path, const struct csv *csv,
                                  const double *const at[2], size_t *order, struct error *error)
{
    const size_t rows = csv->rows;
    const bool both = table->over == OVER_XY;
    /* the fast axis is the one that changes between the first two rows */
    const int fast = both && rows > 1 && at[1][0] == at[1][1] ? 0 : both ? 1 : 0;
    size_t count = 1;
    while (count < rows && at[fast][count] > at[fast][count - 1]) count++;
    if (!both && count < rows) return unsorted(table, path, csv, at, count, error);
    if (rows % count || count < 2 || (both && rows / count < 2))
        return unsorted(table, path, csv, at, count < rows ? count : 0, error);
    table->n[0] = !both ? rows : fast == 0 ? count : rows / count;
    table->n[1] = rows / table->n[0];
    for (int a = 0; a < 2; a++)
        if (!(table->axis[a] = malloc(table->n[a] * sizeof(double))))
            return error_set(error, STATUS_ENVIRONMENT, "no memory for %.200s", path);
    for (size_t i = 0; i < rows; i++) {
        const size_t quick = i % count, slow = i / count;
        const size_t ix = !both || fast == 0 ? quick : slow, iy = both ? (fast ? quick : slow) : 0;
        const size_t first_x = fast == 0 ? ix : ix * count, first_y = fast ? iy : iy * count;
        if (both && (at[0][i] != at[0][first_x] || at[1][i] != at[1][first_y] ||
                     (slow && quick == 0 && !(at[!fast][i] > at[!fast][i - 1]))))
            return unsorted(table, path, csv, at, i, error);
        table->axis[0][ix] = at[0][i];
        if (both) table->axis[1][iy] = at[1][i];
        order[i] = ix * table->n[1] + iy;
    }
    if (!both) table->axis[1][0] = 0;
    return STATUS_OK;
}

/* Makes the interpolating curves; false: no memory. */
static bool make_curves(struct user_table *table)
{
    const size_t n = table->n[0];
    for (int c = 0; c < COLUMNS; c++) {
        if (!table->value[c] || table->over == OVER_XY) continue;
        table->curve[c] = gsl_interp_alloc(n > 2 ? gsl_interp_steffen : gsl_interp_linear, n);
        if (!table->curve[c]) return false;
        gsl_interp_init(table->curve[c], table->axis[0], table->value[c], n);
    }
    return true;
}

void user_table_free(struct user_table *table)
{
    for (int c = 0; table && c < COLUMNS; c++) {
        free(table->value[c]);
        if (table->curve[c]) gsl_interp_free(table->curve[c]);
    }
    if (table) free(table->axis[0]), free(table->axis[1]);
    free(table);
}

static enum status read_columns(struct user_table *table, const char *path, const struct csv *csv,
                                size_t *order, struct error *error)
{
    const int x = csv_column(csv, "x"), y = csv_column(csv, "y"), r = csv_column(csv, "r");
    bool any = false;
    if ((r >= 0) == (x >= 0) || (r >= 0 && y >= 0) || csv_column(csv, "z") >= 0)
        return error_set(error, STATUS_BAD_INPUT,
                         "%.200s:1: places are needed: a column x, columns x and y, or a column r",
                         path);
    table->over = r >= 0 ? OVER_R : y >= 0 ? OVER_XY : OVER_X;
    const double *const at[2] = {csv->values[r >= 0 ? r : x], y >= 0 ? csv->values[y] : NULL};
    if (read_positions(table, path, csv, at, order, error)) return error->status;
    for (int c = 0; c < COLUMNS; c++) {
        const int k = csv_column(csv, column_names[c]);
        if (k < 0 || (table->over == OVER_R ? c >= VX && c <= VZ : c >= VR)) continue;
        if (!(table->value[c] = malloc(csv->rows * sizeof(double))))
            return error_set(error, STATUS_ENVIRONMENT, "no memory for %.200s", path);
        for (size_t i = 0; i < csv->rows; i++) table->value[c][order[i]] = csv->values[k][i];
        any = true;
    }
    if (!any)
        return error_set(error, STATUS_BAD_INPUT,
                         "%.200s:1: no field: allowed: columns rho, %s, P, u", path,
                         table->over == OVER_R ? "vr, vphi" : "vx, vy, vz");
    table->time = read_time(path);
    if (!(table->time >= 0 && isfinite(table->time)))
        return error_set(error, STATUS_BAD_INPUT,
                         "%.200s: it does not say of which time it is: a line `# time = T` with T "
                         ">= 0 is needed",
                         path);
    return make_curves(table) ? STATUS_OK
                              : error_set(error, STATUS_ENVIRONMENT, "no memory for %.200s", path);
}

struct user_table *user_table_read(const char *path, struct error *error)
{
    struct csv csv = {0};
    struct user_table *table = calloc(1, sizeof *table);
    enum status status = table ? csv_read(path, &csv, error)
                               : error_set(error, STATUS_ENVIRONMENT, "no memory for a table");
    size_t *order = status ? NULL : malloc(csv.rows * sizeof *order);
    if (!status && !order) status = error_set(error, STATUS_ENVIRONMENT, "no memory for a table");
    if (!status && csv.rows < 2)
        status = error_set(error, STATUS_BAD_INPUT,
                           "%.200s: %zu row%s: allowed: 2 or more, to interpolate between", path,
                           csv.rows, csv.rows == 1 ? "" : "s");
    if (!status) status = read_columns(table, path, &csv, order, error);
    if (table) snprintf(table->path, sizeof table->path, "%s", path);
    free(order);
    csv_free(&csv);
    if (!status) return table;
    user_table_free(table);
    return NULL;
}

double user_table_time(const struct user_table *table)
{
    return table->time;
}

/* ---- values ---- */

bool user_table_knows(const struct user_table *table, enum field field)
{
    double *const *value = table->value;
    switch (field) {
    case FIELD_DENSITY:
        return value[RHO];
    case FIELD_VELOCITY:
        return value[VX] || value[VY] || value[VZ] || value[VR] || value[VPHI];
    case FIELD_PRESSURE:
        return value[P_] || (value[RHO] && value[U]);
    default:
        return value[U] || (value[RHO] && value[P_]);
    }
}

/* Finds the row below x and the fraction of the distance to the next; false: x is outside. */
static bool locate(const double *axis, size_t n, double x, double period, size_t *row, double *part)
{
    const double first = axis[0], last = axis[n - 1];
    const double near = fmax(axis[1] - first, last - axis[n - 2]);
    if (period > 0 && last < first + period) { /* periodic box */
        x -= period * floor((x - first) / period);
        const double gap = first + period - last;
        if (x > last && gap <= 2.01 * near) {
            *row = n - 1;
            *part = (x - last) / gap;
            return true;
        }
    }
    if (!(x >= first - 1.01 * near && x <= last + 1.01 * near)) return false;
    x = fmin(fmax(x, first), last);
    *row = gsl_interp_bsearch(axis, x, 0, n - 1);
    *part = (x - axis[*row]) / (axis[*row + 1] - axis[*row]);
    return true;
}

struct spot {
    size_t row[2], next[2];
    double part[2];
    bool inside, across; /* between the last row and the first */
};

static struct spot spot_at(const struct user_table *table, const struct prepared *p,
                           const double x[2])
{
    struct spot spot = {.inside = true};
    for (int a = 0; a < 2; a++) {
        if (table->n[a] < 2) continue;
        const bool periodic =
            table->over != OVER_R && a < p->domain.dim && p->boundary[a] == BOUNDARY_PERIODIC;
        spot.inside &=
            locate(table->axis[a], table->n[a], x[a], periodic ? domain_length(&p->domain, a) : 0,
                   &spot.row[a], &spot.part[a]);
        spot.across |= spot.row[a] == table->n[a] - 1;
        spot.next[a] = (spot.row[a] + 1) % table->n[a];
    }
    return spot;
}

static double value_at(const struct user_table *table, enum column c, const struct spot *spot)
{
    const double *value = table->value[c], *axis = table->axis[0];
    const size_t ny = table->n[1], *row = spot->row, *next = spot->next;
    const double a = spot->part[0], b = spot->part[1];
    if (!value) return (double)NAN;
    if (table->curve[c] && !spot->across)
        return gsl_interp_eval(table->curve[c], axis, value,
                               axis[row[0]] + a * (axis[next[0]] - axis[row[0]]), NULL);
    return (1 - a) * ((1 - b) * value[row[0] * ny + row[1]] + b * value[row[0] * ny + next[1]]) +
           a * ((1 - b) * value[next[0] * ny + row[1]] + b * value[next[0] * ny + next[1]]);
}

/* Velocity from vr and vphi about the window's centre; a missing column is 0. */
static void turn(const struct prepared *p, const double x[3], double vr, double vphi, double v[3])
{
    const double r = problem_radius(p, x);
    double away[3] = {0};
    for (int d = 0; d < p->domain.dim && r > 0; d++) away[d] = (x[d] - p->window.centre[d]) / r;
    for (int d = 0; d < p->domain.dim; d++) v[d] = vr * away[d];
    if (p->domain.dim == 1) return;
    v[0] -= vphi * away[1];
    v[1] += vphi * away[0];
}

/* State at the table's coordinates x, which belong to the position `at`. */
static void state_at(const struct user_table *table, const struct prepared *p, const double at[3],
                     const double x[2], struct problem_state *state)
{
    double value[COLUMNS];
    const double nan = (double)NAN;
    const struct spot spot = spot_at(table, p, x);
    for (int c = 0; c < COLUMNS; c++)
        value[c] = spot.inside ? value_at(table, (enum column)c, &spot) : nan;
    *state = (struct problem_state){value[RHO], {0}, value[P_], value[U]};
    for (int d = 0; d < p->domain.dim; d++)
        state->v[d] = !user_table_knows(table, FIELD_VELOCITY) ? nan
                      : table->value[VX + d]                   ? value[VX + d]
                                                               : 0;
    if (table->value[VR] || table->value[VPHI])
        turn(p, at, table->value[VR] ? value[VR] : 0, table->value[VPHI] ? value[VPHI] : 0,
             state->v);
    if (!table->value[P_]) state->P = (p->gamma - 1) * state->rho * state->u;
    if (!table->value[U]) state->u = state->P / ((p->gamma - 1) * state->rho);
}

void user_table_sample(const struct user_table *table, const struct prepared *p, const double x[3],
                       struct problem_state *state)
{
    const double over[2] = {table->over == OVER_R ? problem_radius(p, x) : x[0], x[1]};
    state_at(table, p, x, over, state);
}

/* ---- coverage and interpolation error ---- */

enum status user_table_check(const struct user_table *table, const struct prepared *p,
                             struct error *error)
{
    static const char *const coordinates[] = {"x", "x and y", "r"};
    const int dim = p->domain.dim;
    if (table->over == OVER_XY && dim < 2)
        return error_set(error, STATUS_BAD_INPUT,
                         "%.200s: a table over x and y in 1D; allowed: over x or r", table->path);
    if (table->value[VPHI] && dim != 2)
        return error_set(error, STATUS_BAD_INPUT, "%.200s: vphi has a meaning in 2D only",
                         table->path);
    for (int corner = 0; corner < 1 << dim; corner++) {
        double x[3] = {0};
        for (int d = 0; d < dim; d++) {
            x[d] = corner & 1 << d ? p->window.hi[d] : p->window.lo[d];
            if (p->window.radius > 0)
                x[d] = p->window.centre[d] + (corner & 1 << d ? 1 : -1) * p->window.radius;
        }
        double over[2] = {x[0], x[1]};
        if (table->over == OVER_R)
            over[0] = corner == 0            ? 0
                      : p->window.radius > 0 ? p->window.radius
                                             : problem_radius(p, x);
        if (spot_at(table, p, over).inside) continue;
        return error_set(error, STATUS_BAD_INPUT,
                         "%.160s: its rows over %s, from %.6g to %.6g%s, do not cover the window: "
                         "%s = %.6g is in that",
                         table->path, coordinates[table->over], table->axis[0][0],
                         table->axis[0][table->n[0] - 1], table->over == OVER_XY ? " along x" : "",
                         table->over == OVER_R ? "r" : "x", over[0]);
    }
    return STATUS_OK;
}

/* A table of every second row along each axis; NULL: too few rows, or no memory. */
static struct user_table *thin(const struct user_table *table)
{
    struct user_table *half = calloc(1, sizeof *half);
    bool good = half && table->n[0] >= 4 && (table->n[1] == 1 || table->n[1] >= 4);
    if (!half) return NULL;
    half->over = table->over;
    for (int a = 0; a < 2; a++) {
        half->n[a] = (table->n[a] + 1) / 2;
        half->axis[a] = good ? malloc(half->n[a] * sizeof(double)) : NULL;
        good = good && half->axis[a];
        for (size_t i = 0; good && i < half->n[a]; i++) half->axis[a][i] = table->axis[a][2 * i];
    }
    for (int c = 0; c < COLUMNS && good; c++) {
        if (!table->value[c]) continue;
        half->value[c] = malloc(half->n[0] * half->n[1] * sizeof(double));
        good = half->value[c];
        for (size_t i = 0; good && i < half->n[0]; i++)
            for (size_t j = 0; j < half->n[1]; j++)
                half->value[c][i * half->n[1] + j] = table->value[c][2 * i * table->n[1] + 2 * j];
    }
    if (good && make_curves(half)) return half;
    user_table_free(half);
    return NULL;
}

static double width_of(const double *axis, size_t n, size_t i)
{
    if (n < 2) return 1;
    return 0.5 * (axis[i + 1 < n ? i + 1 : i] - axis[i > 0 ? i - 1 : i]);
}

/* Position of a row; on the x axis for a table over r. */
static void row_position(const struct user_table *table, const struct prepared *p, size_t i,
                         size_t j, double at[3])
{
    for (int d = 0; d < 3; d++) at[d] = p->window.centre[d];
    at[0] = table->over == OVER_R ? p->window.centre[0] + table->axis[0][i] : table->axis[0][i];
    if (table->over == OVER_XY) at[1] = table->axis[1][j];
}

struct missed {
    double sum[FIELDS], weight;
};

/* Adds the differences between the values of the full and of the thinned table. */
static void add_missed(struct missed *missed, const struct prepared *p, double weight,
                       const struct problem_state *whole, const struct problem_state *less)
{
    double squares = 0;
    for (int d = 0; d < p->domain.dim; d++)
        squares += (whole->v[d] - less->v[d]) * (whole->v[d] - less->v[d]);
    for (int f = 0; f < FIELDS; f++)
        missed->sum[f] += weight * (f == FIELD_VELOCITY ? sqrt(squares)
                                                        : fabs(problem_field(whole, (enum field)f) -
                                                               problem_field(less, (enum field)f)));
    missed->weight += weight;
}

static void miss_rows(const struct user_table *table, const struct user_table *half,
                      const struct prepared *p, struct missed *missed)
{
    for (size_t i = 0; i < table->n[0]; i++)
        for (size_t j = 0; j < table->n[1]; j++) {
            const double over[2] = {table->axis[0][i], table->axis[1][j]};
            struct problem_state whole, less;
            double at[3];
            if (i % 2 == 0 && j % 2 == 0) continue;
            row_position(table, p, i, j, at);
            if (!window_contains(&p->window, at)) continue;
            state_at(table, p, at, over, &whole);
            state_at(half, p, at, over, &less);
            add_missed(missed, p,
                       width_of(table->axis[0], table->n[0], i) *
                           width_of(table->axis[1], table->n[1], j) *
                           (table->over == OVER_R ? pow(over[0], p->domain.dim - 1) : 1),
                       &whole, &less);
        }
}

static void miss_particles(const struct user_table *table, const struct user_table *half,
                           const struct prepared *p, const struct snapshot *s,
                           struct missed *missed)
{
    for (size_t i = 0; i < s->n; i++) {
        struct problem_state whole, less;
        const double part = problem_window_part(p, s, i);
        double position[3];
        if (!(part > 0)) continue;
        problem_position(p, s, i, position);
        user_table_sample(table, p, position, &whole);
        user_table_sample(half, p, position, &less);
        add_missed(missed, p, part, &whole, &less);
    }
}

void user_table_error(const struct user_table *table, const struct prepared *p,
                      const struct snapshot *s, double miss[FIELDS])
{
    struct user_table *half = thin(table);
    struct missed rows = {.weight = 0}, particles = {.weight = 0};
    if (half) miss_rows(table, half, p, &rows);
    if (half) miss_particles(table, half, p, s, &particles);
    for (int f = 0; f < FIELDS; f++)
        miss[f] = rows.weight > 0 && user_table_knows(table, (enum field)f)
                      ? fmax(rows.sum[f] / rows.weight, particles.sum[f] / particles.weight)
                      : (double)NAN;
    user_table_free(half);
}
