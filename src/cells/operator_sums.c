/* SPDX-License-Identifier: GPL-3.0-or-later
 * Gradients by blocks of points: the candidates of a block are gathered once, and each of its
 * points selects its neighbours among them. */
#include "operator_sums.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>

#include "matrix.h"
#include "specialise.h"

/* Sums use LANES partial sums on every instruction set, so that results are identical. */
enum { LANES = 8 };
typedef double lanes __attribute__((vector_size(LANES * sizeof(double)), aligned(8), may_alias));

#define LANES_SUM(s) (((s[0] + s[4]) + (s[2] + s[6])) + ((s[1] + s[5]) + (s[3] + s[7])))

/* Work arrays of one thread for the neighbours of one point, filled up to a multiple of LANES with
 * neighbours of weight 0. Lengths are in units of h. */
struct work {
    struct candidates candidates;
    size_t capacity;
    double *memory;
    double *distance2, *x[3], *q, *v, *w, *dw, *p[3], *f;
    uint32_t *list, *j;
};
enum { WORK_ARRAYS = 12 };

static bool work_reserve(struct work *work)
{
    const size_t need = work->candidates.n + LANES;
    if (need <= work->capacity) return true;
    const size_t n = work->candidates.capacity + LANES;
    free(work->memory), free(work->list), free(work->j);
    work->memory = malloc(WORK_ARRAYS * n * sizeof(double));
    work->list = malloc(n * sizeof *work->list);
    work->j = malloc(n * sizeof *work->j);
    work->capacity = 0;
    if (!work->memory || !work->list || !work->j) return false;
    double **const arrays[WORK_ARRAYS] = {&work->distance2, &work->x[0], &work->x[1], &work->x[2],
                                          &work->q,         &work->v,    &work->w,    &work->dw,
                                          &work->p[0],      &work->p[1], &work->p[2], &work->f};
    for (size_t a = 0; a < WORK_ARRAYS; a++) *arrays[a] = work->memory + a * n;
    work->capacity = n;
    return true;
}

static void work_free(struct work *work)
{
    neighbours_candidates_free(&work->candidates);
    free(work->memory), free(work->list), free(work->j);
}

/* Distance of a coordinate from an interval. */
ALWAYS_INLINE double gap(double lo, double hi, double at)
{
    return largest(largest(lo - at, at - hi), 0);
}

/* Squared distances from a point to the boxes of candidate blocks. */
ALWAYS_INLINE void box_distances(int dim, const struct candidates *c, const double *at,
                                 double *restrict distance2)
{
    const size_t blocks = c->n / NEIGHBOURS_BLOCK;
    const double *restrict lx = c->lo[0], *restrict ly = c->lo[1], *restrict lz = c->lo[2];
    const double *restrict hx = c->hi[0], *restrict hy = c->hi[1], *restrict hz = c->hi[2];
#pragma omp simd
    for (size_t b = 0; b < blocks; b++) {
        const double x = gap(lx[b], hx[b], at[0]), y = dim > 1 ? gap(ly[b], hy[b], at[1]) : 0,
                     z = dim > 2 ? gap(lz[b], hz[b], at[2]) : 0;
        distance2[b] = x * x + y * y + z * z;
    }
}

/* Fills list and distance2 with the candidates whose squared distance is at most limit, block by
 * block. Returns their number. Appends without branches. */
ALWAYS_INLINE size_t list_neighbours(int dim, struct work *work, const double *at, double limit)
{
    const struct candidates *c = &work->candidates;
    const double *restrict cx = c->x[0], *restrict cy = c->x[1], *restrict cz = c->x[2];
    double *restrict box2 = work->w, *restrict distance2 = work->distance2;
    uint32_t *restrict list = work->list, *restrict near = work->j;
    size_t n = 0, near_count = 0;
    box_distances(dim, c, at, box2);
    for (size_t b = 0; b < c->n / NEIGHBOURS_BLOCK; b++) {
        near[near_count] = (uint32_t)b;
        near_count += box2[b] > limit ? 0u : 1u;
    }
    for (size_t k = 0; k < near_count; k++) {
        const size_t first = near[k] * (size_t)NEIGHBOURS_BLOCK;
        double r2[NEIGHBOURS_BLOCK];
#pragma omp simd
        for (size_t l = 0; l < NEIGHBOURS_BLOCK; l++) {
            const double x = cx[first + l] - at[0];
            r2[l] = x * x;
            if (dim > 1) r2[l] += (cy[first + l] - at[1]) * (cy[first + l] - at[1]);
            if (dim > 2) r2[l] += (cz[first + l] - at[2]) * (cz[first + l] - at[2]);
        }
        for (size_t l = 0; l < NEIGHBOURS_BLOCK; l++) {
            list[n] = (uint32_t)(first + l);
            distance2[n] = r2[l];
            n += r2[l] > limit ? 0u : 1u;
        }
    }
    return n;
}

struct selection {
    size_t n; /* neighbours with fillings */
    uint32_t inside;
};

/* Fills j, x, q, v with the neighbours of a point. inside: number with r < h. */
ALWAYS_INLINE struct selection select_neighbours(int dim, const struct operator_task *task,
                                                 struct work *work, const double *at, double h,
                                                 uint32_t self)
{
    const struct candidates *c = &work->candidates;
    const double *restrict distance2 = work->distance2;
    const uint32_t *restrict list = work->list;
    /* finite, so that fillings are excluded */
    size_t n = list_neighbours(dim, work, at, fmin(h * h * (1 + 1e-12), DBL_MAX));
    const double inverse = 1 / h;
    const double *restrict volume = task->volume;
    double *restrict q = work->q, *restrict v = work->v;
    uint32_t *restrict j = work->j, count = 0;
    for (size_t m = 0; m < n; m++) {
        const uint32_t k = list[m];
        for (int a = 0; a < dim; a++) work->x[a][m] = (c->x[a][k] - at[a]) * inverse;
        j[m] = c->j[k];
        v[m] = volume[j[m]];
    }
#pragma omp simd reduction(+ : count)
    for (size_t m = 0; m < n; m++) {
        const double r = sqrt(distance2[m]);
        q[m] = r * inverse;
        count += r < h ? 1u : 0u;
    }
    for (; n % (size_t)LANES; n++) {
        for (int a = 0; a < dim; a++) work->x[a][n] = 0;
        q[n] = 1, v[n] = 0, j[n] = self;
    }
    return (struct selection){n, count};
}

/* sum a_m b_m */
ALWAYS_INLINE double sum_products(size_t n, const double *a, const double *b)
{
    lanes s = {0};
    for (size_t m = 0; m < n; m += LANES) s += *(const lanes *)(a + m) * *(const lanes *)(b + m);
    return LANES_SUM(s);
}

ALWAYS_INLINE void sum_vector(int dim, size_t n, double *const *p, const double *f, double *sum)
{
    lanes s[3] = {{0}};
    for (size_t m = 0; m < n; m += LANES)
        for (int a = 0; a < dim; a++) s[a] += *(const lanes *)(p[a] + m) * *(const lanes *)(f + m);
    for (int a = 0; a < dim; a++) sum[a] = LANES_SUM(s[a]);
}

/* sum p (x) x: row p, column x */
ALWAYS_INLINE void sum_matrix(int dim, size_t n, double *const *p, double *const *x, double *sum)
{
    lanes s[9] = {{0}};
    for (size_t m = 0; m < n; m += LANES)
        for (int a = 0; a < dim; a++)
            for (int b = 0; b < dim; b++)
                s[a * dim + b] += *(const lanes *)(p[a] + m) * *(const lanes *)(x[b] + m);
    for (int a = 0; a < dim * dim; a++) sum[a] = LANES_SUM(s[a]);
}

/* p = V x w */
ALWAYS_INLINE void position_vectors(int dim, size_t n, struct work *work)
{
    for (int a = 0; a < dim; a++) {
        double *restrict p = work->p[a];
        const double *restrict x = work->x[a], *restrict v = work->v, *restrict w = work->w;
#pragma omp simd
        for (size_t m = 0; m < n; m++) p[m] = v[m] * w[m] * x[m];
    }
}

/* p = -V (x/q) dw/dq; one division for each pair; the slope replaces dw */
ALWAYS_INLINE void gradient_vectors(int dim, size_t n, struct work *work)
{
    const double *restrict v = work->v, *restrict q = work->q;
    double *restrict slope = work->dw;
#pragma omp simd
    for (size_t m = 0; m < n; m++) slope[m] = q[m] > 0 ? -v[m] * slope[m] / q[m] : 0;
    for (int a = 0; a < dim; a++) {
        double *restrict p = work->p[a];
        const double *restrict x = work->x[a];
#pragma omp simd
        for (size_t m = 0; m < n; m++) p[m] = slope[m] * x[m];
    }
}

/* From V grad w to V grad (w/S) = (V grad w - (V w/S) sum V grad w)/S. */
ALWAYS_INLINE void normalise_vectors(int dim, size_t n, struct work *work)
{
    const double *restrict v = work->v, *restrict w = work->w;
    double S = sum_products(n, v, w);
    for (int a = 0; a < dim; a++) {
        double *restrict p = work->p[a];
        lanes s = {0};
        for (size_t m = 0; m < n; m += LANES) s += *(const lanes *)(p + m);
        const double mean = LANES_SUM(s) / S;
#pragma omp simd
        for (size_t m = 0; m < n; m++) p[m] = (p[m] - v[m] * w[m] * mean) / S;
    }
}

ALWAYS_INLINE void field_values(size_t n, const struct work *work, const double *restrict f,
                                double origin)
{
    const uint32_t *restrict j = work->j;
    double *restrict values = work->f;
    for (size_t m = 0; m < n; m++) values[m] = f[j[m]] - origin;
}

/* Gradients at one point; s: its sorted index. Returns the number of its neighbours. */
ALWAYS_INLINE uint32_t point_gradient(int dim, const struct operator_task *task, struct work *work,
                                      size_t s)
{
    const struct neighbours *nb = task->neighbours;
    const struct operator_form *form = task->settings->form;
    const struct kernel *kernel = task->settings->kernel;
    const double h = task->h[s];
    const bool diagnosed = task->point != NULL;
    double at[3];
    for (int a = 0; a < dim; a++) at[a] = nb->x[a][s];
    const struct selection found = select_neighbours(dim, task, work, at, h, (uint32_t)s);
    const size_t n = found.n;
    double matrix[9], inverse[9] = {0};

    if (form->pair_vector != VECTOR_GRADIENT || diagnosed)
        task->shapes.w(kernel, n, work->q, work->w);
    if (diagnosed && !form->corrected) {
        position_vectors(dim, n, work);
        sum_matrix(dim, n, work->p, work->x, matrix);
    }
    if (form->pair_vector == VECTOR_POSITION) {
        position_vectors(dim, n, work);
    } else {
        task->shapes.dw(kernel, n, work->q, work->dw);
        gradient_vectors(dim, n, work);
        if (form->pair_vector == VECTOR_NORMALISED) normalise_vectors(dim, n, work);
    }
    double factor = 1 / h;
    bool invertible = true;
    if (form->corrected) {
        sum_matrix(dim, n, work->p, work->x, matrix);
        invertible = matrix_invert(dim, matrix, inverse);
    } else if (form->pair_vector != VECTOR_NORMALISED) { /* W = C h^-d w; x is in units of h */
        factor *= kernel->constant[dim];
        for (int a = 0; a < dim; a++) factor /= h;
        if (form->pair_vector == VECTOR_POSITION) factor *= h * h;
    }

    const size_t i = nb->order[s];
    bool finite = true;
    for (size_t k = 0; k < task->fields; k++) {
        const double *f = task->sorted + (2 + k) * nb->n;
        double sum[3];
        field_values(n, work, f, form->difference ? f[s] : 0);
        sum_vector(dim, n, work->p, work->f, sum);
        for (int a = 0; a < dim; a++) {
            double g = form->corrected ? 0 : sum[a];
            for (int b = 0; form->corrected && b < dim; b++) g += inverse[a * dim + b] * sum[b];
            g = invertible ? g * factor : nan("");
            task->gradient[k * (size_t)dim + (size_t)a][i] = g;
            finite = finite && isfinite(g);
        }
    }
    if (diagnosed) {
        struct operator_point *point = &task->point[i];
        point->neighbours = found.inside;
        point->condition = matrix_condition(dim, matrix);
        if (!form->corrected) invertible = matrix_invert(dim, matrix, inverse);
        point->state = found.inside < (uint32_t)dim + 1                ? OPERATOR_TOO_FEW_NEIGHBOURS
                       : !invertible                                   ? OPERATOR_SINGULAR
                       : !(point->condition <= OPERATOR_CONDITION_MAX) ? OPERATOR_ILL_CONDITIONED
                       : !finite                                       ? OPERATOR_OVERFLOW
                                                                       : OPERATOR_OK;
    }
    return found.inside;
}

ALWAYS_INLINE uint64_t block_gradients(int dim, const struct operator_task *task, struct work *work,
                                       size_t first, size_t end)
{
    uint64_t pairs = 0;
    for (size_t s = first; s < end; s++) pairs += point_gradient(dim, task, work, s);
    return pairs;
}

#define BLOCK(dim)                                                                                 \
    CLONES static uint64_t block_##dim(const struct operator_task *task, struct work *work,        \
                                       size_t first, size_t end)                                   \
    {                                                                                              \
        return block_gradients(dim, task, work, first, end);                                       \
    }
BLOCK(1)
BLOCK(2)
BLOCK(3)

static enum status gradients_of_block(const struct operator_task *task, struct work *work,
                                      size_t block, uint64_t *pairs, struct error *error)
{
    static uint64_t (*const specialisations[])(const struct operator_task *, struct work *, size_t,
                                               size_t) = {block_1, block_2, block_3};
    const struct neighbours *nb = task->neighbours;
    const size_t first = block * NEIGHBOURS_BLOCK;
    const size_t end = first + NEIGHBOURS_BLOCK < nb->n ? first + NEIGHBOURS_BLOCK : nb->n;
    double radius = 0;
    for (size_t s = first; s < end; s++) radius = largest(radius, task->h[s]);
    const enum status status = neighbours_gather(nb, block, radius, &work->candidates, error);
    if (status) return status;
    if (!work_reserve(work))
        return error_set(error, STATUS_ENVIRONMENT, "no memory for neighbours");
    *pairs += specialisations[nb->dim - 1](task, work, first, end);
    return STATUS_OK;
}

enum status operator_sums(const struct operator_task *task, uint64_t *pairs, struct error *error)
{
    enum status status = STATUS_OK;
    uint64_t total = 0;
    const ptrdiff_t blocks = (ptrdiff_t)task->neighbours->blocks;
#pragma omp parallel num_threads(task->settings->threads) reduction(+ : total)
    {
        struct work work = {0};
#pragma omp for schedule(dynamic, 16)
        for (ptrdiff_t b = 0; b < blocks; b++) {
            struct error here;
            const enum status outcome = gradients_of_block(task, &work, (size_t)b, &total, &here);
            if (outcome) {
#pragma omp critical
                {
                    status = outcome;
                    if (error) *error = here;
                }
            }
        }
        work_free(&work);
    }
    if (pairs) *pairs = total;
    return status;
}
