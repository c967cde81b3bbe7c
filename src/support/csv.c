/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "csv.h"

#include <errno.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "text.h"

struct reader {
    FILE *stream;
    const char *path;
    size_t line, bytes;
    const char *separators; /* a comma if the line of names has one, otherwise blanks */
    char text[CSV_LINE_MAX + 1];
    struct error *error;
};

/* Sets STATUS_BAD_INPUT, with file, line and character before the message. */
static enum status __attribute__((format(printf, 3, 4)))
fail(const struct reader *reader, size_t character, const char *format, ...)
{
    char what[256];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(what, sizeof what, format, arguments);
    va_end(arguments);
    return error_set(reader->error, STATUS_BAD_INPUT, "%.200s:%zu:%zu: %s", reader->path,
                     reader->line, character, what);
}

/* Reads the next line, without its end, into text; *more is false at the end of the file. */
static enum status next_line(struct reader *reader, bool *more)
{
    size_t n = 0;
    int c;
    reader->line++;
    while ((c = getc(reader->stream)) != EOF && c != '\n') {
        if (n == CSV_LINE_MAX)
            return fail(reader, n, "line too long; allowed: %d characters", CSV_LINE_MAX);
        if ((c < ' ' && c != '\t' && c != '\r') || c == 127)
            return fail(reader, n + 1, "byte %d: a binary file? allowed: text", c);
        reader->text[n++] = (char)c;
    }
    if (ferror(reader->stream))
        return error_set(reader->error, STATUS_BAD_INPUT, "%.200s: cannot be read: %s",
                         reader->path, strerror(errno));
    reader->bytes += n + 1;
    if (reader->bytes >> 20 >= CSV_MEGABYTES_MAX)
        return fail(reader, n, "file too large; allowed: %d megabytes", CSV_MEGABYTES_MAX);
    *more = c != EOF || n > 0;
    if (n > 0 && reader->text[n - 1] == '\r') n--;
    reader->text[n] = '\0';
    const size_t mark = reader->line == 1 && strncmp(reader->text, "\xef\xbb\xbf", 3) == 0 ? 3 : 0;
    memmove(reader->text, reader->text + mark, n + 1 - mark);
    n -= mark;
    if (memchr(reader->text, '\r', n))
        return fail(reader, (size_t)(strchr(reader->text, '\r') - reader->text) + 1,
                    "carriage return inside a line; allowed: LF or CRLF at its end");
    return STATUS_OK;
}

static bool blank(const char *text)
{
    return text[strspn(text, " \t")] == '\0' || text[strspn(text, " \t")] == '#';
}

/* Cuts the next value off *rest, without surrounding blanks; *character: its position in the line,
 * from 1. */
static char *next_value(const struct reader *reader, char **rest, size_t *character)
{
    const bool blanks = *reader->separators == ' ';
    if (blanks) *rest += strspn(*rest, reader->separators);
    char *value = *rest, *end = value + strcspn(value, reader->separators);
    *rest = *end ? end + 1 : NULL;
    *end = '\0';
    if (blanks && *rest && !(*rest)[strspn(*rest, reader->separators)]) *rest = NULL;
    value += strspn(value, " \t");
    *character = (size_t)(value - reader->text) + 1;
    for (end = value + strlen(value); end > value && (end[-1] == ' ' || end[-1] == '\t');)
        *--end = '\0';
    return value;
}

/* JSON requires UTF-8. */
static bool is_utf8(const char *name)
{
    char copy[CSV_LINE_MAX + 1];
    strcpy(copy, name);
    status_clean(copy);
    return strcmp(copy, name) == 0;
}

/* Also accepts Fortran's 1.0D0. */
static bool read_number(const char *text, double *value)
{
    char copy[64];
    const size_t n = strlen(text), d = strcspn(text, "dD");
    if (d == n || n >= sizeof copy) return text_real(text, value);
    memcpy(copy, text, n + 1);
    copy[d] = 'e';
    return text_real(copy, value);
}

static enum status read_names(struct reader *reader, struct csv *csv)
{
    reader->separators = strchr(reader->text, ',') ? "," : " \t";
    char *rest = reader->text;
    while (rest) {
        size_t character;
        double number;
        const char *name = next_value(reader, &rest, &character);
        if (!*name) return fail(reader, character, "column %zu has no name", csv->columns + 1);
        if (!is_utf8(name))
            return fail(reader, character, "the name of column %zu is not UTF-8 text",
                        csv->columns + 1);
        if (text_real(name, &number))
            return fail(reader, character,
                        "'%.40s' is a number; the first line must hold the names of the columns",
                        name);
        if (csv_column(csv, name) >= 0)
            return fail(reader, character, "second column named '%.40s'; names must differ", name);
        if (csv->columns == CSV_COLUMNS_MAX)
            return fail(reader, character, "too many columns; allowed: %d", CSV_COLUMNS_MAX);
        if (!(csv->names[csv->columns] = strdup(name)))
            return error_set(reader->error, STATUS_ENVIRONMENT, "no memory");
        csv->columns++;
    }
    return STATUS_OK;
}

static bool grow(struct csv *csv)
{
    if (csv->rows < csv->capacity) return true;
    const size_t capacity = csv->capacity ? 2 * csv->capacity : 4;
    size_t *line = realloc(csv->line, capacity * sizeof *line);
    if (!line) return false;
    csv->line = line;
    for (size_t c = 0; c < csv->columns; c++) {
        double *values = realloc(csv->values[c], capacity * sizeof *values);
        if (!values) return false;
        csv->values[c] = values;
    }
    csv->capacity = capacity;
    return true;
}

static enum status read_row(struct reader *reader, struct csv *csv)
{
    char *rest = reader->text;
    size_t c = 0, character = 1;
    if (!grow(csv))
        return error_set(reader->error, STATUS_ENVIRONMENT, "no memory for %.200s", reader->path);
    for (; rest; c++) {
        const char *value = next_value(reader, &rest, &character);
        if (c == csv->columns)
            return fail(reader, character, "more than %zu values; there are %zu columns",
                        csv->columns, csv->columns);
        if (!read_number(value, &csv->values[c][csv->rows]))
            return fail(reader, character,
                        "'%.40s' in column '%.40s' is not a number; allowed: a finite decimal "
                        "number",
                        value, csv->names[c]);
    }
    if (c < csv->columns)
        return fail(reader, character, "%zu values; there are %zu columns", c, csv->columns);
    csv->line[csv->rows++] = reader->line;
    return STATUS_OK;
}

static enum status read_all(struct reader *reader, struct csv *csv)
{
    bool more = true;
    for (;;) {
        enum status status = next_line(reader, &more);
        if (status) return status;
        if (!more) break;
        if (blank(reader->text)) continue;
        status = csv->columns ? read_row(reader, csv) : read_names(reader, csv);
        if (status) return status;
    }
    if (csv->columns == 0)
        return fail(reader, 1,
                    "the file is empty; allowed: a line of column names, then "
                    "lines of numbers");
    return STATUS_OK;
}

enum status csv_read(const char *path, struct csv *csv, struct error *error)
{
    struct stat about;
    *csv = (struct csv){0};
    struct reader *reader = calloc(1, sizeof *reader);
    if (!reader) return error_set(error, STATUS_ENVIRONMENT, "no memory for %.200s", path);
    reader->path = path;
    reader->error = error;
    enum status status;
    if (!(reader->stream = fopen(path, "r")) || fstat(fileno(reader->stream), &about))
        status =
            error_set(error, STATUS_BAD_INPUT, "%.200s: cannot be read: %s", path, strerror(errno));
    else if (S_ISDIR(about.st_mode))
        status =
            error_set(error, STATUS_BAD_INPUT, "%.200s: is a directory; allowed: a CSV file", path);
    else
        status = read_all(reader, csv);
    if (reader->stream) fclose(reader->stream);
    free(reader);
    return status;
}

void csv_free(struct csv *csv)
{
    for (size_t c = 0; c < CSV_COLUMNS_MAX; c++) free(csv->names[c]), free(csv->values[c]);
    free(csv->line);
    *csv = (struct csv){0};
}

int csv_column(const struct csv *csv, const char *name)
{
    for (size_t c = 0; c < csv->columns; c++)
        if (strcmp(csv->names[c], name) == 0) return (int)c;
    return -1;
}
