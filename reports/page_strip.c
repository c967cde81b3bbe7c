/* SPDX-License-Identifier: GPL-3.0-or-later
 * A strip of small pictures, one per case: particles and the exact solution, or a map, with the
 * error and the order of the first scheme. Each picture links to its case. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base64.h"
#include "case_state.h"
#include "html.h"
#include "list.h"
#include "page_part.h"
#include "value.h"

enum { WIDTH = 150, HEIGHT = 84, MARGIN = 3, DOTS = 220, COLORS = 64 };

struct frame {
    double x0, x1, y0, y1;
};

static double across(const struct frame *f, double x)
{
    return MARGIN + (WIDTH - 2 * MARGIN) * (f->x1 > f->x0 ? (x - f->x0) / (f->x1 - f->x0) : 0.5);
}

static double down(const struct frame *f, double y)
{
    return HEIGHT - MARGIN -
           (HEIGHT - 2 * MARGIN) * (f->y1 > f->y0 ? (y - f->y0) / (f->y1 - f->y0) : 0.5);
}

/* Writes a path through points (joined) or of dots; draws only one point per half pixel. */
static void path(struct buffer *to, const char *class, const struct frame *f, const double *x,
                 const double *y, size_t n, size_t most, bool joined)
{
    const size_t stride = (n + most - 1) / most;
    double last_x = (double)NAN, last_y = (double)NAN;
    bool pen = false;
    buffer_format(to, "<path class=\"%s\" d=\"", class);
    for (size_t i = 0; i < n; i += stride) {
        if (!isfinite(x[i]) || !isfinite(y[i])) {
            pen = false;
            continue;
        }
        const double px = round(2 * across(f, x[i])) / 2, py = round(2 * down(f, y[i])) / 2;
        if (px == last_x && py == last_y) continue;
        buffer_format(to, "%s%.4g %.4g%s", joined && pen ? "L" : "M", px, py, joined ? "" : "h0");
        pen = true;
        last_x = px, last_y = py;
    }
    buffer_add(to, "\"/>");
}

static void svg_begin(struct buffer *to, const char *title)
{
    html_format(to, "<svg class=\"mini\" viewBox=\"0 0 %d %d\" role=\"img\"><title>%-s</title>",
                WIDTH, HEIGHT, title);
}

/* True if the values of a curve vary by more than noise. */
static bool varies(struct buffer *to, const json_t *curve, const char *name)
{
    size_t n;
    double *y = page_numbers(to, json_object_get(curve, name), &n);
    double low = (double)INFINITY, high = -(double)INFINITY;
    list_range(y, n, &low, &high);
    free(y);
    return high - low > 1e-9 * fmax(fabs(low), fabs(high));
}

/* The quantity in the picture of a profile: the one by which the case is judged, else the first
 * whose exact curve varies; in 1D density. */
static const char *quantity_of(struct buffer *to, const json_t *run, const json_t *from)
{
    const json_t *list = json_object_get(from, "quantities"), *entry;
    const char *measured = json_string_value(json_array_get(json_object_get(run, "measured"), 0));
    const char *found = json_string_value(json_array_get(list, 0));
    size_t i;
    if (!found) return value_member(run, "dimension") > 1 ? "" : "density";
    json_array_foreach(list, i, entry) {
        if (measured && !strcmp(measured, json_string_value(entry))) return measured;
    }
    json_array_foreach(list, i, entry) {
        if (varies(to, json_object_get(from, "exact"), json_string_value(entry)))
            return json_string_value(entry);
    }
    return found;
}

/* Draws particles and the exact curve; false: the run has none. */
static bool profile(struct buffer *to, const json_t *run)
{
    const json_t *from = json_object_get(run, "profile"), *exact = json_object_get(from, "exact");
    const char *name = quantity_of(to, run, from);
    const char *const names[] = {"x", name};
    struct page_columns particles, curve;
    page_columns_read(to, &particles, from, names, 2);
    page_columns_read(to, &curve, exact, names, 2);
    const double *x = particles.of[0], *y = particles.of[1], *exact_y = curve.of[1];
    double *exact_x = curve.of[0];
    const size_t n = particles.n, exact_n = curve.n;
    struct frame f = {(double)INFINITY, -(double)INFINITY, (double)INFINITY, -(double)INFINITY};
    if (n && exact_n) {
        list_range(x, n, &f.x0, &f.x1);
        list_range(y, n, &f.y0, &f.y1);
        for (size_t i = 0; i < exact_n; i++) {
            if (!(exact_x[i] >= f.x0 && exact_x[i] <= f.x1))
                exact_x[i] = (double)NAN;
            else
                list_range(&exact_y[i], 1, &f.y0, &f.y1);
        }
        /* do not enlarge noise around a constant to the full height */
        if (!varies(to, exact, name)) {
            const double most = fmax(fabs(f.y0), fabs(f.y1));
            f.y0 = fmin(f.y0, -0.1 * most), f.y1 += 0.1 * most;
        }
        svg_begin(to, name);
        path(to, "exact", &f, exact_x, exact_y, exact_n, exact_n, true);
        path(to, "dots", &f, x, y, n, DOTS, false);
        buffer_add(to, "</svg>");
    }
    page_columns_free(&particles), page_columns_free(&curve);
    return n && exact_n;
}

static void put(unsigned char *at, size_t bytes, size_t value)
{
    for (size_t k = 0; k < bytes; k++) at[k] = (unsigned char)(value >> 8 * k);
}

/* Dark violet to yellow, as in the large maps. */
static void palette(unsigned char *at)
{
    static const unsigned char anchors[][3] = {
        {68, 1, 84}, {59, 82, 139}, {33, 145, 140}, {94, 201, 98}, {253, 231, 37}};
    for (int c = 0; c < COLORS; c++) {
        const double place = 4. * c / (COLORS - 1);
        const int k = place < 4 ? (int)place : 3;
        for (int rgb = 0; rgb < 3; rgb++)
            at[4 * c + 2 - rgb] = (unsigned char)lround(
                anchors[k][rgb] + (place - k) * (anchors[k + 1][rgb] - anchors[k][rgb]));
    }
}

/* Writes a bitmap of nx by ny cells, lowest row first; voids have the lowest colour. */
static void bitmap(struct buffer *to, const double *z, size_t nx, size_t ny)
{
    enum { HEAD = 54, PALETTE = 4 * COLORS };
    const size_t row = (nx + 3) / 4 * 4, size = HEAD + PALETTE + row * ny;
    unsigned char *bytes = page_allocate(to, size, sizeof *bytes);
    double low = (double)INFINITY, high = -(double)INFINITY;
    if (!bytes) return;
    list_range(z, nx * ny, &low, &high);
    bytes[0] = 'B', bytes[1] = 'M';
    put(bytes + 2, 4, size), put(bytes + 10, 4, HEAD + PALETTE), put(bytes + 14, 4, 40);
    put(bytes + 18, 4, nx), put(bytes + 22, 4, ny), put(bytes + 26, 2, 1), put(bytes + 28, 2, 8);
    put(bytes + 34, 4, row * ny), put(bytes + 46, 4, COLORS);
    palette(bytes + HEAD);
    for (size_t j = 0; j < ny; j++)
        for (size_t i = 0; i < nx; i++) {
            const double part = high > low ? (z[j * nx + i] - low) / (high - low) : 0.5;
            if (isfinite(part))
                bytes[HEAD + PALETTE + j * row + i] = (unsigned char)lround(part * (COLORS - 1));
        }
    base64_add(to, bytes, size);
    free(bytes);
}

/* Draws a map of density, or of speed if density hardly varies. */
static bool map(struct buffer *to, const json_t *run)
{
    const json_t *from = json_object_get(json_object_get(run, "profile"), "map");
    size_t nx, ny, cells, speeds;
    double *x = page_numbers(to, json_object_get(from, "x"), &nx);
    double *y = page_numbers(to, json_object_get(from, "y"), &ny);
    double *rho = page_numbers(to, json_object_get(from, "density"), &cells);
    double *speed = page_numbers(to, json_object_get(from, "speed"), &speeds);
    const bool there = cells && cells == nx * ny;
    if (there) {
        double low = (double)INFINITY, high = -(double)INFINITY;
        list_range(rho, cells, &low, &high);
        const bool flat = speeds == cells && high - low < 0.02 * fabs(high);
        const double scale = fmin((double)WIDTH / (double)nx, (double)HEIGHT / (double)ny);
        const double w = scale * (double)nx, h = scale * (double)ny;
        svg_begin(to, flat ? "map of the speed" : "map of the density");
        buffer_format(to,
                      "<image x=\"%.4g\" y=\"%.4g\" width=\"%.4g\" height=\"%.4g\" "
                      "preserveAspectRatio=\"none\" href=\"data:image/bmp;base64,",
                      (WIDTH - w) / 2, (HEIGHT - h) / 2, w, h);
        bitmap(to, flat ? speed : rho, nx, ny);
        buffer_add(to, "\"/></svg>");
    }
    free(x), free(y), free(rho), free(speed);
    return there;
}

static void figures(struct buffer *to, const json_t *run, const json_t *study)
{
    const json_t *order = page_study_main(study);
    const char *what;
    buffer_add(to, "<span>");
    if (order) {
        html_format(to, "%f ", page_study_finest(study));
        page_study_name(to, order);
    } else if (run) {
        const double error = case_state_error(run, &what);
        if (isfinite(error)) html_number(to, error);
        html_format(to, isfinite(error) ? " off in %-s" : "no error of %-s", what);
    }
    buffer_add(to, order ? "</span><span>order " : "</span><span>one run");
    if (order) html_order(to, order);
    buffer_add(to, "</span>");
}

static void card(struct buffer *to, const json_t *results, const char *name)
{
    const json_t *run = case_state_find(json_object_get(results, "runs"), name, NULL);
    const json_t *study = case_state_find(json_object_get(results, "studies"), name, NULL);
    const char *state = case_state(results, name);
    html_format(to, "<a class=\"card %s\" href=\"#case-%s\">", state, name);
    if (!profile(to, run) && !map(to, run)) {
        svg_begin(to, "no picture");
        buffer_add(to, "</svg>");
    }
    html_status(to, state);
    html_format(to, "<span><b>%-s</b></span>", name);
    figures(to, run, study);
    buffer_add(to, "</a>\n");
}

void page_strip(struct page_writer *writer, const json_t *results)
{
    static const char *const lists[] = {"runs", "studies"};
    struct buffer *to = &writer->to;
    const json_t *runs = json_object_get(results, "runs"), *entry;
    bool any = false;
    for (int k = 0; k < 2; k++) {
        size_t i;
        json_array_foreach(json_object_get(results, lists[k]), i, entry) {
            const char *name = value_text(entry, "case");
            /* once per case: its first run, or its first study if there is no run */
            if (case_state_find(json_object_get(results, lists[k]), name, NULL) != entry ||
                (k && case_state_find(runs, name, NULL)))
                continue;
            if (!any) buffer_add(to, "<section id=\"strip\"><div class=\"strip\">\n");
            any = true;
            card(to, results, name);
        }
    }
    if (!any) return;
    buffer_add(to, "</div><p class=\"note\">Points are particles of the first scheme, the line is "
                   "the exact solution; maps show density, or speed where density hardly varies. "
                   "A picture opens its case. Smoke: too coarse to say. Undetermined: the order's "
                   "interval is wider than its gate. Known: a known weakness.</p></section>\n");
}
