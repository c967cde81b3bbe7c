/* SPDX-License-Identifier: GPL-3.0-or-later
 * Binary snapshots of GADGET (Springel 2005, user guide section 6), formats 1 and 2, either byte
 * order: Fortran records, each enclosed by its byte counts. The first is the header of 256 bytes.
 * In format 2 a record of 8 bytes before each block names the block. Format 1 has no names, and
 * codes insert additional blocks: the meaning of a record follows from its length and values, and
 * an ambiguous record is not used. */
#include <float.h>
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include "fortran.h"
#include "snapshot_file.h"
#include "text.h"

enum { HEADER = 256, RECORDS_MAX = 64, TYPES = 6 };

struct record {
    char tag[5];
    const unsigned char *bytes;
    size_t size;
};

struct binary {
    const struct snapshot_source *source;
    bool swapped; /* opposite to native byte order */
    bool tagged;
    size_t count;
    struct record record[RECORDS_MAX + 4]; /* behind the last, empty ones */
    size_t particles[TYPES], all, massive; /* massive: rows of the mass block */
    double mass[TYPES], time, redshift, box;
    int parts;
};

static double real(const struct binary *b, const unsigned char *bytes, size_t size)
{
    return fortran_real(bytes, size, b->swapped);
}

static uint32_t word(const unsigned char *bytes, bool swapped)
{
    return (uint32_t)fortran_unsigned(bytes, 4, swapped);
}

/* True if the file begins with a record of 256 bytes, or with the name of a block. */
static bool begins(const struct snapshot_source *source, bool swapped, uint32_t *first)
{
    if (source->size < HEADER + 8) return false;
    *first = word(source->bytes, swapped);
    if (*first == HEADER) return word(source->bytes + 4 + HEADER, swapped) == HEADER;
    return *first == 8 && word(source->bytes + 12, swapped) == 8 &&
           memcmp(source->bytes + 4, "HEAD", 4) == 0;
}

static bool recognises(const struct snapshot_source *source)
{
    uint32_t first;
    if (source->hdf5) return false;
    return begins(source, false, &first) || begins(source, true, &first);
}

static enum status cut_records(struct binary *b, struct error *error)
{
    const struct snapshot_source *s = b->source;
    char tag[5] = "";
    for (size_t at = 0; at < s->size;) {
        struct fortran_record next;
        if (fortran_next(s, b->swapped, b->count + 1, &at, &next, error)) return error->status;
        const size_t size = next.size;
        const unsigned char *bytes = next.bytes;
        if (b->tagged && size == 8 && !tag[0]) {
            for (int k = 0; k < 4; k++)
                tag[k] = bytes[k] > ' ' && bytes[k] < 127 ? (char)bytes[k] : ' ';
            continue;
        }
        if (b->count == RECORDS_MAX)
            return error_set(error, STATUS_BAD_INPUT, "%.200s: more than %d records", s->path,
                             RECORDS_MAX);
        struct record *record = &b->record[b->count++];
        memcpy(record->tag, tag, sizeof tag);
        record->bytes = bytes;
        record->size = size;
        tag[0] = '\0';
    }
    return STATUS_OK;
}

static enum status read_header(struct binary *b, struct error *error)
{
    const unsigned char *h = b->record[0].bytes;
    const char *path = b->source->path;
    if (b->count < 3 || b->record[0].size != HEADER)
        return error_set(error, STATUS_BAD_INPUT,
                         "%.200s: %zu records, the first of %zu bytes; allowed: a header of %d "
                         "bytes, positions, velocities ...",
                         path, b->count, b->record[0].size, HEADER);
    for (int t = 0; t < TYPES; t++) {
        b->particles[t] = word(h + 4 * t, b->swapped);
        b->mass[t] = real(b, h + 24 + 8 * t, 8);
        if (b->particles[t] > SNAPSHOT_ROWS_MAX || !(b->mass[t] >= 0 && isfinite(b->mass[t])))
            return error_set(error, STATUS_BAD_INPUT,
                             "%.200s: header: %zu particles of type %d, of mass %g; allowed: up "
                             "to %d, of masses that are not negative",
                             path, b->particles[t], t, b->mass[t], SNAPSHOT_ROWS_MAX);
        b->all += b->particles[t];
        if (b->mass[t] == 0) b->massive += b->particles[t];
    }
    b->time = real(b, h + 72, 8);
    b->redshift = real(b, h + 80, 8);
    b->parts = (int)word(h + 124, b->swapped);
    b->box = real(b, h + 128, 8);
    if (b->particles[0] == 0)
        return error_set(error, STATUS_BAD_INPUT, "%.200s: no gas: %zu particles of other types%s",
                         path, b->all, b->particles[1] ? " (dark matter only?)" : "");
    if (!isfinite(b->time) || b->parts < 0 || b->parts > SNAPSHOT_PARTS_MAX)
        return error_set(
            error, STATUS_BAD_INPUT,
            "%.200s: header: time %g, %d files; allowed: a finite time, up to %d files", path,
            b->time, b->parts, SNAPSHOT_PARTS_MAX);
    if (b->redshift > 0 && fabs(b->time * (1 + b->redshift) - 1) < 1e-6)
        return error_set(error, STATUS_BAD_INPUT,
                         "%.200s: comoving units (redshift %g at time %g); allowed: runs in a box "
                         "at rest",
                         path, b->redshift, b->time);
    return STATUS_OK;
}

/* Bytes of a number if the record has `count` > 0 numbers, else 0. */
static size_t width_of(const struct record *record, size_t count)
{
    if (record->size == 4 * count) return 4;
    if (record->size == 8 * count) return 8;
    return 0;
}

/* ---- meaning of the records ---- */

enum { POSITIONS, VELOCITIES, MASSES, ENERGIES, DENSITIES, WIDTHS, ACCELERATIONS, BLOCKS };
static const char *const tags[BLOCKS] = {"POS ", "VEL ", "MASS", "U   ", "RHO ", "HSML", "ACCE"};
static const enum snapshot_column columns[BLOCKS] = {
    SNAPSHOT_X, SNAPSHOT_VX, SNAPSHOT_M, SNAPSHOT_U, SNAPSHOT_RHO, SNAPSHOT_H, SNAPSHOT_AX};

struct layout {
    const struct record *block[BLOCKS]; /* NULL: missing */
};

static double gas_value(const struct binary *b, const struct record *record, size_t count, size_t i)
{
    const size_t width = width_of(record, count);
    return real(b, record->bytes + width * i, width);
}

static bool positive(double value)
{
    return value > 1e-30 && value < 1e30;
}

/* True if the records may be masses, energies, densities and smoothing lengths of the gas: all
 * positive, with a total volume between half and twice that of the box (or of the extent of the
 * particles, without a box), and smoothing lengths of 0.3 to 30 spacings. */
static bool plausible(const struct binary *b, const struct layout *layout, double volume, int dim)
{
    const struct record *m = b->mass[0] > 0 ? NULL : layout->block[MASSES],
                        *u = layout->block[ENERGIES], *rho = layout->block[DENSITIES],
                        *h = layout->block[WIDTHS];
    const size_t n = b->particles[0];
    double filled = 0;
    for (size_t i = 0; i < n; i++) {
        const double mass = m ? gas_value(b, m, b->massive, i) : b->mass[0];
        const double density = gas_value(b, rho, n, i);
        if (!positive(mass) || !positive(density) || !positive(gas_value(b, u, n, i))) return false;
        filled += mass / density;
        const double spacing = pow(mass / density, 1. / dim);
        const double spacings = (h ? gas_value(b, h, n, i) : spacing) / spacing;
        if (!(spacings > 0.3 && spacings < 30)) return false;
    }
    return filled > 0.5 * volume && filled < 2 * volume;
}

static void extent(const struct binary *b, const struct record *positions, int *dim, double *volume)
{
    const size_t width = width_of(positions, 3 * b->all);
    double length[3], most = 0;
    *volume = 1;
    *dim = 0;
    for (size_t d = 0; d < 3; d++) {
        double lo = INFINITY, hi = -INFINITY;
        for (size_t i = 0; i < b->particles[0]; i++) {
            const double x = real(b, positions->bytes + width * (3 * i + d), width);
            lo = fmin(lo, x), hi = fmax(hi, x);
        }
        length[d] = hi - lo;
        most = fmax(most, length[d]);
    }
    for (size_t d = 0; d < 3; d++) {
        if (!(length[d] > SNAPSHOT_ROUNDING * most)) continue;
        ++*dim;
        *volume *= b->box > 0 && length[d] > 0.5 * b->box ? b->box : length[d];
    }
}

/* Assigns the blocks from record `first` on in the order of the user guide. */
static bool try_layout(const struct binary *b, size_t first, struct layout *layout)
{
    size_t at = first;
    const size_t n = b->particles[0];
    if (b->massive) layout->block[MASSES] = &b->record[at++];
    for (int k = ENERGIES; k <= WIDTHS; k++) layout->block[k] = &b->record[at++];
    if (b->massive && !width_of(layout->block[MASSES], b->massive)) return false;
    if (!width_of(layout->block[WIDTHS], n)) layout->block[WIDTHS] = NULL;
    return width_of(layout->block[ENERGIES], n) && width_of(layout->block[DENSITIES], n);
}

static enum status infer(const struct binary *b, struct layout *layout,
                         struct snapshot_notes *notes, struct error *error)
{
    int dim, fits = 0;
    double volume;
    struct layout found = {0};
    extent(b, &b->record[1], &dim, &volume);
    for (size_t first = 3; first < b->count; first++) {
        struct layout tried = *layout;
        if (!try_layout(b, first, &tried) || !plausible(b, &tried, volume, dim)) continue;
        if (tried.block[WIDTHS] && !found.block[WIDTHS]) fits = 0; /* stronger evidence */
        if (!tried.block[WIDTHS] && found.block[WIDTHS]) continue;
        if (!fits++) found = tried;
    }
    if (fits != 1)
        return error_set(error, STATUS_BAD_INPUT,
                         "%.200s: format 1 does not name its blocks, and of %zu records %s as "
                         "masses, energies, densities and widths; write format 2 (SnapFormat=2) or "
                         "HDF5",
                         b->source->path, b->count,
                         fits ? "more than one choice fits" : "none fit");
    *layout = found;
    const struct record *begin = found.block[b->massive ? MASSES : ENERGIES];
    char value[64];
    snprintf(value, sizeof value, "%s from record %td on", b->massive ? "masses" : "energies",
             begin - b->record + 1);
    snapshot_note(notes, "blocks", value,
                  "format 1 names none: of %zu records only these give positive masses, energies "
                  "and densities, sum m/rho within a factor of 2 of the volume %.4g, and widths "
                  "of 0.3 to 30 spacings%s",
                  b->count, volume,
                  begin > b->record + 4 ? "; the records before them are the code's own" : "");
    return STATUS_OK;
}

static enum status refuse_block(const struct binary *b, const char *tag, struct error *error)
{
    enum { NAMES = 28, LENGTH = 7 };
    char names[NAMES * LENGTH + 1] = "";
    for (size_t r = 1; r < b->count && r <= NAMES; r++)
        text_add(names, sizeof names, " '%s'", b->record[r].tag);
    return error_set(error, STATUS_BAD_INPUT, "%.200s: no block '%s'; it has:%s", b->source->path,
                     tag, names);
}

static enum status find_blocks(const struct binary *b, struct layout *layout,
                               struct snapshot_notes *notes, struct error *error)
{
    *layout = (struct layout){0};
    for (size_t r = 1; b->tagged && r < b->count; r++)
        for (int k = 0; k < BLOCKS; k++)
            if (strcmp(b->record[r].tag, tags[k]) == 0 && !layout->block[k])
                layout->block[k] = &b->record[r];
    if (!b->tagged) {
        layout->block[POSITIONS] = &b->record[1];
        layout->block[VELOCITIES] = &b->record[2];
    }
    for (int k = POSITIONS; k <= VELOCITIES; k++)
        if (!layout->block[k] || !width_of(layout->block[k], 3 * b->all))
            return error_set(error, STATUS_BAD_INPUT,
                             "%.200s: %s of %zu particles take %zu or %zu bytes; the record has "
                             "%zu",
                             b->source->path, k ? "velocities" : "positions", b->all, 12 * b->all,
                             24 * b->all, layout->block[k] ? layout->block[k]->size : (size_t)0);
    if (!b->tagged) return infer(b, layout, notes, error);
    if (b->massive && !layout->block[MASSES]) return refuse_block(b, tags[MASSES], error);
    return layout->block[DENSITIES] ? STATUS_OK : refuse_block(b, tags[DENSITIES], error);
}

/* ---- into columns ---- */

/* A block of accelerations has those of the gas or, as surely if it is as long as that of the
 * velocities, of all particles: its length alone may fit both with words of 8 or 4 bytes. */
static enum status take_block(const struct binary *b, const struct layout *layout, int block,
                              struct snapshot_file *file, struct error *error)
{
    const struct record *record = layout->block[block];
    const enum snapshot_column column = columns[block];
    const bool vector = block == POSITIONS || block == VELOCITIES || block == ACCELERATIONS;
    const size_t each = vector ? 3 : 1;
    const size_t rows = block == POSITIONS || block == VELOCITIES ? b->all
                        : block == MASSES                         ? b->massive
                                                                  : b->particles[0];
    size_t width = width_of(record, each * rows);
    if (block == ACCELERATIONS && (!width || record->size == layout->block[VELOCITIES]->size))
        width = width_of(record, each * b->all);
    if (!width)
        return error_set(error, STATUS_BAD_INPUT,
                         "%.200s: block '%s' has %zu bytes; allowed: %zu "
                         "or %zu",
                         b->source->path, tags[block], record->size, 4 * each * rows,
                         8 * each * rows);
    for (size_t d = 0; d < each; d++) {
        if (snapshot_file_make(file, (enum snapshot_column)(column + d), b->source->path, error))
            return error->status;
        for (size_t i = 0; i < file->n; i++)
            file->column[column + d][i] = real(b, record->bytes + width * (each * i + d), width);
    }
    double *precision = &file->precision[column >= SNAPSHOT_VX];
    *precision = fmax(*precision, width == 4 ? (double)FLT_EPSILON / 2 : DBL_EPSILON / 2);
    return STATUS_OK;
}

static enum status take_blocks(const struct binary *b, const struct layout *layout,
                               struct snapshot_file *file, struct error *error)
{
    file->n = file->gas = b->particles[0];
    for (int k = 0; k < BLOCKS; k++)
        if (layout->block[k] && (k != MASSES || b->mass[0] == 0) &&
            take_block(b, layout, k, file, error))
            return error->status;
    if (!(b->mass[0] > 0)) return STATUS_OK;
    snapshot_note(&file->notes, "masses", "from the header's table", "%.9g", b->mass[0]);
    return snapshot_file_fill(file, SNAPSHOT_M, b->mass[0], b->source->path, error);
}

static enum status read(const struct snapshot_source *source,
                        const struct snapshot_options *options, struct snapshot_file *file,
                        struct error *error)
{
    struct binary b = {.source = source};
    struct layout layout;
    uint32_t first = 0;
    (void)options;
    b.swapped = !begins(source, false, &first);
    if (b.swapped) begins(source, true, &first);
    b.tagged = first == 8;
    if (cut_records(&b, error) || read_header(&b, error) ||
        find_blocks(&b, &layout, &file->notes, error) || take_blocks(&b, &layout, file, error))
        return error->status;
    file->time = (struct snapshot_value){true, b.time};
    file->boxed = b.box > 0 && isfinite(b.box);
    for (int d = 0; d < 3; d++) file->box[d] = file->boxed ? b.box : 0;
    if (b.parts) file->parts = b.parts;
    snprintf(file->code, sizeof file->code, "GADGET or its kin");
    snapshot_note(&file->notes, "format", b.tagged ? "2" : "1", "%s byte order, %zu records",
                  b.swapped ? "the other" : "this machine's", b.count);
    if (file->precision[0] < file->precision[1])
        snapshot_note(&file->notes, "positions", "float64",
                      "24 bytes a particle; the other fields are float32");
    return STATUS_OK;
}

const struct snapshot_reader reader_gadget = {
    {"gadget", "binary of GADGET, formats 1 and 2", "Springel 2005"}, recognises, read};
