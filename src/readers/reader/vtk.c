/* SPDX-License-Identifier: GPL-3.0-or-later
 * Legacy VTK files (.vtk; The VTK User's Guide, "VTK File Formats"), as written by converters of
 * DualSPHysics and PySPH: POINTS of POLYDATA or of an UNSTRUCTURED_GRID with SCALARS, VECTORS and
 * FIELD arrays of POINT_DATA, as text or binary, which is big-endian. There is no time, box or
 * gamma, except that a FIELD array TimeValue or TIME before the points is the time. */
#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "text_table.h"
#include "vtk_type.h"

enum { WORD = 64 };

struct vtk {
    const struct snapshot_source *source;
    const char *at, *end;
    bool binary;
    struct error *error;
    size_t cells; /* with data of their own */
};

/* The entities to which the following arrays belong. */
enum part { WHOLE, POINTS, CELLS };

struct array {
    char name[WORD], type[WORD];
    size_t components, tuples;
};

static bool refuse(const struct vtk *vtk, const char *what, const char *name)
{
    error_set(vtk->error, STATUS_BAD_INPUT, "%.200s: legacy VTK: %s%s", vtk->source->path, what,
              name);
    return false;
}

/* The next word; "" at the end. */
static const char *next_word(struct vtk *vtk, char word[WORD])
{
    size_t n = 0;
    while (isspace((unsigned char)*vtk->at)) vtk->at++;
    while (vtk->at < vtk->end && !isspace((unsigned char)*vtk->at)) {
        if (n + 1 < WORD) word[n++] = *vtk->at;
        vtk->at++;
    }
    word[n] = '\0';
    return word;
}

/* Reads a count that is at most the number of bytes in the file. */
static bool next_count(struct vtk *vtk, const char *what, size_t *count)
{
    char word[WORD];
    double value;
    if (!text_table_number(next_word(vtk, word), &value) || !(value >= 0) ||
        value != floor(value) || value > fmin((double)vtk->source->size, SNAPSHOT_ROWS_MAX))
        return refuse(vtk, "no number that the file has room for stands behind ", what);
    *count = (size_t)value;
    return true;
}

static void skip_line(struct vtk *vtk)
{
    while (vtk->at < vtk->end && *vtk->at++ != '\n') {
    }
}

/* ---- numbers ---- */

/* Reads the numbers of an array; to = NULL skips them. */
static bool take_numbers(struct vtk *vtk, const struct array *array, double *to)
{
    const size_t n = array->components * array->tuples;
    const struct vtk_type *type = vtk_type_of(array->type);
    const bool little = __BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__;
    char word[WORD];
    double value;
    if (!type) return refuse(vtk, "numbers of an unknown type: ", array->type);
    if (!vtk->binary) {
        for (size_t i = 0; i < n; i++) {
            if (!text_table_number(next_word(vtk, word), &value))
                return refuse(vtk, "is cut off, or has no number where one is due, in ",
                              array->name);
            if (to) to[i] = value;
        }
        return true;
    }
    skip_line(vtk);
    if (n > (size_t)(vtk->end - vtk->at) / type->width)
        return refuse(vtk, "is cut off in ", array->name);
    for (size_t i = 0; i < n; i++, vtk->at += type->width)
        if (to) to[i] = vtk_number(type, (const unsigned char *)vtk->at, little);
    return true;
}

/* ---- meaning of the arrays ---- */

static bool take_points(struct vtk *vtk, const struct array *array, int column,
                        struct snapshot_file *file)
{
    if (column < 0 || array->components != (vtk_is_vector(column) ? 3 : 1))
        return take_numbers(vtk, array, NULL);
    if (array->tuples != file->n)
        return refuse(vtk, "another number of tuples than of points has ", array->name);
    if (file->column[column]) return refuse(vtk, "there are two arrays for ", array->name);
    double *all = malloc(array->components * file->n * sizeof *all);
    if (!all) error_set(vtk->error, STATUS_ENVIRONMENT, "no memory for %.200s", vtk->source->path);
    const bool well = all && take_numbers(vtk, array, all) &&
                      !vtk_columns(file, column, array->components, all, array->type,
                                   vtk->source->path, vtk->error);
    free(all);
    return well;
}

/* Skips what VTK writes behind an array about its components; it ends with an empty line, or with
 * the file. */
static void skip_metadata(struct vtk *vtk)
{
    const char *empty = strstr(vtk->at, "\n\n");
    vtk->at = empty ? empty : vtk->end;
}

/* Reads FIELD name count, then arrays of the part of the file. */
static bool take_field(struct vtk *vtk, enum part part, struct snapshot_file *file)
{
    char word[WORD];
    size_t count;
    next_word(vtk, word);
    if (!next_count(vtk, "FIELD", &count)) return false;
    for (size_t k = 0; k < count; k++) {
        struct array array;
        if (!strcmp(next_word(vtk, array.name), "METADATA")) {
            skip_metadata(vtk);
            next_word(vtk, array.name);
        }
        if (!next_count(vtk, array.name, &array.components) ||
            !next_count(vtk, array.name, &array.tuples))
            return false;
        next_word(vtk, array.type);
        if (array.components > 9) return refuse(vtk, "more than 9 components has ", array.name);
        const bool time = part == WHOLE && array.components * array.tuples == 1 &&
                          (!strcmp(array.name, "TimeValue") || !strcmp(array.name, "TIME"));
        if (time) {
            file->time.known = true;
            if (!take_numbers(vtk, &array, &file->time.value)) return false;
        } else if (!take_points(vtk, &array, part == POINTS ? snapshot_column_of(array.name) : -1,
                                file)) {
            return false;
        }
    }
    return true;
}

/* Reads SCALARS name type [components] and a line LOOKUP_TABLE name, or VECTORS name type; those of
 * cells are skipped. */
static bool take_attribute(struct vtk *vtk, bool vectors, enum part part,
                           struct snapshot_file *file)
{
    struct array array = {.components = vectors ? 3 : 1,
                          .tuples = part == CELLS ? vtk->cells : file->n};
    char word[WORD];
    double value;
    next_word(vtk, array.name), next_word(vtk, array.type);
    if (!vectors) {
        const char *before = vtk->at;
        if (text_table_number(next_word(vtk, word), &value)) {
            if (!(value >= 1 && value <= 4))
                return refuse(vtk, "1 to 4 components are allowed for ", array.name);
            array.components = (size_t)value;
            before = vtk->at;
        }
        vtk->at = before;
        if (strcmp(next_word(vtk, word), "LOOKUP_TABLE") != 0)
            return refuse(vtk, "no LOOKUP_TABLE stands behind SCALARS ", array.name);
        next_word(vtk, word);
    }
    return take_points(vtk, &array, part == CELLS ? -1 : snapshot_column_of(array.name), file);
}

/* Skips CELLS, VERTICES ...: count and size of one array, or, since version 5.1, of two with their
 * own names and types. */
static bool skip_cells(struct vtk *vtk)
{
    struct array cells[2] = {{.name = "cells", .components = 1, .type = "int"}};
    char word[WORD];
    cells[1] = cells[0];
    for (int k = 0; k < 2; k++)
        if (!next_count(vtk, "cells", &cells[k].tuples)) return false;
    const char *before = vtk->at;
    if (strcmp(next_word(vtk, word), "OFFSETS") != 0) {
        vtk->at = before;
        return take_numbers(vtk, &cells[1], NULL);
    }
    next_word(vtk, cells[0].type);
    if (!take_numbers(vtk, &cells[0], NULL)) return false;
    if (strcmp(next_word(vtk, word), "CONNECTIVITY") != 0)
        return refuse(vtk, "CONNECTIVITY stands behind OFFSETS, not ", word);
    next_word(vtk, cells[1].type);
    return take_numbers(vtk, &cells[1], NULL);
}

static bool take_section(struct vtk *vtk, const char *word, enum part *part,
                         struct snapshot_file *file)
{
    struct array array = {.components = 3};
    char ignored[WORD];
    size_t count;
    if (!strcmp(word, "DATASET")) {
        if (strcmp(next_word(vtk, ignored), "POLYDATA") && strcmp(ignored, "UNSTRUCTURED_GRID"))
            return refuse(vtk, "allowed: POLYDATA or UNSTRUCTURED_GRID, not ", ignored);
        return true;
    }
    if (!strcmp(word, "FIELD")) return take_field(vtk, *part, file);
    if (!strcmp(word, "POINTS")) {
        snprintf(array.name, sizeof array.name, "POINTS");
        if (file->n || !next_count(vtk, word, &file->n) || file->n < 1)
            return refuse(vtk, "allowed: one set of points, not ", word);
        array.tuples = file->gas = file->n;
        next_word(vtk, array.type);
        return take_points(vtk, &array, SNAPSHOT_X, file);
    }
    if (!strcmp(word, "POINT_DATA")) {
        *part = POINTS;
        if (!next_count(vtk, word, &count)) return false;
        return count == file->n || refuse(vtk, "another number than of points has ", word);
    }
    if (!strcmp(word, "CELL_DATA")) {
        *part = CELLS;
        return next_count(vtk, word, &vtk->cells);
    }
    if (!strcmp(word, "SCALARS") || !strcmp(word, "VECTORS") || !strcmp(word, "NORMALS"))
        return take_attribute(vtk, *word != 'S', *part, file);
    if (!strcmp(word, "CELLS") || !strcmp(word, "VERTICES") || !strcmp(word, "LINES"))
        return skip_cells(vtk);
    if (!strcmp(word, "CELL_TYPES")) {
        array = (struct array){.name = "cells", .components = 1, .type = "int"};
        return next_count(vtk, "cells", &array.tuples) && take_numbers(vtk, &array, NULL);
    }
    if (!strcmp(word, "METADATA")) {
        skip_metadata(vtk);
        return true;
    }
    return refuse(vtk, "an unknown word: ", word);
}

static bool recognises(const struct snapshot_source *source)
{
    static const char start[] = "# vtk DataFile Version";
    return !source->hdf5 && !strncmp((const char *)source->bytes, start, strlen(start));
}

static enum status read_vtk(const struct snapshot_source *source,
                            const struct snapshot_options *options, struct snapshot_file *file,
                            struct error *error)
{
    const char *text = (const char *)source->bytes;
    struct vtk vtk = {.source = source, .at = text, .end = text + source->size, .error = error};
    char word[WORD];
    enum part part = WHOLE;
    (void)options;
    skip_line(&vtk), skip_line(&vtk); /* version and title */
    next_word(&vtk, word);
    vtk.binary = !strcmp(word, "BINARY");
    if (!vtk.binary && strcmp(word, "ASCII")) {
        refuse(&vtk, "the third line is neither ASCII nor BINARY: ", word);
        return error->status;
    }
    /* data of cells behind those of points are not needed */
    while (*next_word(&vtk, word) && (part != POINTS || strcmp(word, "CELL_DATA")))
        if (!take_section(&vtk, word, &part, file)) return error->status;
    if (!file->n) {
        refuse(&vtk, "has no ", "POINTS");
        return error->status;
    }
    snprintf(file->code, sizeof file->code, "unknown");
    return STATUS_OK;
}

const struct snapshot_reader reader_vtk = {
    {"vtk", "legacy VTK: points of POLYDATA or UNSTRUCTURED_GRID", ""}, recognises, read_vtk};
