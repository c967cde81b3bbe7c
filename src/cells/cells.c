/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cells.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "lanes.h"
#include "matrix.h"
#include "pages.h"
#include "plan.h"
#include "specialise.h"
#include "team.h"

struct cells_method cells_method_of(const struct scheme *scheme, const struct plan *plan)
{
    return (struct cells_method){
        .box.dim = plan->dim,
        .kernel = &scheme->kernel,
        .specialised = plan->specialised,
        .gradient = scheme->gradient,
        .formulation = scheme->formulation,
        .pair_width = scheme->pair_width,
        .energy = scheme->energy,
        .energy_element = plan->energy_sum,
        .number = scheme->volume_element == VOLUME_NUMBER,
        .viscosity = scheme->viscosity,
        .signal_form = viscosity_of[scheme->viscosity].noise ||
                       scheme->viscosity_form == VISCOSITY_FORM_SIGNAL,
        .balsara = plan->balsara,
        .velocity_gradient = plan->slope,
        .div_v = plan->alpha,
        .shift = plan->shift,
        .closed = plan->closed,
        .conductivity = scheme->alpha_u,
        .shock_conductivity = scheme->shock_conductivity,
        .worst_condition = DESCRIPTION_CONDITION,
        .local = plan->local,
        .alpha_min = scheme->alpha_min,
        .alpha_max = scheme->alpha_max,
        .numbers = {.alpha = scheme->alpha,
                    .beta = scheme->beta,
                    .beta_ratio = scheme->alpha > 0 ? scheme->beta / scheme->alpha : 2,
                    .near = 1 / scheme->eta,
                    .noise = scheme->noise},
    };
}

static void add_field(struct lanes_layout *layout, enum lanes_field field, int values)
{
    layout->offset[field] = layout->used;
    layout->used += values;
    layout->size = (layout->used + GATHER_GROUP - 1) / GATHER_GROUP * GATHER_GROUP;
}

static void add_numbers(struct lanes_layout *layout, enum lanes_field first, enum lanes_field last)
{
    for (int field = (int)first; field <= (int)last; field++)
        add_field(layout, (enum lanes_field)field, 1);
}

static void begin_layout(struct lanes_layout *layout, enum lanes_geometry geometry, int dim)
{
    *layout = (struct lanes_layout){.geometry = geometry};
    add_field(layout, RECORD_POSITION, dim);
}

static void lay_out_force(struct lanes_layout *force, const struct cells_method *method)
{
    const int dim = method->box.dim, symmetric = dim * (dim + 1) / 2;
    const struct viscosity_descriptor *viscosity = &viscosity_of[method->viscosity];
    const struct gradient_descriptor *gradient = &gradient_of[method->gradient];
    const bool conducts = cells_conduct(method), dissipates = !viscosity->none || conducts,
               lagrangian = method->formulation == FORMULATION_LAGRANGIAN;
    begin_layout(force, LANES_CLOSING, dim);
    if (dissipates || lagrangian) add_field(force, RECORD_WEIGHT, 1);
    add_field(force, RECORD_VELOCITY, dim);
    add_field(force, RECORD_H_INVERSE, 1);
    add_numbers(force, RECORD_VOLUME, RECORD_SOUND);
    if (dissipates || method->shift) add_field(force, RECORD_DENSITY, 1);
    if (viscosity_varies(method->viscosity)) add_field(force, RECORD_ALPHA, 1);
    if (method->balsara) add_field(force, RECORD_BALSARA, 1);
    if (conducts || method->shift) add_field(force, RECORD_HEAT, 1);
    if (method->shift) add_field(force, RECORD_SHIFT, dim);
    if (method->closed) add_field(force, RECORD_POTENTIAL, dim);
    if (lagrangian) add_field(force, RECORD_LAGRANGIAN, 3);
    if (gradient->weight != WEIGHT_NONE) add_field(force, RECORD_MATRIX, symmetric);
    if (gradient->share) add_field(force, RECORD_STEEP, 1);
    if (viscosity->midpoint || viscosity->noise) add_field(force, RECORD_SLOPE, dim * dim);
    if (viscosity->noise) add_field(force, RECORD_PROJECTOR, symmetric);
}

/* Chooses the neighbour values that each pass needs. */
static void lay_out(struct cells *cells)
{
    const struct cells_method *method = &cells->method;
    const struct gradient_descriptor *gradient = &gradient_of[method->gradient];
    const int dim = method->box.dim;
    begin_layout(&cells->density, LANES_DISTANCE, dim);
    add_field(&cells->density, RECORD_WEIGHT, 1);
    if (method->energy_element) add_field(&cells->density, RECORD_ENERGY, 1);
    begin_layout(&cells->matrix, gradient->weight > WEIGHT_W ? LANES_DIRECTION : LANES_DISPLACEMENT,
                 dim);
    add_field(&cells->matrix, RECORD_WEIGHT, 1);
    if (method->velocity_gradient) add_field(&cells->matrix, RECORD_VELOCITY, dim);
    if (gradient->share) add_field(&cells->matrix, RECORD_H, 1);
    lay_out_force(&cells->force, method);
    cells->shift = (struct lanes_layout){0};
    if (!viscosity_of[method->viscosity].find_goal) return;
    begin_layout(&cells->shift, LANES_DIRECTION, dim);
    add_field(&cells->shift, RECORD_WEIGHT, 1);
    add_field(&cells->shift, RECORD_VELOCITY, dim);
    add_field(&cells->shift, RECORD_H_INVERSE, 1);
    add_field(&cells->shift, RECORD_VOLUME, 1);
    add_field(&cells->shift, RECORD_SOUND, 1);
    add_field(&cells->shift, RECORD_ACCELERATION, dim);
}

/* True if each pair force is computed once for both particles. Reactions carry only force, energy
 * and signal speed; and where pairs are few and cheap, they cost as much as they save (measured
 * with 20 to 30 neighbours). */
static bool method_halves(const struct cells_method *method)
{
    const struct viscosity_descriptor *viscosity = &viscosity_of[method->viscosity];
    const bool costly = viscosity->midpoint || viscosity->noise,
               many = width_neighbours(method->box.dim, 1 / method->numbers.near) > 36;
    return !method->div_v && (costly || many);
}

double cells_bytes(const struct cells_method *method, double n, double neighbours)
{
    struct cells cells = {.method = *method};
    lay_out(&cells);
    return n * (lanes_longest_record(&cells) * (double)sizeof(double) +
                (method_halves(method) ? reactions_bytes(cells_reaction_values(method)) : 0)) +
           grid_bytes(method->box.dim, n, neighbours);
}

static bool reserve_records(struct cells *cells, size_t n)
{
    if (n + 1 <= cells->capacity) return true;
    free(cells->records);
    free(cells->kinds);
    free(cells->paces);
    const size_t size = (size_t)lanes_longest_record(cells);
    cells->capacity = n + n / 4 + 8;
    cells->records = pages_allocate(cells->capacity * size * sizeof(double));
    cells->kinds = cells->method.local ? malloc(cells->capacity) : NULL;
    cells->paces = cells->method.local ? malloc(cells->capacity * sizeof(double)) : NULL;
    const bool reactions =
        !cells->halves || reactions_reserve(&cells->reactions,
                                            cells_reaction_values(&cells->method), cells->capacity);
    if (!cells->records || (cells->method.local && (!cells->kinds || !cells->paces)) || !reactions)
        cells->capacity = 0;
    return cells->capacity > 0;
}

struct cells *cells_create(const struct cells_method *method, size_t n)
{
    struct cells *cells = calloc(1, sizeof *cells);
    if (!cells) return NULL;
    cells->method = *method;
    cells->pair_level = -1;
    cells->team = method->threads;
    cells->shapes = shapes_of(method->kernel, method->box.dim, method->specialised);
    cells->own_w = method->kernel->w(method->kernel, 0, method->box.dim);
    cells->halves = method_halves(method);
    lay_out(cells);
    struct lanes_layout *const layouts[] = {&cells->density, &cells->matrix, &cells->force,
                                            &cells->shift};
    for (int k = 0; k < 4; k++) layouts[k]->gather = gather_choose(layouts[k]->size);
    cells->grid = grid_create(&method->box, n, method->threads);
    cells->lanes = team_allocate(method->threads, sizeof *cells->lanes);
    if (cells->grid && cells->lanes && reserve_records(cells, n)) return cells;
    cells_destroy(cells);
    return NULL;
}

void cells_destroy(struct cells *cells)
{
    if (!cells) return;
    for (int t = 0; cells->lanes && t < cells->method.threads; t++) {
        free(cells->lanes[t].block);
        free(cells->lanes[t].slots);
        grid_reader_free(&cells->lanes[t].reader);
    }
    free(cells->lanes);
    free(cells->records);
    free(cells->kinds);
    free(cells->paces);
    free(cells->images.source);
    free(cells->images.mirrored);
    free(cells->images.radius);
    for (int a = 0; a < 3; a++) free(cells->images.x[a]);
    reactions_free(&cells->reactions);
    grid_destroy(cells->grid);
    free(cells);
}

void cells_team(struct cells *cells, int size)
{
    cells->team = size;
    grid_team(cells->grid, size);
}

struct cells_left_out cells_left_out(struct cells *cells)
{
    struct cells_left_out sum = {0};
    for (int t = 0; t < cells->method.threads; t++) {
        sum.viscosity += cells->lanes[t].left_out.viscosity;
        sum.slope += cells->lanes[t].left_out.slope;
        sum.conductivity += cells->lanes[t].left_out.conductivity;
        cells->lanes[t].left_out = (struct cells_left_out){0};
    }
    return sum;
}

size_t cells_points(const struct cells *cells)
{
    return cells->points;
}

const struct grid *cells_grid(const struct cells *cells)
{
    return cells->grid;
}

static bool reserve_images(struct cells_images *images, size_t points)
{
    if (points <= images->capacity) return true;
    const size_t capacity = points + points / 2;
    double *x[4] = {images->x[0], images->x[1], images->x[2], images->radius};
    bool there = true;
    for (int a = 0; a < 4; a++) {
        double *grown = realloc(x[a], capacity * sizeof *grown);
        there &= grown != NULL;
        if (grown) *(a < 3 ? &images->x[a] : &images->radius) = grown;
    }
    uint32_t *source = realloc(images->source, capacity * sizeof *source);
    if (source) images->source = source;
    unsigned char *mirrored = realloc(images->mirrored, capacity);
    if (mirrored) images->mirrored = mirrored;
    if (!there || !source || !mirrored) return false;
    images->capacity = capacity;
    return true;
}

/* Adds the wall images along one axis of all points so far, including the images of earlier walls,
 * so that corners get images, too. */
static bool mirror(struct cells *cells, size_t n, int axis, double reach)
{
    struct cells_images *images = &cells->images;
    const double wall[2] = {cells->method.box.lo[axis], cells->method.box.hi[axis]};
    const size_t before = n + images->count;
    for (size_t p = 0; p < before; p++)
        for (int end = 0; end < 2; end++) {
            const double x = images->x[axis][p];
            if (!(fabs(x - wall[end]) < reach)) continue;
            const size_t next = n + images->count;
            if (!reserve_images(images, next + 1)) return false;
            for (int a = 0; a < 3; a++) images->x[a][next] = images->x[a][p];
            images->x[axis][next] = 2 * wall[end] - x;
            images->radius[next] = images->radius[p];
            images->source[images->count] = p < n ? (uint32_t)p : images->source[p - n];
            images->mirrored[images->count] =
                (unsigned char)((p < n ? 0 : images->mirrored[p - n]) | 1 << axis);
            images->count++;
        }
    return true;
}

/* Lists all points: the particles, then their wall images. */
static bool find_images(struct cells *cells, const struct cells_fields *fields,
                        const double *radius)
{
    struct cells_images *images = &cells->images;
    const size_t n = fields->n;
    double reach = 0;
    images->count = 0;
    if (!reserve_images(images, n)) return false;
    for (size_t i = 0; i < n; i++) {
        images->radius[i] = radius[i];
        reach = largest(reach, radius[i]);
    }
    for (int a = 0; a < 3; a++)
        for (size_t i = 0; i < n; i++)
            images->x[a][i] = a < cells->method.box.dim ? fields->x[a][i] : 0;
    for (int a = 0; a < cells->method.box.dim; a++)
        if (cells->method.wall[a] && !mirror(cells, n, a, reach)) return false;
    return true;
}

enum status cells_arrange(struct cells *cells, const struct cells_fields *fields,
                          const double *radius, const unsigned char *parts, struct error *error)
{
    const bool walls = cells->method.wall[0] || cells->method.wall[1] || cells->method.wall[2];
    const struct cells_images *images = &cells->images;
    if (walls && !find_images(cells, fields, radius))
        return error_set(error, STATUS_ENVIRONMENT, "no memory for %zu particles", fields->n);
    cells->points = fields->n + images->count;
    const double *const all[3] = {images->x[0], images->x[1], images->x[2]};
    const enum status status =
        grid_search(cells->grid, cells->points, fields->n, walls ? all : fields->x,
                    walls ? images->radius : radius, parts, error);
    if (status) return status;
    cells->parts = fields->local ? parts : NULL;
    cells->lists = grid_lists(cells->grid);
    cells->position = grid_positions(cells->grid);
    cells->order = grid_order(cells->grid);
    for (int a = 0; a < 3; a++)
        cells->side[a] = grid_side(cells->grid, a) > 0 ? grid_side(cells->grid, a) : HUGE_VAL;
    if (!reserve_records(cells, cells->points) || !lanes_reserve(cells))
        return error_set(error, STATUS_ENVIRONMENT, "no memory for %zu particles", fields->n);
    return STATUS_OK;
}

/* x: vector from slot a to slot b, to the nearest periodic image if wrapped. Returns its squared
 * length. */
ALWAYS_INLINE double separate(int dim, bool wrapped, const struct cells *cells, size_t a, size_t b,
                              double x[3])
{
    double r2 = 0;
    for (int k = 0; k < dim; k++) {
        const double side = cells->side[k];
        x[k] = cells->position[b][k] - cells->position[a][k];
        if (wrapped) x[k] = grid_nearest(x[k], side);
        r2 += x[k] * x[k];
    }
    return r2;
}

static double condition_of(const struct cells *cells, const struct cells_fields *fields, size_t i,
                           double C[CELLS_SQUARE])
{
    const int dim = cells->method.box.dim;
    if (gradient_of[cells->method.gradient].weight == WEIGHT_NONE) return nan("");
    for (int a = 0; a < dim; a++)
        for (int b = 0; b < dim; b++) C[a * dim + b] = fields->matrix[symmetric_at(dim, a, b)][i];
    if (!(fields->condition[i] <= cells->method.worst_condition)) return fields->condition[i];
    return matrix_condition(dim, C); /* the matrix and its inverse have the same condition number */
}

double cells_distance2(const struct cells *cells, size_t a, size_t b)
{
    double x[3];
    return separate(cells->method.box.dim, cells->lists[a].wrapped, cells, a, b, x);
}

/* A batch of neighbours: vectors (x, y, z) from the particle, their length over h, and cot |cot| of
 * the angle by which C turns them, which needs no square root. */
enum { AT_ONCE = 64 };

struct directions {
    double x[AT_ONCE], y[AT_ONCE], z[AT_ONCE], distance[AT_ONCE], cot2[AT_ONCE];
};

ALWAYS_INLINE void find_angles(int dim, int count, double h_inverse, const double *restrict C,
                               struct directions *restrict at)
{
#pragma omp simd
    for (int k = 0; k < count; k++) {
        const double a = at->x[k], b = at->y[k], c = dim == 3 ? at->z[k] : 0;
        const double p = dim == 3 ? C[0] * a + C[1] * b + C[2] * c : C[0] * a + C[1] * b,
                     q = dim == 3 ? C[3] * a + C[4] * b + C[5] * c : C[2] * a + C[3] * b,
                     r = dim == 3 ? C[6] * a + C[7] * b + C[8] * c : 0;
        const double dot = p * a + q * b + r * c, u = q * c - r * b, v = r * a - p * c,
                     w = p * b - q * a;
        at->distance[k] = sqrt(a * a + b * b + c * c) * h_inverse;
        at->cot2[k] = dot * fabs(dot) / (u * u + v * v + w * w);
    }
}

CLONES static void find_angles_2(int count, double h_inverse, const double *C,
                                 struct directions *at)
{
    find_angles(2, count, h_inverse, C, at);
}

CLONES static void find_angles_3(int count, double h_inverse, const double *C,
                                 struct directions *at)
{
    find_angles(3, count, h_inverse, C, at);
}

ALWAYS_INLINE void describe_neighbours(int dim, const struct cells *cells, size_t slot,
                                       double h_inverse, const double C[CELLS_SQUARE], bool used,
                                       struct grid_reader *reader, struct description *of)
{
    const struct grid_list *list = &cells->lists[slot];
    const int32_t *slots = /* inactive particles have no list */
        list->kept ? grid_neighbours(cells->grid, reader, cells->lists, slot) : NULL;
    struct directions at;
    double least = HUGE_VAL;
    for (int32_t from = 0; from < list->count; from += AT_ONCE) {
        const int count = list->count - from < AT_ONCE ? list->count - from : AT_ONCE;
        for (int k = 0; k < count; k++) {
            double x[3] = {0};
            (void)separate(dim, list->wrapped, cells, slot, (size_t)slots[from + k], x);
            at.x[k] = x[0], at.y[k] = x[1], at.z[k] = x[2];
        }
        (dim == 2 ? find_angles_2 : find_angles_3)(count, h_inverse, C, &at);
        for (int k = 0; k < count; k++) {
            if (!(at.distance[k] < 1)) continue;
            of->neighbours++;
            if (at.cot2[k] < least) least = at.cot2[k]; /* NaN if the two coincide */
        }
    }
    of->angle = used && of->neighbours > 1
                    ? atan2(1, copysign(sqrt(fabs(least)), least)) * (180 / M_PI)
                    : nan("");
}

static struct description describe(const struct cells *cells, const struct cells_fields *fields,
                                   size_t slot, size_t i, struct grid_reader *reader)
{
    double C[CELLS_SQUARE] = {0};
    struct description of = {.neighbours = 1, .condition = condition_of(cells, fields, i, C)};
    const bool used = of.condition <= cells->method.worst_condition;
    if (cells->method.box.dim == 2)
        describe_neighbours(2, cells, slot, fields->h_inverse[i], C, used, reader, &of);
    else
        describe_neighbours(3, cells, slot, fields->h_inverse[i], C, used, reader, &of);
    return of;
}

void cells_describe(const struct cells *cells, const struct cells_fields *fields,
                    description_visit *visit, void *context)
{
    enum { DESCRIBED = 1024 }; /* particles in one parallel batch */
    struct description of[DESCRIBED];
    for (size_t first = 0; first < cells->points; first += DESCRIBED) {
        const size_t left = cells->points - first, count = left < DESCRIBED ? left : DESCRIBED;
        const uint32_t *order = cells->order + first;
#pragma omp parallel for num_threads(cells->team) schedule(dynamic, 64) if (cells->team > 1)
        for (size_t k = 0; k < count; k++)
            if (order[k] < fields->n)
                of[k] = describe(cells, fields, first + k, order[k],
                                 &cells->lanes[team_thread()].reader);
        for (size_t k = 0; k < count; k++)
            if (order[k] < fields->n) visit(context, order[k], &of[k]);
    }
}
