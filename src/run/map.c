/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "map.h"

#include <math.h>
#include <stdlib.h>

/* Number of cells in a row: as many as particles fit. */
static size_t cells_along(double length, double spacing, size_t most)
{
    const size_t fit = (size_t)fmin(round(length / spacing), (double)most);
    return fit ? fit : 1;
}

static void bin_particle(struct map *map, const struct domain *domain, const struct snapshot *s,
                         size_t i)
{
    const size_t cells[2] = {map->nx, map->ny};
    size_t at[2];
    map->cell[i] = map->nx * map->ny;
    if (domain->dim == 3 && !(s->x[2][i] >= map->slice[0] && s->x[2][i] < map->slice[1])) return;
    for (int d = 0; d < 2; d++) {
        const double x = s->x[d][i];
        if (!(x >= map->lo[d] && x <= map->hi[d])) return;
        at[d] = (size_t)((x - map->lo[d]) / (map->hi[d] - map->lo[d]) * (double)cells[d]);
        if (at[d] >= cells[d]) at[d] = cells[d] - 1;
    }
    map->cell[i] = at[1] * map->nx + at[0];
    map->count[map->cell[i]]++;
    map->seen++;
}

/* Counts particle i in the cells whose centres are within its h. */
static void cover(struct map *map, const struct snapshot *s, size_t i)
{
    if (map->cell[i] == map->nx * map->ny) return;
    const double h = s->h[i], wide = (map->hi[0] - map->lo[0]) / (double)map->nx,
                 high = (map->hi[1] - map->lo[1]) / (double)map->ny;
    const ptrdiff_t column = (ptrdiff_t)(map->cell[i] % map->nx),
                    row = (ptrdiff_t)(map->cell[i] / map->nx),
                    across = (ptrdiff_t)fmin(h / wide + 1, MAP_REACH),
                    along = (ptrdiff_t)fmin(h / high + 1, MAP_REACH);
    for (ptrdiff_t b = row - along; b <= row + along; b++)
        for (ptrdiff_t a = column - across; a <= column + across; a++)
            if (a >= 0 && b >= 0 && a < (ptrdiff_t)map->nx && b < (ptrdiff_t)map->ny &&
                hypot(map->x[a] - s->x[0][i], map->y[b] - s->x[1][i]) <= h)
                map->covered[(size_t)b * map->nx + (size_t)a]++;
}

static void set_centres(double *x, size_t n, double lo, double length)
{
    for (size_t k = 0; k < n; k++) x[k] = lo + length * ((double)k + 0.5) / (double)n;
}

enum status map_create(struct map *map, const struct domain *domain, const struct snapshot *s,
                       size_t most, struct error *error)
{
    *map = (struct map){.n = s->n};
    const double spacing = domain_spacing(domain, s->n);
    for (int d = 0; d < 2; d++) map->lo[d] = domain->lo[d], map->hi[d] = domain->hi[d];
    if (domain->dim == 3) {
        const double middle = (domain->lo[2] + domain->hi[2]) / 2;
        map->slice[0] = middle - spacing;
        map->slice[1] = middle + spacing;
    }
    map->nx = cells_along(domain_length(domain, 0), spacing, most);
    map->ny = cells_along(domain_length(domain, 1), spacing, most);
    const size_t cells = map->nx * map->ny;
    _Static_assert(sizeof(size_t) <= sizeof(double), "numbers of cells fit");
    double *centres = map->storage = calloc(map->nx + map->ny + 2 * cells + s->n, sizeof(double));
    if (!centres) return error_set(error, STATUS_ENVIRONMENT, "no memory for a map");
    map->x = centres;
    map->y = centres + map->nx;
    map->count = (size_t *)(void *)(centres + map->nx + map->ny);
    map->covered = map->count + cells;
    map->cell = map->covered + cells;
    set_centres(map->y, map->ny, map->lo[1], domain_length(domain, 1));
    set_centres(map->x, map->nx, map->lo[0], domain_length(domain, 0));
    for (size_t i = 0; i < s->n; i++) {
        bin_particle(map, domain, s, i);
        cover(map, s, i);
    }
    return STATUS_OK;
}

void map_free(struct map *map)
{
    free(map->storage);
    map->storage = NULL;
}

/* Mean over the occupied cells that are at most `reach` cells from (i, j) in either direction; NaN:
 * none is. */
static double mean_around(const struct map *map, const double *z, ptrdiff_t i, ptrdiff_t j,
                          ptrdiff_t reach)
{
    double sum = 0, n = 0;
    for (ptrdiff_t b = j - reach; b <= j + reach; b++)
        for (ptrdiff_t a = i - reach; a <= i + reach; a++) {
            if (a < 0 || b < 0 || a >= (ptrdiff_t)map->nx || b >= (ptrdiff_t)map->ny) continue;
            const size_t k = (size_t)b * map->nx + (size_t)a;
            if (map->count[k]) sum += z[k], n++;
        }
    return sum / n;
}

void map_mean(const struct map *map, const double *values, double *z)
{
    const size_t cells = map->nx * map->ny;
    for (size_t k = 0; k < cells; k++) z[k] = 0;
    for (size_t i = 0; i < map->n; i++)
        if (map->cell[i] < cells) z[map->cell[i]] += values[i] / (double)map->count[map->cell[i]];
    for (size_t k = 0; k < cells; k++) {
        if (map->count[k]) continue;
        z[k] = (double)NAN;
        for (ptrdiff_t reach = 0; map->covered[k] && reach < MAP_REACH && isnan(z[k]);)
            z[k] = mean_around(map, z, (ptrdiff_t)(k % map->nx), (ptrdiff_t)(k / map->nx), ++reach);
    }
}
