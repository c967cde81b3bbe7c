/* SPDX-License-Identifier: GPL-3.0-or-later
 * Full dumps of Phantom (user guide, "The phantom native binary format"): Fortran records with
 * magic numbers, a name, a header of eight kinds of numbers with their tags, and arrays of the same
 * kinds. The first group of arrays contains the particles. */
#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "fortran.h"
#include "phantom_gas.h"

enum { KINDS = 8, TAG = 16, HEADER_MAX = 4096, ARRAYS_MAX = 512, FIRST_REAL = 5 };
enum { MAGIC_FIRST = 60769, MAGIC_SECOND = 60878, MAGIC_THIRD = 690706 };

struct dump {
    const struct snapshot_source *source;
    bool swapped;
    size_t at, count;    /* offset of the next record; number of records read */
    size_t bytes[KINDS]; /* size of a number of each kind */
    char arrays[200];    /* names of the particle arrays, as many as fit */
};

/* Reads the first record: magic numbers as an integer, a real and two or three integers, all of
 * the default kinds of 4 or 8 bytes. */
static bool begins(struct dump *dump, bool swapped)
{
    struct error ignored = {0};
    struct fortran_record record;
    *dump = (struct dump){.source = dump->source, .swapped = swapped, .count = 1};
    if (dump->source->hdf5 || fortran_next(dump->source, swapped, 1, &dump->at, &record, &ignored))
        return false;
    const unsigned char *b = record.bytes;
    const size_t i = record.size > 24 ? 8 : 4, r = record.size - 4 * i;
    const size_t sizes[KINDS] = {i, 1, 2, 4, 8, r, 4, 8};
    memcpy(dump->bytes, sizes, sizeof sizes);
    return (r == 4 || r == 8) && fortran_integer(b, i, swapped) == MAGIC_FIRST &&
           fortran_real(b + i, r, swapped) == MAGIC_SECOND &&
           fortran_integer(b + i + r, i, swapped) == MAGIC_SECOND &&
           fortran_integer(b + 3 * i + r, i, swapped) == MAGIC_THIRD;
}

static bool recognises(const struct snapshot_source *source)
{
    struct dump dump = {.source = source};
    return begins(&dump, false) || begins(&dump, true);
}

static enum status next(struct dump *dump, size_t size, const char *what,
                        struct fortran_record *record, struct error *error)
{
    const size_t from = dump->at;
    if (fortran_next(dump->source, dump->swapped, ++dump->count, &dump->at, record, error))
        return error->status;
    if (record->size == size) return STATUS_OK;
    return error_set(error, STATUS_BAD_INPUT,
                     "%.200s: damaged: record %zu at byte %zu, %s, has %zu bytes; allowed: %zu",
                     dump->source->path, dump->count, from, what, record->size, size);
}

static double number(const struct dump *dump, const unsigned char *bytes, int kind)
{
    return (kind < FIRST_REAL ? fortran_integer : fortran_real)(bytes, dump->bytes[kind],
                                                                dump->swapped);
}

/* True if a tag, padded with blanks, equals name. */
static bool is_tag(const unsigned char *tag, const char *name)
{
    const size_t n = strlen(name);
    for (size_t k = n; k < TAG; k++)
        if (tag[k] != ' ') return false;
    return memcmp(tag, name, n) == 0;
}

/* ---- the header ---- */

struct values {
    struct phantom_header header;
    double blocks;
    bool end[3][2]; /* ends of the box that are given */
};

static void take_value(const unsigned char *tag, double value, struct values *values)
{
    static const char *const ends[3][2] = {{"xmin", "xmax"}, {"ymin", "ymax"}, {"zmin", "zmax"}};
    struct phantom_header *header = &values->header;
    const struct snapshot_value known = {true, value};
    if (is_tag(tag, "massoftype") && header->types < PHANTOM_TYPES_MAX)
        header->masses[header->types++] = value;
    if (is_tag(tag, "hfact")) header->hfact = known;
    if (is_tag(tag, "time")) header->time = known;
    if (is_tag(tag, "gamma")) header->gamma = known;
    if (is_tag(tag, "nblocks")) values->blocks = value;
    for (int d = 0; d < 3; d++)
        for (int k = 0; k < 2; k++)
            if (is_tag(tag, ends[d][k])) {
                (k ? header->hi : header->lo)[d] = value;
                values->end[d][k] = true;
            }
}

static enum status read_header(struct dump *dump, struct values *values, struct error *error)
{
    struct fortran_record count, tags, numbers;
    for (int kind = 0; kind < KINDS; kind++) {
        if (next(dump, 4, "a count of the header", &count, error)) return error->status;
        const double n = fortran_integer(count.bytes, 4, dump->swapped);
        if (!(n >= 0 && n <= HEADER_MAX))
            return error_set(error, STATUS_BAD_INPUT,
                             "%.200s: damaged: %g values of one kind in the header; allowed: 0 to "
                             "%d",
                             dump->source->path, n, HEADER_MAX);
        if (n == 0) continue;
        if (next(dump, TAG * (size_t)n, "tags of the header", &tags, error) ||
            next(dump, dump->bytes[kind] * (size_t)n, "values of the header", &numbers, error))
            return error->status;
        for (size_t k = 0; k < (size_t)n; k++)
            take_value(tags.bytes + TAG * k,
                       number(dump, numbers.bytes + dump->bytes[kind] * k, kind), values);
    }
    values->header.boxed = true;
    for (int d = 0; d < 3; d++)
        values->header.boxed = values->header.boxed && values->end[d][0] && values->end[d][1];
    return STATUS_OK;
}

/* ---- arrays ---- */

static const struct {
    const char *tag;
    enum snapshot_column column;
} columns[] = {{"x", SNAPSHOT_X},   {"y", SNAPSHOT_X + 1},    {"z", SNAPSHOT_X + 2},
               {"vx", SNAPSHOT_VX}, {"vy", SNAPSHOT_VX + 1},  {"vz", SNAPSHOT_VX + 2},
               {"u", SNAPSHOT_U},   {"pressure", SNAPSHOT_P}, {"h", SNAPSHOT_H}};

static void note_array(struct dump *dump, const unsigned char *tag)
{
    char name[TAG + 1];
    const size_t used = strlen(dump->arrays);
    snprintf(name, sizeof name, "%.*s", TAG, (const char *)tag);
    name[strcspn(name, " ")] = '\0';
    snprintf(dump->arrays + used, sizeof dump->arrays - used, " %s", name);
}

/* Reads one particle array: into its column or types, else skips it. */
static enum status take_array(struct dump *dump, int kind, struct snapshot_file *file,
                              double **types, struct error *error)
{
    struct fortran_record tag, array;
    double *to = NULL;
    if (next(dump, TAG, "a tag", &tag, error) ||
        next(dump, dump->bytes[kind] * file->n, "an array", &array, error))
        return error->status;
    note_array(dump, tag.bytes);
    for (size_t c = 0; c < sizeof columns / sizeof *columns; c++) {
        if (!is_tag(tag.bytes, columns[c].tag) || kind < FIRST_REAL) continue;
        if (snapshot_file_make(file, columns[c].column, dump->source->path, error))
            return error->status;
        to = file->column[columns[c].column];
        double *precision = &file->precision[columns[c].column >= SNAPSHOT_VX];
        *precision =
            fmax(*precision, (dump->bytes[kind] == 4 ? (double)FLT_EPSILON : DBL_EPSILON) / 2);
    }
    if (is_tag(tag.bytes, "itype") && !*types) {
        to = *types = calloc(file->n, sizeof *to);
        if (!to)
            return error_set(error, STATUS_ENVIRONMENT, "no memory for %.200s", dump->source->path);
    }
    for (size_t i = 0; to && i < file->n; i++)
        to[i] = number(dump, array.bytes + dump->bytes[kind] * i, kind);
    return STATUS_OK;
}

/* Reads the number of groups, a record of lengths for each, and the arrays of the first group. */
static enum status read_arrays(struct dump *dump, struct snapshot_file *file, double **types,
                               struct error *error)
{
    struct fortran_record groups, lengths = {0}, first = {0};
    if (next(dump, 4, "the number of groups of arrays", &groups, error)) return error->status;
    const double n = fortran_integer(groups.bytes, 4, dump->swapped);
    for (double k = 0; k < n; k++) {
        if (next(dump, 8 + 4 * KINDS, "lengths of arrays", &lengths, error)) return error->status;
        if (k == 0) first = lengths;
    }
    const double rows = n >= 1 ? fortran_integer(first.bytes, 8, dump->swapped) : 0;
    if (!(rows >= 1 && rows <= SNAPSHOT_ROWS_MAX))
        return error_set(error, STATUS_BAD_INPUT,
                         "%.200s: %g groups of arrays, %g particles; allowed: at least one group, "
                         "1 to %d particles",
                         dump->source->path, n, rows, SNAPSHOT_ROWS_MAX);
    file->n = file->gas = (size_t)rows;
    for (int kind = 0; kind < KINDS; kind++) {
        const double arrays = fortran_integer(first.bytes + 8 + 4 * kind, 4, dump->swapped);
        if (!(arrays >= 0 && arrays <= ARRAYS_MAX))
            return error_set(error, STATUS_BAD_INPUT,
                             "%.200s: damaged: %g arrays of one kind; allowed: 0 to %d",
                             dump->source->path, arrays, ARRAYS_MAX);
        for (size_t k = 0; k < (size_t)arrays; k++)
            if (take_array(dump, kind, file, types, error)) return error->status;
    }
    return STATUS_OK;
}

static enum status check_kind(const char *path, const char *name, double blocks,
                              struct error *error)
{
    if (name[0] != 'F' || name[1] != 'T')
        return error_set(error, STATUS_BAD_INPUT,
                         "%.200s: Phantom's dump of kind '%.2s'; allowed: FT, full and with tags; "
                         "`splash to ascii FILE` makes a table of others",
                         path, name);
    if (blocks > 1)
        return error_set(error, STATUS_BAD_INPUT,
                         "%.200s: in %g blocks, one of each process; allowed: 1; `splash to ascii "
                         "FILE` joins them",
                         path, blocks);
    return STATUS_OK;
}

static enum status read(const struct snapshot_source *source,
                        const struct snapshot_options *options, struct snapshot_file *file,
                        struct error *error)
{
    struct dump dump = {.source = source};
    struct values values = {0};
    struct fortran_record name;
    double *types = NULL;
    char words[101];
    (void)options;
    if (!begins(&dump, false)) begins(&dump, true);
    if (next(&dump, 100, "the name", &name, error)) return error->status;
    snprintf(words, sizeof words, "%.100s", (const char *)name.bytes);
    status_clean(words);
    if (check_kind(source->path, words, 1, error) || read_header(&dump, &values, error) ||
        check_kind(source->path, words, values.blocks, error))
        return error->status;
    enum status status = read_arrays(&dump, file, &types, error);
    if (!status && (!file->column[SNAPSHOT_X] || !file->column[SNAPSHOT_X + 1] ||
                    !file->column[SNAPSHOT_X + 2] || !file->column[SNAPSHOT_H]))
        status = error_set(error, STATUS_BAD_INPUT,
                           "%.200s: its particles need real arrays x, y, z and h; they have:%s",
                           source->path, dump.arrays);
    snprintf(file->code, sizeof file->code, "%.79s", words + 3);
    file->code[strcspn(file->code, " ")] = '\0';
    if (!status) status = phantom_gas(source->path, &values.header, types, file, error);
    free(types);
    return status;
}

const struct snapshot_reader reader_phantom = {
    {"phantom", "full dumps of Phantom", "Price et al. 2018"}, recognises, read};
