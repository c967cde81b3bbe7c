/* SPDX-License-Identifier: GPL-3.0-or-later
 * A small SPH code of its own, in 1D and 2D with periodic boxes, that reads and writes text:
 *
 *   cc -O2 -o sph sph.c -lm
 *   sphproof ic sod n=400 --format csv --out START
 *   ./sph START OUT 0.2       writes OUT_000 and OUT_001, with .csv at the end, for sphproof judge
 *
 * Equations: Springel & Hernquist (2002) with the entropic function, the cubic spline with a
 * support of 3.2 spacings (4 in 2D), Monaghan's (1997) viscosity with Balsara's (1995) factor,
 * leapfrog. A fourth argument plants a fault: `gamma` (5 % too large) or `viscosity` (four times as
 * strong). */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_PAIRS = 200 }; /* per particle */

struct particle {
    double x[2], v[2], a[2], vel[2]; /* vel: v at the time of x */
    double m, entropy, d_entropy, h, rho, slope, f, pressure, sound, balsara, div, curl, signal;
};
struct pair {
    int i, j;
    double d[2], r;
};

static int dim = 1, n, pair_count;
static double lo[2], side[2] = {1, 1}, gas_gamma, viscosity = 1;
static struct particle *p;
static struct pair *pairs;

static void fail(const char *text, const char *what)
{
    fprintf(stderr, "sph: %s%s\n", text, what);
    exit(1);
}

/* The kernel W with support radius h; *dw is dW/dr. */
static double kernel(double r, double h, double *dw)
{
    static const double pi = 3.14159265358979323846;
    const double c = dim == 1 ? 8 / (3 * h) : 80 / (7 * pi * h * h), q = r / h, b = fmax(1 - q, 0);
    *dw = c / h * (q < 0.5 ? 3 * q * (3 * q - 2) : -3 * b * b);
    return c * (q < 0.5 ? 0.5 + 3 * q * q * (q - 1) : b * b * b);
}

static int by_x(const void *a, const void *b)
{
    const double x = ((const struct particle *)a)->x[0], y = ((const struct particle *)b)->x[0];
    return (x > y) - (x < y);
}

/* Finds all pairs nearer than `reach`; particles are sorted by x. */
static void find_pairs(double reach)
{
    qsort(p, (size_t)n, sizeof *p, by_x);
    pair_count = 0;
    for (int i = 0; i < n; i++)
        for (int k = 1; k < n; k++) {
            struct pair pair = {i, (i + k) % n, {0}, 0};
            for (int d = 0; d < dim; d++) {
                pair.d[d] = p[pair.i].x[d] - p[pair.j].x[d];
                pair.d[d] -= side[d] * round(pair.d[d] / side[d]);
            }
            if (-pair.d[0] > reach || pair.d[0] > 0.25 * side[0]) break;
            pair.r = sqrt(pair.d[0] * pair.d[0] + pair.d[1] * pair.d[1]);
            if (pair.r >= reach) continue;
            if (pair_count == n * MOST_PAIRS) fail("too many neighbours", "");
            pairs[pair_count++] = pair;
        }
}

/* Solves h = eta (m/rho)^(1/dim) by Newton's method; computes the density and the factors f of the
 * equations of motion. */
static void find_density(void)
{
    const double eta = dim == 1 ? 3.2 : 4;
    double reach = 0, worst = 1;
    for (int round = 0; round < 50 && worst > 1e-10; round++) {
        double widest = 0, dw;
        for (int i = 0; i < n; i++) widest = fmax(widest, p[i].h);
        if (widest > reach) find_pairs(reach = 1.05 * widest);
        for (int i = 0; i < n; i++) {
            p[i].rho = p[i].m * kernel(0, p[i].h, &dw);
            p[i].slope = -dim * p[i].rho / p[i].h;
        }
        for (int k = 0; k < 2 * pair_count; k++) {
            const struct pair *pair = &pairs[k / 2];
            struct particle *own = &p[k % 2 ? pair->i : pair->j];
            const struct particle *other = &p[k % 2 ? pair->j : pair->i];
            const double w = kernel(pair->r, own->h, &dw);
            own->rho += other->m * w;
            own->slope -= other->m * (dim * w + pair->r * dw) / own->h;
        }
        worst = 0;
        for (int i = 0; i < n; i++) {
            const double wanted = p[i].m * pow(eta / p[i].h, dim);
            const double change = (p[i].rho - wanted) / (p[i].slope + dim * wanted / p[i].h);
            p[i].f = 1 / (1 + p[i].h * p[i].slope / (dim * p[i].rho));
            worst = fmax(worst, fabs(change) / p[i].h);
            if (fabs(change) > 1e-10 * p[i].h)
                p[i].h = fmin(fmax(p[i].h - change, 0.7 * p[i].h), 1.4 * p[i].h);
        }
    }
}

/* Computes the relative velocity of a pair and W'/r with either h; returns velocity times
 * distance. */
static double approach(const struct pair *k, double dv[2], double *own, double *other)
{
    const double r = k->r > 0 ? k->r : 1e-300;
    kernel(k->r, p[k->i].h, own), kernel(k->r, p[k->j].h, other);
    *own /= r, *other /= r;
    for (int d = 0; d < 2; d++) dv[d] = p[k->i].vel[d] - p[k->j].vel[d];
    return dv[0] * k->d[0] + dv[1] * k->d[1];
}

/* Computes accelerations and d_entropy; returns the longest time step allowed. */
static double find_rates(void)
{
    double dv[2], own, other, step = HUGE_VAL;
    find_density();
    for (int i = 0; i < n; i++) {
        p[i].pressure = p[i].entropy * pow(p[i].rho, gas_gamma);
        p[i].sound = sqrt(gas_gamma * p[i].pressure / p[i].rho);
        p[i].a[0] = p[i].a[1] = p[i].d_entropy = p[i].div = p[i].curl = 0;
        p[i].signal = 2 * p[i].sound;
    }
    for (const struct pair *k = pairs; k < pairs + pair_count; k++) {
        struct particle *a = &p[k->i], *b = &p[k->j];
        const double towards = approach(k, dv, &own, &other);
        const double turn = dv[0] * k->d[1] - dv[1] * k->d[0];
        a->div -= b->m * towards * own / a->rho, b->div -= a->m * towards * other / b->rho;
        a->curl += b->m * turn * own / a->rho, b->curl += a->m * turn * other / b->rho;
    }
    for (int i = 0; i < n; i++) {
        const double div = fabs(p[i].div), noise = 1e-4 * p[i].sound / p[i].h;
        p[i].balsara = dim == 1 ? 1 : div / (div + fabs(p[i].curl) + noise);
    }
    for (const struct pair *k = pairs; k < pairs + pair_count; k++) {
        struct particle *a = &p[k->i], *b = &p[k->j];
        const double towards = approach(k, dv, &own, &other), mean = 0.5 * (own + other);
        const double speed = towards < 0 ? towards / k->r : 0;
        const double signal = a->sound + b->sound - 3 * speed;
        const double friction = -0.5 * viscosity * (a->balsara + b->balsara) * signal * speed /
                                (a->rho + b->rho) * mean;
        const double push = a->f * a->pressure / (a->rho * a->rho) * own +
                            b->f * b->pressure / (b->rho * b->rho) * other + friction;
        for (int d = 0; d < dim; d++) {
            a->a[d] -= b->m * push * k->d[d];
            b->a[d] += a->m * push * k->d[d];
        }
        a->d_entropy += b->m * friction * towards, b->d_entropy += a->m * friction * towards;
        a->signal = fmax(a->signal, signal), b->signal = fmax(b->signal, signal);
    }
    for (int i = 0; i < n; i++) {
        p[i].d_entropy *= 0.5 * (gas_gamma - 1) / pow(p[i].rho, gas_gamma - 1);
        step = fmin(step, 0.2 * p[i].h / p[i].signal);
    }
    return step;
}

/* Finds columns by their names in the first line, and reads `# box = A:B C:D` and `# gamma = G`. */
static void read_start(const char *path)
{
    char line[1000], names[1000] = "", *rest, *word;
    FILE *file = fopen(path, "r");
    if (!file || !fgets(names, sizeof names, file)) fail("cannot be read: ", path);
    while (fgets(line, sizeof line, file)) {
        char columns[1000], *more = columns;
        double u = 0;
        sscanf(line, "# gamma = %lf", &gas_gamma);
        if (sscanf(line, "# box = %lf:%lf %lf:%lf", &lo[0], &side[0], &lo[1], &side[1]) >= 2)
            for (int d = 0; d < 2; d++) side[d] -= lo[d];
        if (*line == '#') continue;
        if (n % 1000 == 0 && !(p = realloc(p, (size_t)(n + 1000) * sizeof *p)))
            fail("no memory", "");
        struct particle *q = memset(&p[n++], 0, sizeof *p);
        strcpy(columns, names);
        for (rest = line; (word = strtok_r(rest, ",\n", &rest));) {
            const char *name = strtok_r(more, ",\n", &more);
            const double value = atof(word);
            if (!name) break;
            if (!strcmp(name, "x")) q->x[0] = value;
            if (!strcmp(name, "y")) q->x[1] = value, dim = 2;
            if (!strcmp(name, "vx")) q->v[0] = value;
            if (!strcmp(name, "vy")) q->v[1] = value;
            if (!strcmp(name, "m")) q->m = value;
            if (!strcmp(name, "u")) u = value;
            if (!strcmp(name, "h")) q->h = value;
        }
        q->entropy = u; /* until densities are known */
    }
    fclose(file);
}

static void write_snapshot(const char *out, int number, double time)
{
    char path[1000];
    snprintf(path, sizeof path, "%s_%03d.csv", out, number);
    FILE *file = fopen(path, "w");
    if (!file) fail("cannot be written: ", path);
    fprintf(file, "x%s,vx%s,m,rho,u,h\n", dim > 1 ? ",y" : "", dim > 1 ? ",vy" : "");
    fprintf(file, "# time = %.17g\n# box = %.17g:%.17g", time, lo[0], lo[0] + side[0]);
    fprintf(file, dim > 1 ? " %.17g:%.17g\n" : "\n", lo[1], lo[1] + side[1]);
    for (int i = 0; i < n; i++) {
        for (int d = 0; d < dim; d++) fprintf(file, "%.17g,", p[i].x[d]);
        for (int d = 0; d < dim; d++) fprintf(file, "%.17g,", p[i].v[d]);
        fprintf(file, "%.17g,%.17g,%.17g,%.17g\n", p[i].m, p[i].rho,
                p[i].entropy * pow(p[i].rho, gas_gamma - 1) / (gas_gamma - 1), p[i].h);
    }
    if (fclose(file)) fail("cannot be written: ", path);
}

int main(int count, char **words)
{
    if (count < 4) fail("usage: sph START OUT T_END [gamma|viscosity]", "");
    read_start(words[1]);
    const double t_end = atof(words[3]);
    if (count > 4 && !strcmp(words[4], "gamma")) gas_gamma *= 1.05;
    if (count > 4 && !strcmp(words[4], "viscosity")) viscosity = 4;
    if (!n || !(pairs = malloc((size_t)n * MOST_PAIRS * sizeof *pairs))) fail("nothing to do", "");
    find_density();
    for (int i = 0; i < n; i++) {
        p[i].entropy *= (gas_gamma - 1) / pow(p[i].rho, gas_gamma - 1);
        memcpy(p[i].vel, p[i].v, sizeof p[i].v);
    }
    write_snapshot(words[2], 0, 0);
    double limit = find_rates();
    for (double time = 0, step; time < t_end; time += step) {
        step = fmin(limit, t_end - time);
        for (int i = 0; i < n; i++) {
            p[i].entropy += 0.5 * step * p[i].d_entropy;
            for (int d = 0; d < dim; d++) {
                p[i].v[d] += 0.5 * step * p[i].a[d];
                p[i].vel[d] = p[i].v[d] + 0.5 * step * p[i].a[d];
                p[i].x[d] += step * p[i].v[d];
                p[i].x[d] -= side[d] * floor((p[i].x[d] - lo[d]) / side[d]);
            }
        }
        limit = find_rates();
        for (int i = 0; i < n; i++) {
            p[i].entropy += 0.5 * step * p[i].d_entropy;
            for (int d = 0; d < dim; d++) p[i].v[d] += 0.5 * step * p[i].a[d];
        }
    }
    write_snapshot(words[2], 1, t_end);
    return 0;
}
