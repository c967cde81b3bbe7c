/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "text_table.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "text.h"

bool text_table_is_text(const struct snapshot_source *source)
{
    enum { BEGINNING = 4096 };
    if (source->hdf5) return false;
    for (size_t i = 0; i < source->size && i < BEGINNING; i++) {
        const unsigned char c = source->bytes[i];
        if ((c < ' ' && c != '\n' && c != '\r' && c != '\t') || c == 127) return false;
    }
    return true;
}

/* ---- meaning of the columns ---- */

static int column_called(const struct text_table *table, const char *name, size_t length)
{
    for (size_t c = 0; c < table->columns; c++)
        if (strlen(table->names[c]) == length && strncmp(table->names[c], name, length) == 0)
            return (int)c;
    return -1;
}

static enum status apply_map(struct text_table *table, const char *map, struct error *error)
{
    bool given[SNAPSHOT_COLUMNS] = {false};
    for (const char *at = map; at && *at;) {
        const size_t length = strcspn(at, ","), ours = strcspn(at, "=");
        int meaning = 0;
        while (meaning < SNAPSHOT_COLUMNS &&
               (strlen(snapshot_column_names[meaning]) != ours ||
                strncmp(snapshot_column_names[meaning], at, ours) != 0))
            meaning++;
        if (ours >= length || meaning == SNAPSHOT_COLUMNS)
            return error_set(error, STATUS_BAD_INPUT,
                             "--map %.80s: allowed: NAME=THEIRS,..., NAME one of x y z vx vy vz m "
                             "rho u P h ax ay az du",
                             map);
        const char *theirs = at + ours + 1;
        const size_t size = length - ours - 1;
        const int column = column_called(table, theirs, size);
        if (column < 0) {
            char there[240] = "";
            for (size_t c = 0; c < table->columns; c++)
                text_add(there, sizeof there, " '%s'", table->names[c]);
            return error_set(error, STATUS_BAD_INPUT,
                             "--map %.80s: %.100s has no column '%.*s'; it has%s", map,
                             table->source->path, (int)fmin((double)size, 40), theirs, there);
        }
        if (given[meaning])
            return error_set(error, STATUS_BAD_INPUT, "--map %.80s: names %s twice; allowed: once",
                             map, snapshot_column_names[meaning]);
        given[meaning] = true;
        for (size_t c = 0; c < table->columns; c++)
            if (table->meaning[c] == meaning) table->meaning[c] = -1;
        table->meaning[column] = meaning;
        at += length + (at[length] == ',');
    }
    return STATUS_OK;
}

enum status text_table_name(struct text_table *table, const char *map, struct error *error)
{
    for (size_t c = 0; c < table->columns; c++)
        table->meaning[c] = strcmp(table->names[c], "itype") == 0
                                ? TABLE_TYPE
                                : snapshot_column_of(table->names[c]);
    if (apply_map(table, map, error)) return error->status;
    for (size_t c = 0; c < table->columns; c++)
        for (size_t k = 0; k < c; k++) {
            const int meaning = table->meaning[c];
            if (meaning < 0 || table->meaning[k] != meaning) continue;
            if (meaning == TABLE_TYPE)
                return error_set(error, STATUS_BAD_INPUT, "%.200s: two columns are called 'itype'",
                                 table->source->path);
            const char *ours = snapshot_column_names[meaning];
            return error_set(error, STATUS_BAD_INPUT,
                             "%.200s: columns '%s' and '%s' both look like %s: which one is it? "
                             "--map %s=NAME says so",
                             table->source->path, table->names[k], table->names[c], ours, ours);
        }
    return STATUS_OK;
}

/* ---- rows ---- */

enum { WORD = 48 };

static bool number_of(const char *word, size_t length, double *value)
{
    char plain[WORD];
    if (length >= sizeof plain) return false;
    memcpy(plain, word, length);
    plain[length] = '\0';
    for (char *at = plain; (at = strpbrk(at, "Dd"));) *at = 'e';
    return text_real(plain, value);
}

bool text_table_number(const char *word, double *value)
{
    return number_of(word, strlen(word), value);
}

/* A line, or the file, ends with a byte that is no blank. */
static void skip_blanks(const char **at)
{
    *at += strspn(*at, " \t\r");
}

/* Reads one number of a line that ends at `end`, after its separator unless it is the first
 * number; its text is from *word to *at. */
static bool take_number(const char **at, const char *end, char separator, bool first,
                        const char **word, double *value)
{
    skip_blanks(at);
    const bool marked = !first && separator != ' ', separated = !marked || **at == separator;
    *at += marked && separated;
    skip_blanks(at);
    *word = *at;
    while (*at < end && **at != separator && **at != ' ' && **at != '\t' && **at != '\r') ++*at;
    return separated && number_of(*word, (size_t)(*at - *word), value);
}

static bool blank(const char *line, const char *end)
{
    skip_blanks(&line);
    return line == end || *line == '#';
}

static size_t count_rows(const struct text_table *table, size_t from)
{
    size_t rows = 0;
    const char *at = (const char *)table->source->bytes + from,
               *end = (const char *)table->source->bytes + table->source->size;
    while (at < end) {
        const char *stop = memchr(at, '\n', (size_t)(end - at));
        if (!stop) stop = end;
        rows += !blank(at, stop);
        at = stop + 1;
    }
    return rows;
}

/* Reports that the text from `from` to `to` is not a number. */
static enum status no_number(const struct text_table *table, size_t line, size_t column,
                             const char *from, const char *to, struct snapshot_file *file,
                             struct error *error)
{
    char word[WORD];
    snprintf(word, sizeof word, "%.*s", (int)(to - from), from);
    file->impossible = *word && !isfinite(strtod(word, NULL)); /* "nan", "-inf" */
    return *word ? error_set(error, STATUS_BAD_INPUT,
                             "%.200s:%zu: column %zu, '%s': no number: '%s'; allowed: such as 1, "
                             "-0.5, 2.5e-3",
                             table->source->path, line, column + 1, table->names[column], word)
                 : error_set(error, STATUS_BAD_INPUT,
                             "%.200s:%zu: column %zu, '%s': no number (or a row that is too short)",
                             table->source->path, line, column + 1, table->names[column]);
}

/* Significant digits of a number as written. */
static int digits_of(const char *word, const char *end)
{
    int digits = 0;
    for (; word < end && !strchr("eEdD", *word); word++)
        if (*word >= '0' && *word <= '9') digits += digits > 0 || *word != '0';
    return digits;
}

/* Numbers are meant to half of their last digit; the one with the most digits tells where all were
 * rounded. Up to four digits are taken for short exact numbers, such as a lattice has. */
static void set_precision(struct snapshot_file *file, const int digits[2])
{
    bool fewer = false;
    for (int k = 0; k < 2; k++) {
        fewer = digits[k] > 4 && digits[k] <= DBL_DIG;
        file->precision[k] = fewer ? 0.5 * pow(10, 1 - digits[k]) : DBL_EPSILON / 2;
    }
    file->digits = fewer ? digits[1] : 0;
}

/* Fills columns, types and the precision. */
static enum status take_rows(const struct text_table *table, size_t from, size_t line,
                             struct snapshot_file *file, double *type, struct error *error)
{
    int digits[2] = {0, 0}; /* of positions, of fields */
    const char *at = (const char *)table->source->bytes + from,
               *end = (const char *)table->source->bytes + table->source->size;
    for (size_t row = 0; at < end; line++) {
        const char *stop = memchr(at, '\n', (size_t)(end - at));
        if (!stop) stop = end;
        if (!blank(at, stop)) {
            for (size_t c = 0; c < table->columns; c++) {
                const char *word;
                double value;
                if (!take_number(&at, stop, table->separator, c == 0, &word, &value))
                    return no_number(table, line, c, word, at, file, error);
                const int meaning = table->meaning[c];
                if (meaning == TABLE_TYPE) type[row] = value;
                if (meaning < 0 || meaning == TABLE_TYPE) continue;
                file->column[meaning][row] = value;
                int *most = &digits[meaning >= SNAPSHOT_VX]; /* above DBL_DIG all are a double */
                const int here = *most <= DBL_DIG ? digits_of(word, at) : 0;
                if (here > *most) *most = here;
            }
            if (!blank(at, stop))
                return error_set(error, STATUS_BAD_INPUT, "%.200s:%zu: more than %zu numbers",
                                 table->source->path, line, table->columns);
            row++;
        }
        at = stop + 1;
    }
    set_precision(file, digits);
    return STATUS_OK;
}

/* Moves gas, type 1, to the front. */
static void gas_first(struct snapshot_file *file, const double *type, double *sorted)
{
    for (int c = 0; c < SNAPSHOT_COLUMNS; c++) {
        if (!file->column[c]) continue;
        size_t at = 0;
        for (int round = 0; round < 2; round++) {
            for (size_t i = 0; i < file->n; i++)
                if ((type[i] == 1) == !round) sorted[at++] = file->column[c][i];
            if (!round) file->gas = at;
        }
        memcpy(file->column[c], sorted, file->n * sizeof *sorted);
    }
}

static void note_unit(const struct text_table *table, struct snapshot_file *file)
{
    const char *unit = table->unit;
    for (size_t c = 0; c < table->columns && !*unit; c++)
        unit = snapshot_unit(table->names[c]);
    if (*unit)
        snapshot_note(&file->notes, "units", "not converted",
                      "the names of the columns have units such as %.24s: numbers are taken as "
                      "they stand, in the units of the case",
                      unit);
}

enum status text_table_read(const struct text_table *table, size_t from, size_t line,
                            struct snapshot_file *file, struct error *error)
{
    enum status status = STATUS_OK;
    bool typed = false;
    file->n = file->gas = count_rows(table, from);
    for (size_t c = 0; c < table->columns; c++) {
        typed = typed || table->meaning[c] == TABLE_TYPE;
        if (table->meaning[c] >= 0 && table->meaning[c] < SNAPSHOT_COLUMNS)
            status = status ? status
                            : snapshot_file_make(file, (enum snapshot_column)table->meaning[c],
                                                 table->source->path, error);
    }
    double *type = calloc(2 * file->n, sizeof *type);
    if (!type)
        status = error_set(error, STATUS_ENVIRONMENT, "no memory for %.200s", table->source->path);
    if (!status) status = take_rows(table, from, line, file, type, error);
    if (!status && typed) gas_first(file, type, type + file->n);
    if (!status && file->gas < file->n) {
        char value[64];
        snprintf(value, sizeof value, "%zu of %zu rows", file->gas, file->n);
        snapshot_note(&file->notes, "gas", value, "column itype: 1 is gas as SPLASH numbers types");
    }
    free(type);
    note_unit(table, file);
    return status;
}
