/* SPDX-License-Identifier: GPL-3.0-or-later
 * Finds the case's position in the file's box, its time and its gamma; notes all of it. */
#include <gsl/gsl_math.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "judge.h"
#include "problem_list.h"

/* A refusal names the file. */
static enum status set_real(const struct judged *judged, struct settings *settings,
                            enum setting key, double value, struct error *error)
{
    char text[40];
    snprintf(text, sizeof text, "%.17g", value);
    return settings_set(settings, key, text, SOURCE_USER, judged->path, error);
}

/* Replaces a gamma stored in single precision by the nearest short number. */
static double unrounded(double gamma)
{
    const double near[] = {round(gamma * 3) / 3, round(gamma * 1000) / 1000};
    for (int k = 0; k < 2; k++)
        if (fabs(near[k] - gamma) < 1.5e-7 * gamma) return near[k];
    return gamma;
}

/* Gamma from P and u, if both are stored: the median of 1 + P/(rho u). */
static double stored_gamma(const struct snapshot_file *file, double *scatter)
{
    const double *P = file->column[SNAPSHOT_P], *u = file->column[SNAPSHOT_U],
                 *rho = file->column[SNAPSHOT_RHO];
    double sum = 0, count = 0, least = INFINITY, most = -INFINITY;
    if (!P || !u) return (double)NAN;
    for (size_t i = 0; i < file->gas; i++) {
        const double gamma = 1 + P[i] / (rho[i] * u[i]);
        if (!(u[i] > 0 && P[i] > 0)) continue;
        sum += gamma, count++;
        least = fmin(least, gamma), most = fmax(most, gamma);
    }
    *scatter = fmax(most - sum / count, sum / count - least);
    return sum / count;
}

static enum status take_gamma(const struct judge_request *request, struct judged *judged,
                              struct settings *settings, struct error *error)
{
    struct snapshot_file *file = &judged->file;
    char value[32];
    double scatter, gamma = settings_real(settings, SETTING_gamma);
    const double stored = stored_gamma(file, &scatter);
    const bool proved = !problem_of(settings)->liquid && stored > 1 && scatter < 1e-5 * stored;
    const double case_gamma = gamma;
    const char *evidence = "the file has none: the case's";
    if (request->gamma.known)
        gamma = request->gamma.value, evidence = request->asked ? "the case's" : "--gamma";
    else if (file->gamma.known)
        gamma = unrounded(file->gamma.value), evidence = "the file says so";
    else if (proved)
        gamma = unrounded(stored),
        evidence = "the file has none, but P = (gamma - 1) rho u of its particles";
    if (request->case_name && !request->gamma.known && fabs(gamma - case_gamma) > 1e-3)
        judged->case_gamma = case_gamma;
    snprintf(value, sizeof value, "%.9g", gamma);
    snapshot_note(&file->notes, "gamma", value, "%s%s", evidence,
                  proved && fabs(stored - gamma) > 1e-4
                      ? "; but the file's own P/(rho u) says something else"
                      : "");
    return set_real(judged, settings, SETTING_gamma, gamma, error);
}

static enum status take_time(const struct judge_request *request, struct judged *judged,
                             struct settings *settings, struct error *error)
{
    struct snapshot_file *file = &judged->file;
    char value[32];
    const struct snapshot_value time = request->time.known ? request->time : file->time;
    const char *untaken = "";
    for (size_t k = 0; k < file->notes.count; k++)
        if (strcmp(file->notes.note[k].what, "not taken") == 0)
            untaken = file->notes.note[k].evidence;
    if (!time.known)
        return error_set(error, STATUS_BAD_INPUT,
                         "%.200s: says no time; a line '# time = T' of a text file helps, and "
                         "judge --time T%s%.200s",
                         judged->path, *untaken ? "; not taken: " : "", untaken);
    if (!(time.value >= 0))
        return error_set(error, STATUS_BAD_INPUT, "%.200s: time = %g; allowed: 0 or above",
                         judged->path, time.value);
    file->time = time;
    snprintf(value, sizeof value, "%.9g", time.value);
    snapshot_note(&file->notes, "time", value, "%s",
                  !request->time.known ? "the file says so"
                  : request->asked     ? "the end of the run"
                                       : "--time");
    return set_real(judged, settings, SETTING_t_end, time.value, error);
}

/* ---- the box ---- */

struct box {
    bool known; /* from the file, or the case's */
    double lo[3], hi[3];
};

static void extent(const struct snapshot_file *file, size_t n, int d, double *lo, double *hi)
{
    *lo = INFINITY, *hi = -INFINITY;
    for (size_t i = 0; i < n; i++) {
        *lo = fmin(*lo, file->column[d][i]);
        *hi = fmax(*hi, file->column[d][i]);
    }
}

/* True if the file has particles other than gas, and each of them is outside the extent of the gas
 * in some direction, as walls are. Dust, or rows of a wrongly assigned type, are not walls. */
static bool has_walls(const struct snapshot_file *file)
{
    double lo[3], hi[3];
    for (int d = 0; d < file->dim; d++) extent(file, file->gas, d, &lo[d], &hi[d]);
    for (size_t i = file->gas; i < file->n; i++) {
        bool inside = true;
        for (int d = 0; d < file->dim; d++)
            inside = inside && file->column[d][i] >= lo[d] && file->column[d][i] <= hi[d];
        if (inside) return false;
    }
    return file->gas < file->n;
}

/* The extent of gas in 1D whose volumes fill a line, including the half spacings beyond the
 * outermost particles. False, without any effect, for other gas. */
static bool extent_of_volumes(const struct snapshot_file *file, double *lo, double *hi)
{
    const double *x = file->column[SNAPSHOT_X], *m = file->column[SNAPSHOT_M],
                 *rho = file->column[SNAPSHOT_RHO];
    double from = INFINITY, to = -INFINITY, sum = 0;
    if (file->dim > 1 || file->gas < file->n) return false;
    for (size_t i = 0; i < file->n; i++) {
        const double volume = m[i] / rho[i];
        from = fmin(from, x[i] - 0.5 * volume);
        to = fmax(to, x[i] + 0.5 * volume);
        sum += volume;
    }
    if (!(fabs(sum - (to - from)) <= 0.1 * (to - from))) return false;
    *lo = from, *hi = to;
    return true;
}

/* True if all positions lie in the case's own box and, unless the user gives the ends, nearly fill
 * it. */
static bool fits_case(const struct snapshot_file *file, const struct settings *settings, bool ends)
{
    for (int d = 0; d < file->dim; d++) {
        double lo, hi;
        const double from = settings_along(settings, SETTING_lo, d),
                     to = settings_along(settings, SETTING_hi, d);
        extent(file, file->n, d, &lo, &hi);
        if (!(lo >= from && hi <= to && (ends || hi - lo >= 0.8 * (to - from)))) return false;
    }
    return true;
}

/* The box of a liquid between plates, or from a bottom up to a surface: from the file or --box,
 * else the case's. Wall particles, and liquid above the surface, may lie outside. */
static void take_liquid_box(const struct judge_request *request, struct judged *judged,
                            const struct settings *settings, struct box *box)
{
    struct snapshot_file *file = &judged->file;
    const bool said = file->boxed && file->placed;
    char value[80];
    box->known = true;
    for (int d = 0; d < file->dim; d++) {
        const double lo = settings_along(settings, SETTING_lo, d);
        const double length = settings_along(settings, SETTING_hi, d) - lo;
        box->lo[d] = said ? file->corner[d] : lo;
        box->hi[d] = box->lo[d] + (said ? file->box[d] : length);
        file->box[d] = box->hi[d] - box->lo[d];
    }
    file->boxed = true;
    snprintf(value, sizeof value, "%.6g to %.6g along y", box->lo[1], box->hi[1]);
    snapshot_note(&file->notes, "box", value, "%s",
                  !said          ? "the case's: the file does not say where its own begins"
                  : request->box ? "--box"
                                 : "the file says so");
}

/* If the volumes of a line of gas add up to the length of the case's box within 1 %, the box begins
 * at 0, or is centred on 0 or on the gas: the first of these that contains all particles. False:
 * the length differs. */
static bool shift_case_box(struct judged *judged, const struct settings *settings, struct box *box)
{
    struct snapshot_file *file = &judged->file;
    double first, last;
    const double length =
        settings_along(settings, SETTING_hi, 0) - settings_along(settings, SETTING_lo, 0);
    const double corners[] = {0, -0.5 * length, 0.5 * (box->lo[0] + box->hi[0] - length)};
    char value[80];
    if (!(fabs(box->hi[0] - box->lo[0] - length) <= 0.01 * length)) return false;
    extent(file, file->n, 0, &first, &last);
    int k = 0;
    while (k < 2 && !(first >= corners[k] && last <= corners[k] + length)) k++;
    box->known = file->boxed = true; /* periodic unless a boundary is given */
    box->lo[0] = corners[k], box->hi[0] = corners[k] + length;
    file->box[0] = length;
    snprintf(value, sizeof value, "%.6g to %.6g along x", box->lo[0], box->hi[0]);
    snapshot_note(&file->notes, "box", value,
                  "the file says none: as long as the case's, which the volumes of particles fill");
    return true;
}

static enum status take_box(const struct judge_request *request, struct judged *judged,
                            const struct settings *settings, bool ends, struct box *box,
                            struct error *error)
{
    struct snapshot_file *file = &judged->file;
    char value[80];
    bool inside = true;
    if (problem_of(settings)->liquid) {
        take_liquid_box(request, judged, settings, box);
        return STATUS_OK;
    }
    box->known = file->boxed;
    for (int d = 0; d < file->dim && file->boxed; d++) {
        double lo, hi;
        const double length = file->box[d];
        extent(file, file->n, d, &lo, &hi);
        if (!(hi - lo <= length * (1 + 1e-6))) /* positions differ, so no length of 0 is enough */
            return error_set(error, STATUS_BAD_INPUT,
                             "%.200s: the header's box is %g long along %s, but positions reach "
                             "from %g to %g",
                             judged->path, length, snapshot_column_names[d], lo, hi);
        const double corner = file->placed ? file->corner[d] : 0;
        inside = inside && lo >= corner - 1e-6 * length && hi <= corner + length * (1 + 1e-6);
        if (!inside && file->placed)
            return error_set(error, STATUS_BAD_INPUT,
                             "%.200s: the file's box reaches from %g to %g along %s, but positions "
                             "from %g to %g",
                             judged->path, corner, corner + length, snapshot_column_names[d], lo,
                             hi);
    }
    for (int d = 0; d < file->dim; d++) {
        extent(file, file->n, d, &box->lo[d], &box->hi[d]);
        if (file->boxed && inside)
            box->lo[d] = file->corner[d], box->hi[d] = file->corner[d] + file->box[d];
        else if (file->boxed) { /* about the middle of the particles, or about 0 if near */
            const double middle = 0.5 * (box->lo[d] + box->hi[d]);
            const double snapped = fabs(middle) < 0.05 * file->box[d] ? 0 : middle;
            box->lo[d] = snapped - 0.5 * file->box[d], box->hi[d] = snapped + 0.5 * file->box[d];
        }
    }
    if (!file->boxed && !has_walls(file) && fits_case(file, settings, ends)) {
        box->known = file->boxed = true; /* periodic unless a boundary is given */
        for (int d = 0; d < file->dim; d++) {
            box->lo[d] = settings_along(settings, SETTING_lo, d);
            box->hi[d] = settings_along(settings, SETTING_hi, d);
            file->box[d] = box->hi[d] - box->lo[d];
        }
        snapshot_note(&file->notes, "box", "the case's",
                      ends ? "the file says none; all positions lie in the case's"
                           : "the file says none; all positions lie in the case's and fill it");
    } else {
        const bool filled = !file->boxed && extent_of_volumes(file, &box->lo[0], &box->hi[0]);
        if (filled && shift_case_box(judged, settings, box)) return STATUS_OK;
        snprintf(value, sizeof value, "%.6g to %.6g along x", box->lo[0], box->hi[0]);
        snapshot_note(&file->notes, "box", value, "%s",
                      filled         ? "the file says none: as far as volumes of particles reach; "
                                       "not periodic"
                      : !file->boxed ? "the file says none: as far as particles reach; not periodic"
                      : request->box ? "--box"
                      : file->placed ? "the file says so"
                      : inside ? "the header's length, from 0; positions lie in it; taken for "
                                 "periodic"
                               : "the header's length, about the middle of the particles, which "
                                 "are not in it from 0 on");
    }
    return STATUS_OK;
}

/* The boundary that a case file or one of our snapshots gives for a tube, as --boundary takes it.
 * NULL: none. */
static const char *case_ends(struct settings *settings)
{
    struct setting_value *value = &settings->value[SETTING_boundary];
    if (value->automatic) return NULL;
    const char *word = scheme_boundary_family.members[value->choices[0]]->name;
    value->automatic = true;
    return word;
}

/* Finds where the two gases met and centres the box there. For a tube with ends (*ended) also sets
 * the window, and *period to 0. */
static enum status place_tube(const struct judge_request *request, struct judged *judged,
                              struct settings *settings, struct box *box, double *period,
                              bool *ended, struct error *error)
{
    struct snapshot_notes *notes = &judged->file.notes;
    const double ends[2] = {box->lo[0], box->hi[0]}, length = ends[1] - ends[0];
    double x0 = 0.5 * (box->lo[0] + box->hi[0]);
    char value[32];
    const char *evidence = "the middle of the box; --x0 says otherwise";
    if (request->x0.known && !(request->x0.value >= box->lo[0] && request->x0.value <= box->hi[0]))
        return error_set(error, STATUS_BAD_INPUT,
                         "judge: --x0 %g: %.200s: allowed: in its box, %g to %g", request->x0.value,
                         judged->path, box->lo[0], box->hi[0]);
    if (request->x0.known)
        x0 = request->x0.value, evidence = "--x0";
    else if (!box->known && fabs(x0) < 0.1 * length)
        x0 = 0, evidence = "x = 0 is near the middle of the particles; --x0 says otherwise";
    snprintf(value, sizeof value, "%.9g", x0);
    snapshot_note(notes, "x0", value, "%s", evidence);
    box->lo[0] = x0 - 0.5 * length, box->hi[0] = x0 + 0.5 * length;
    *ended = judge_tube_ends(request, judged, settings, ends);
    if (!*ended) return STATUS_OK;
    double window[2], about[2];
    char text[SETTING_TEXT_MAX];
    if (judge_tube_window(request, judged, settings, x0, ends, window, about, error))
        return error->status;
    *period = 0;
    box->lo[0] = about[0], box->hi[0] = about[1];
    snprintf(text, sizeof text, "%.17g %.17g", window[0], window[1]);
    return settings_set(settings, SETTING_window, text, SOURCE_USER, NULL, error);
}

static enum status set_ends(struct settings *settings, enum setting key, const double *ends,
                            int dim, struct error *error)
{
    char text[SETTING_TEXT_MAX];
    int n = 0;
    for (int d = 0; d < dim; d++)
        n += snprintf(text + n, sizeof text - (size_t)n, "%s%.17g", d ? " " : "", ends[d]);
    return settings_set(settings, key, text, SOURCE_USER, NULL, error);
}

/* Sets the window: from --window, else from the file, else that of a run: the case's, about its
 * middle, if the box is as long as the case's. */
static enum status set_window(const struct judge_request *request, struct judged *judged,
                              struct settings *settings, const struct box *box, double case_length,
                              double case_middle, struct error *error)
{
    char text[SETTING_TEXT_MAX];
    struct setting_value *window = &settings->value[SETTING_window];
    const double length = box->hi[0] - box->lo[0], middle = 0.5 * (box->lo[0] + box->hi[0]);
    if (request->radius > 0) {
        snprintf(text, sizeof text, "radius %.6g", request->radius);
        snapshot_note(&judged->file.notes, "window", text, "--window");
        return settings_set(settings, SETTING_window, "auto", SOURCE_USER, NULL, error)
                   ? error->status
                   : set_real(judged, settings, SETTING_window_radius, request->radius, error);
    }
    if (request->window) {
        snprintf(text, sizeof text, "%.17g %.17g", request->ends[0], request->ends[1]);
        snapshot_note(&judged->file.notes, "window", text, "--window");
        return settings_set(settings, SETTING_window, text, SOURCE_USER, NULL, error);
    }
    if (window->automatic || window->source == SOURCE_USER) return STATUS_OK;
    if (!(fabs(length - case_length) <= 1e-6 * case_length)) {
        snapshot_note(&judged->file.notes, "window", "the middle half",
                      "the case's box is %.6g long, the file's %.6g", case_length, length);
        return settings_set(settings, SETTING_window, "auto", SOURCE_USER, NULL, error);
    }
    snprintf(text, sizeof text, "%.17g %.17g",
             fmax(window->real[0] - case_middle + middle, box->lo[0]),
             fmin(window->real[1] - case_middle + middle, box->hi[0]));
    return settings_set(settings, SETTING_window, text, SOURCE_USER, NULL, error);
}

/* Cuts a text after as many words as there are directions. */
static void cut_words(char *words, int directions)
{
    for (char *c = words; *c; c++)
        if (*c == ' ' && --directions == 0) *c = '\0';
}

/* Takes layers of a planar flow in 3D as a flow in x and y. Without a box their thickness follows
 * from the volumes. */
static void take_slab(struct judged *judged)
{
    struct snapshot_file *file = &judged->file;
    double *const *v = &file->column[SNAPSHOT_VX];
    double volume = 0, area = 1, along = 0, most = 0;
    char value[48];
    for (size_t i = 0; i < file->gas; i++) {
        volume += file->column[SNAPSHOT_M][i] / file->column[SNAPSHOT_RHO][i];
        along = fmax(along, fabs(v[2][i]));
        most = fmax(most, gsl_hypot3(v[0][i], v[1][i], v[2][i]));
    }
    for (int d = 0; d < 2; d++) {
        double lo, hi;
        extent(file, file->gas, d, &lo, &hi);
        area *= file->boxed ? file->box[d] : hi - lo;
    }
    judged->slab = file->boxed && file->box[2] > 0 ? file->box[2] : volume / area;
    file->dim = 2;
    cut_words(file->boundary, 2);
    snprintf(value, sizeof value, "a slab in 3D, %.6g thick", judged->slab);
    snapshot_note(&file->notes, "plane", value,
                  "the case is in 2D: judged along x and y; velocities along z are at most %.2g of "
                  "the greatest",
                  most > 0 ? along / most : 0);
}

static enum status check_dimension(struct judged *judged, struct run_settings *asked,
                                   const struct problem *problem, struct error *error)
{
    const int dim = judged->file.dim;
    char value[32];
    if (dim == asked->file.dimension) return STATUS_OK;
    if (dim < problem->least_dim || problem->circular)
        return error_set(error, STATUS_BAD_INPUT,
                         "%.200s: particles in %d dimensions; the case %.60s has %d", judged->path,
                         dim, asked->file.asked, asked->file.dimension);
    snprintf(value, sizeof value, "in %d dimensions", dim);
    snapshot_note(&judged->file.notes, "case", value,
                  "it is written in %d, but its solution varies along x alone",
                  asked->file.dimension);
    asked->file.dimension = dim;
    return STATUS_OK;
}

/* Reads the keys that our own snapshots contain: boundary, window and keys of the same case. */
static enum status take_keys(struct judged *judged, struct settings *settings, struct error *error)
{
    struct snapshot_file *file = &judged->file;
    char keys[sizeof file->keys], *rest = keys;
    struct error reason;
    enum status status = STATUS_OK;
    strcpy(keys, file->keys);
    for (char *word; !status && (word = strtok_r(rest, ";", &rest));) {
        word += strspn(word, " ");
        status = settings_apply(settings, 1, &word, &reason);
    }
    if (!status && file->boundary[0] && (file->dim > 1 || strcmp(file->boundary, "periodic") != 0))
        status =
            settings_set(settings, SETTING_boundary, file->boundary, SOURCE_USER, NULL, &reason);
    if (status)
        return error_set(error, status, "%.200s: what it says of its run: %.280s", judged->path,
                         reason.message);
    if (file->keys[0])
        snapshot_note(&file->notes, "keys", "of its run", "the file says %.200s", file->keys);
    return STATUS_OK;
}

enum status judge_geometry(const struct judge_request *given, struct judged *judged,
                           double period[3], struct error *error)
{
    struct judge_request with_ends = *given; /* with the case's boundary and window as defaults */
    const struct judge_request *request = &with_ends;
    struct run_settings asked;
    struct box box = {.known = false};
    bool ended = false;
    struct settings *settings = &asked.settings;
    const char *said = judged->file.case_name;
    if (request->box && !(judged->file.boxed = snapshot_take_box(request->box, &judged->file)))
        return error_set(error, STATUS_BAD_INPUT,
                         "judge: --box '%.80s': allowed: LO:HI, one for each direction, or lengths",
                         request->box);
    const char *name = request->case_name ? request->case_name : said;
    if (!*name)
        return error_set(error, STATUS_BAD_INPUT,
                         "%.200s: what should it be? It names no case; a line '# case = CASE' of a "
                         "text file helps, and judge --case CASE, or --left and --right",
                         judged->path);
    if (!request->case_name) snapshot_note(&judged->file.notes, "case", name, "the file says so");
    if (request->asked)
        asked = *request->asked;
    else if (run_prepare(&asked, name, 0, NULL, error))
        return error->status;
    judged->case_dim = asked.file.dimension;
    const struct problem *problem = problem_of(settings);
    /* flows that also exist in 1D and have no direction vary along x alone, in any dimension */
    if (judged->file.dim == 3 && asked.file.dimension == 2 &&
        (problem->least_dim == 2 || problem->circular || problem_reads(problem, SETTING_direction)))
        take_slab(judged);
    if (strcmp(name, said) == 0 && !request->x0.known && take_keys(judged, settings, error))
        return error->status;
    if ((request->left &&
         settings_set(settings, SETTING_left, request->left, SOURCE_USER, "--left", error)) ||
        (request->right &&
         settings_set(settings, SETTING_right, request->right, SOURCE_USER, "--right", error)))
        return error->status;
    for (int key = 0; key < SETTINGS; key++)
        judged->altered |=
            settings->value[key].source == SOURCE_USER && judge_key_of_problem((enum setting)key);
    const bool tube = problem_reads(problem, SETTING_left);
    if (!tube && (request->x0.known || request->left || request->right))
        return error_set(error, STATUS_BAD_INPUT,
                         "judge: --left, --right and --x0 belong to two gases that meet; %.60s has "
                         "none",
                         name);
    const char *ends = tube && asked.file.dimension == 1 ? case_ends(settings) : NULL;
    const struct setting_value *window = &settings->value[SETTING_window];
    if (!request->boundary) with_ends.boundary = ends;
    if (ends && !request->window && !window->automatic) {
        with_ends.window = true;
        with_ends.ends[0] = window->real[0], with_ends.ends[1] = window->real[1];
    }
    const double case_lo = settings_along(settings, SETTING_lo, 0),
                 case_hi = settings_along(settings, SETTING_hi, 0);
    if (check_dimension(judged, &asked, problem, error) ||
        take_gamma(request, judged, settings, error) ||
        take_time(request, judged, settings, error) ||
        take_box(request, judged, settings, ends != NULL, &box, error))
        return error->status;
    if (judged->file.dim == 1 && request->radius > 0) {
        const double middle = 0.5 * (box.lo[0] + box.hi[0]);
        with_ends.window = true, with_ends.radius = 0;
        with_ends.ends[0] = middle - given->radius, with_ends.ends[1] = middle + given->radius;
    }
    if (request->boundary && !tube)
        snprintf(judged->file.boundary, sizeof judged->file.boundary, "%s", request->boundary);
    for (int d = 0; d < 3; d++)
        period[d] = problem->liquid && problem->ends[d].usual != BOUNDARY_PERIODIC
                        ? 0
                        : snapshot_period(&judged->file, d);
    const int dim = judged->file.dim;
    double number = (double)judged->file.gas; /* in a slab: in one layer, if the spacing is the same
                                                 in all directions */
    if (judged->slab > 0)
        number *= cbrt((box.hi[0] - box.lo[0]) * (box.hi[1] - box.lo[1]) * judged->slab / number) /
                  judged->slab;
    judged->case_n = number;
    for (int d = 0; d < dim; d++)
        judged->case_n *=
            (settings_along(settings, SETTING_hi, d) - settings_along(settings, SETTING_lo, d)) /
            (box.hi[d] - box.lo[d]);
    if (tube && place_tube(request, judged, settings, &box, &period[0], &ended, error))
        return error->status;
    judged->boxed = box.known && !ended && !has_walls(&judged->file);
    const double n = fmin(1e7, round(number));
    if ((!ended && set_window(request, judged, settings, &box, case_hi - case_lo,
                              0.5 * (case_lo + case_hi), error)) ||
        (!settings->file[0] && set_real(judged, settings, SETTING_n, n, error)) ||
        set_ends(settings, SETTING_lo, box.lo, dim, error) ||
        set_ends(settings, SETTING_hi, box.hi, dim, error))
        return error->status;
    if (!tube && fabs(box.hi[0] - box.lo[0] - (case_hi - case_lo)) > 1e-6 * (case_hi - case_lo))
        snapshot_note(&judged->file.notes, "size", "not the case's",
                      "the case's box is %.6g long, the file's %.6g", case_hi - case_lo,
                      box.hi[0] - box.lo[0]);
    struct error reason;
    if (run_resolve(&judged->run, &asked, &reason))
        return error_set(error, reason.status, "%.200s: %.280s", judged->path, reason.message);
    judged->run.settings.value[SETTING_n].real[0] = n; /* not a key beside a file of particles */
    return STATUS_OK;
}

/* True if the field with the best known exact solution can be compared at no particle. */
static bool window_is_empty(const struct run_result *result)
{
    for (int f = 0; f < FIELDS; f++)
        if (problem_knows(result->problem.problem, (enum field)f))
            return isnan(result->errors[f].l1);
    return false;
}

enum status judge_check_window(const struct judged *judged, struct error *error)
{
    const struct settings *settings = &judged->run.settings;
    const double radius = settings_real(settings, SETTING_window_radius);
    char window[SETTING_TEXT_MAX];
    if (!window_is_empty(&judged->result)) return STATUS_OK;
    if (radius > 0)
        snprintf(window, sizeof window, "%.6g about the middle", radius);
    else
        settings_text(settings, SETTING_window, window);
    return error_set(error, STATUS_BAD_INPUT,
                     "%.200s: no particle lies in the window, %s; allowed: one with particles in "
                     "it: --window asks for another, --x0 tells where the case is",
                     judged->path, window);
}
