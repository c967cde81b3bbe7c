/* SPDX-License-Identifier: GPL-3.0-or-later
 * Selects the reader for a file, joins the files of one snapshot, and rejects invalid values. HDF5
 * files are read in a child process, which returns the columns through an unnamed file. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "guard.h"
#include "output.h"
#include "snapshot_file.h"
#include "source.h"
#include "text.h"

#ifdef HAVE_HDF5
#include "h5.h"
#include "hdf5_file.h"
#define HDF5_READER READER
#else
#define HDF5_READER(name)
#endif

#define READER(name) extern const struct snapshot_reader reader_##name;
#include "readers.def"
#undef READER

static const struct member *const members[] = {
#define READER(name) &reader_##name.member,
#include "readers.def"
#undef READER
};

const struct family snapshot_reader_family = {"snapshots", "formats of snapshots that are read",
                                              members, sizeof members / sizeof *members};

static enum status read_source(struct snapshot_source *source,
                               const struct snapshot_options *options, struct snapshot_file *file,
                               struct error *error)
{
    for (size_t k = 0; k < snapshot_reader_family.n; k++) {
        const struct snapshot_reader *reader =
            (const struct snapshot_reader *)snapshot_reader_family.members[k];
        if (!reader->recognises(source)) continue;
        snprintf(file->layout, sizeof file->layout, "%s", reader->member.name);
        file->parts = 1;
        return reader->read(source, options, file, error);
    }
#ifdef HAVE_HDF5
    if (source->file) {
        char there[300];
        hdf5_names(source, "/", there, sizeof there);
        return error_set(error, STATUS_BAD_INPUT,
                         "%.200s: HDF5 of no layout that is read (GADGET, AREPO, GIZMO, SWIFT, "
                         "SPH-EXA, Phantom); it has: %.200s",
                         source->path, there);
    }
#endif
    return error_set(error, STATUS_BAD_INPUT,
                     "%.200s: no snapshot that is read: begins neither as HDF5, nor as a binary of "
                     "GADGET (a count of 256 or 8) or Phantom (its magic numbers), nor as text; "
                     "`sphproof list snapshots` names all",
                     source->path);
}

/* ---- HDF5 ---- */

#ifdef HAVE_HDF5
static enum status read_here(struct snapshot_source *source, const struct snapshot_options *options,
                             struct snapshot_file *file, struct error *error)
{
    guard_call("the HDF5 library", (double)NAN, (double)NAN, 0);
    enum status status = hdf5_open(source, error);
    guard_back();
    if (!status) status = read_source(source, options, file, error);
    hdf5_close(source);
    return status;
}

/* What the child process reads. */
struct errand {
    struct snapshot_source *source;
    const struct snapshot_options *options;
    FILE *results;
};

static enum status run_errand(const void *context, json_t **reply, struct error *error)
{
    const struct errand *errand = context;
    struct snapshot_file file = {0};
    (void)reply;
    enum status status = read_here(errand->source, errand->options, &file, error);
    if (!status) {
        bool written = fwrite(&file, sizeof file, 1, errand->results) == 1;
        for (int c = 0; c < SNAPSHOT_COLUMNS; c++)
            if (file.column[c])
                written = written &&
                          fwrite(file.column[c], sizeof(double), file.n, errand->results) == file.n;
        if (!written || fflush(errand->results))
            status = error_set(error, STATUS_ENVIRONMENT, "no space for what %.200s holds",
                               errand->source->path);
    }
    snapshot_file_free(&file);
    return status;
}

static enum status take_results(const char *path, FILE *results, struct snapshot_file *file,
                                struct error *error)
{
    rewind(results);
    bool sound = fread(file, sizeof *file, 1, results) == 1;
    for (int c = 0; c < SNAPSHOT_COLUMNS; c++) {
        const bool there = file->column[c] != NULL;
        file->column[c] = NULL;
        if (there && sound)
            sound = !snapshot_file_make(file, (enum snapshot_column)c, path, error) &&
                    fread(file->column[c], sizeof(double), file->n, results) == file->n;
    }
    return sound ? STATUS_OK
                 : error_set(error, STATUS_ENVIRONMENT, "no memory for what %.200s holds", path);
}

static enum status read_hdf5(struct snapshot_source *source, const struct snapshot_options *options,
                             struct snapshot_file *file, struct error *error)
{
    enum { SECONDS = 60 };
    struct guard_verdict verdict = {0};
    if (h5_load(source->path, error)) return error->status; /* once, not in each child process */
    if (options->here) return read_here(source, options, file, error);
    const struct errand errand = {source, options, output_temporary()};
    if (!errand.results)
        return error_set(error, STATUS_ENVIRONMENT, "no temporary file for what %.200s holds",
                         source->path);
    enum status status = guard_run(run_errand, &errand, SECONDS, &verdict, error);
    if (!status)
        status = take_results(source->path, errand.results, file, error);
    else if (verdict.reason[0])
        status = error_set(error, STATUS_BAD_INPUT,
                           "%.200s: damaged or hostile: the HDF5 library %.200s", source->path,
                           verdict.reason);
    guard_free(&verdict);
    fclose(errand.results);
    return status;
}
#else
static enum status read_hdf5(struct snapshot_source *source, const struct snapshot_options *options,
                             struct snapshot_file *file, struct error *error)
{
    (void)options, (void)file;
    return error_set(error, STATUS_BAD_INPUT,
                     "%.200s: is HDF5, which this program was built without: install libhdf5-dev "
                     "(Debian), hdf5-devel (Fedora) or hdf5 (brew) and build again, or write the "
                     "snapshot as CSV",
                     source->path);
}
#endif

static enum status read_one(const char *path, const struct snapshot_options *options,
                            struct snapshot_file *file, struct error *error)
{
    struct snapshot_source source;
    *file = (struct snapshot_file){0};
    enum status status = source_open(&source, path, error);
    if (!status) status = (source.hdf5 ? read_hdf5 : read_source)(&source, options, file, error);
    source_free(&source);
    if (!status && options->map && strcmp(file->layout, "csv") && strcmp(file->layout, "splash"))
        status = error_set(error, STATUS_BAD_INPUT,
                           "%.200s: --map is for text; this is %s, whose names are known", path,
                           file->layout);
    return status;
}

/* ---- several files ---- */

/* Makes snap_007.3.hdf5 from snap_007.0.hdf5. False if the name has no such number. */
static bool part_path(const char *path, int part, char *text, size_t size)
{
    const char *base = strrchr(path, '/');
    const char *at = strstr(base ? base : path, ".0");
    while (at && at[2] && at[2] != '.') at = strstr(at + 1, ".0");
    if (at) snprintf(text, size, "%.*s.%d%s", (int)(at - path), path, part, at + 2);
    return at;
}

static bool same(struct snapshot_value a, struct snapshot_value b)
{
    return a.known == b.known && a.value == b.value;
}

/* The first thing in which the headers of two parts differ, or NULL. */
static const char *header_differs(const struct snapshot_file *a, const struct snapshot_file *b)
{
    bool boxes_equal = true; /* what has no box has one of 0, at 0 */
    for (int d = 0; d < 3; d++)
        boxes_equal = boxes_equal && a->box[d] == b->box[d] && a->corner[d] == b->corner[d];
    return strcmp(a->layout, b->layout)         ? "layout"
           : a->parts != b->parts               ? "number of files"
           : !same(a->time, b->time)            ? "time"
           : !same(a->gamma, b->gamma)          ? "gamma"
           : !boxes_equal                       ? "box"
           : strcmp(a->boundary, b->boundary)   ? "boundary"
           : strcmp(a->case_name, b->case_name) ? "case"
           : a->dim != b->dim                   ? "dimension"
                                                : NULL;
}

static enum status append(struct snapshot_file *file, const struct snapshot_file *more,
                          const char *path, struct error *error)
{
    const char *other = header_differs(file, more);
    if (other)
        return error_set(error, STATUS_BAD_INPUT,
                         "%.200s: is no part of the same snapshot: the first part has another %s",
                         path, other);
    if (file->n + more->n > SNAPSHOT_ROWS_MAX)
        return error_set(error, STATUS_BAD_INPUT, "%.200s: with it %zu particles; allowed: %d",
                         path, file->n + more->n, SNAPSHOT_ROWS_MAX);
    for (int c = 0; c < SNAPSHOT_COLUMNS; c++) {
        if (!file->column[c] != !more->column[c])
            return error_set(error, STATUS_BAD_INPUT, "%.200s: has %s %s than the other parts",
                             path, more->column[c] ? "more" : "less", snapshot_column_names[c]);
        if (!file->column[c]) continue;
        double *longer = realloc(file->column[c], (file->n + more->n) * sizeof *longer);
        if (!longer) return error_set(error, STATUS_ENVIRONMENT, "no memory for %.200s", path);
        memcpy(longer + file->n, more->column[c], more->n * sizeof *longer);
        file->column[c] = longer;
    }
    for (int k = 0; k < 2; k++) file->precision[k] = fmax(file->precision[k], more->precision[k]);
    file->n = file->gas = file->n + more->n;
    return STATUS_OK;
}

static enum status read_parts(const char *path, const struct snapshot_options *options,
                              struct snapshot_file *file, struct error *error)
{
    char other[4096], value[32];
    for (int part = 1; part < file->parts; part++) {
        struct snapshot_file more;
        if (!part_path(path, part, other, sizeof other))
            return error_set(error, STATUS_BAD_INPUT,
                             "%.200s: one of %d files of a snapshot; give the first, whose name "
                             "has '.0'",
                             path, file->parts);
        enum status status = read_one(other, options, &more, error);
        if (!status) status = append(file, &more, other, error);
        snapshot_file_free(&more);
        if (status) return status;
    }
    if (file->parts > 1) {
        snprintf(value, sizeof value, "%d", file->parts);
        snapshot_note(&file->notes, "files", value, "the header says so; read as one");
    }
    if (file->total > 0 && file->total != (double)file->n)
        return error_set(error, STATUS_BAD_INPUT,
                         "%.200s: Header/NumPart_Total says %.0f gas particles, and %s %zu: a part "
                         "is missing, or the file is damaged",
                         path, file->total, file->parts > 1 ? "all parts have" : "it has", file->n);
    return STATUS_OK;
}

static void list_columns(const struct snapshot_file *file, char *text, size_t size)
{
    for (int c = 0; c < SNAPSHOT_COLUMNS; c++)
        if (file->column[c]) text_add(text, size, " %s", snapshot_column_names[c]);
}

/* ---- checks of values ---- */

static enum status check_values(const char *path, struct snapshot_file *file, struct error *error)
{
    for (int c = 0; c < SNAPSHOT_COLUMNS; c++) {
        const bool above = c == SNAPSHOT_M || c == SNAPSHOT_RHO || c == SNAPSHOT_H;
        const bool below = c == SNAPSHOT_U;
        for (size_t i = 0; file->column[c] && i < file->n; i++) {
            const double value = file->column[c][i];
            if (isfinite(value) && fabs(value) < 1e100 && !(above && !(value > 0)) &&
                !(below && value < 0))
                continue;
            file->impossible = true;
            return error_set(error, STATUS_BAD_INPUT,
                             "%.200s: %s of particle %zu is %g; allowed: %s", path,
                             snapshot_column_names[c], i, value,
                             above   ? "above 0"
                             : below ? "0 or above"
                                     : "finite numbers");
        }
    }
    return STATUS_OK;
}

enum status snapshot_check_gas(const char *path, struct snapshot_file *file, struct error *error)
{
    const double *P = file->column[SNAPSHOT_P];
    if (!P && !file->column[SNAPSHOT_U]) {
        char there[120] = "";
        list_columns(file, there, sizeof there);
        return error_set(error, STATUS_BAD_INPUT, "%.200s: neither u nor P; found:%s", path, there);
    }
    for (size_t i = 0; P && i < file->n; i++) {
        if (P[i] >= 0) continue;
        file->impossible = true;
        return error_set(error, STATUS_BAD_INPUT,
                         "%.200s: P of particle %zu is %g; allowed: 0 or above", path, i, P[i]);
    }
    return STATUS_OK;
}

static enum status check_columns(const char *path, const struct snapshot_file *file,
                                 struct error *error)
{
    static const int needed[] = {SNAPSHOT_X, SNAPSHOT_VX, SNAPSHOT_M, SNAPSHOT_RHO};
    char there[120] = "";
    list_columns(file, there, sizeof there);
    for (size_t k = 0; k < sizeof needed / sizeof *needed; k++)
        if (!file->column[needed[k]])
            return error_set(error, STATUS_BAD_INPUT,
                             "%.200s: no %s; found:%s (in text, --map %s=NAME tells its column)",
                             path, snapshot_column_names[needed[k]], *there ? there : " nothing",
                             snapshot_column_names[needed[k]]);
    if (file->gas < 4)
        return error_set(error, STATUS_BAD_INPUT, "%.200s: %zu gas particles; allowed: at least 4",
                         path, file->gas);
    if (file->column[SNAPSHOT_X + 2] && !file->column[SNAPSHOT_X + 1])
        return error_set(error, STATUS_BAD_INPUT, "%.200s: has z but no y; found:%s", path, there);
    for (int d = 1; d < file->dim; d++)
        if (!file->column[d])
            return error_set(error, STATUS_BAD_INPUT,
                             "%.200s: says that it has %d dimensions, but has no %s", path,
                             file->dim, snapshot_column_names[d]);
    return STATUS_OK;
}

/* The number of leading directions along which positions differ by more than rounding. */
static enum status find_dimension(const char *path, struct snapshot_file *file, struct error *error)
{
    int dim = 0;
    char value[16];
    double extent[3] = {0};
    for (int d = 0; d < 3 && file->column[d]; d++) {
        const double *x = file->column[d];
        double lo = x[0], hi = x[0];
        for (size_t i = 0; i < file->n; i++) lo = fmin(lo, x[i]), hi = fmax(hi, x[i]);
        extent[d] = hi - lo;
    }
    const double most = fmax(extent[0], fmax(extent[1], extent[2]));
    for (int d = 0; d < 3; d++) {
        if (!(extent[d] > SNAPSHOT_ROUNDING * most)) continue;
        if (d != dim)
            return error_set(error, STATUS_BAD_INPUT,
                             "%.200s: positions differ along %s but not along %s; allowed: flows "
                             "along the first directions",
                             path, snapshot_column_names[d], snapshot_column_names[dim]);
        dim++;
    }
    if (dim == 0)
        return error_set(error, STATUS_BAD_INPUT, "%.200s: all particles are at one place", path);
    if (file->dim && dim != file->dim)
        return error_set(error, STATUS_BAD_INPUT,
                         "%.200s: says that it has %d dimensions, but positions differ along %d",
                         path, file->dim, dim);
    snprintf(value, sizeof value, "%d", dim);
    snapshot_note(&file->notes, "dimensions", value, "%s",
                  file->dim ? "the file says so, and positions differ along as many directions"
                            : "positions differ along as many directions");
    file->dim = dim;
    for (int d = 1; d < dim; d++)
        if (!file->column[SNAPSHOT_VX + d])
            return error_set(error, STATUS_BAD_INPUT, "%.200s: no %s", path,
                             snapshot_column_names[SNAPSHOT_VX + d]);
    return STATUS_OK;
}

enum status snapshot_read(const char *path, const struct snapshot_options *options,
                          struct snapshot_file *file, struct error *error)
{
    enum status status = read_one(path, options, file, error);
    if (!status) status = read_parts(path, options, file, error);
    if (!status) status = check_columns(path, file, error);
    if (!status) status = check_values(path, file, error);
    if (!status) status = find_dimension(path, file, error);
    if (!status && file->time.known && !isfinite(file->time.value))
        status = error_set(error, STATUS_BAD_INPUT, "%.200s: time = %g; allowed: a finite number",
                           path, file->time.value);
    return status;
}
