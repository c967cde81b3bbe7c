/* SPDX-License-Identifier: GPL-3.0-or-later
 * ASCII files of SPLASH (Price 2007): comment lines with the time and, last, the column names,
 * separated by at least two blanks; rows of all types, of which itype 1 is gas. May be
 * compressed. */
#include <stdio.h>
#include <string.h>

#include "text.h"
#include "text_table.h"

static bool recognises(const struct snapshot_source *source)
{
    const char *text = (const char *)source->bytes;
    if (!text_table_is_text(source) || text[0] != '#') return false;
    const char *end = memchr(text, '\n', source->size);
    const char *name = strstr(text, "created by SPLASH");
    return end && name && name < end;
}

/* Names are in fields of equal width: a single blank is part of a name, unless it ends a field. */
static enum status take_names(struct text_table *table, const char *line, size_t length,
                              struct error *error)
{
    size_t at = 1;
    for (;;) {
        at += strspn(line + at, " \r");
        size_t n = 0;
        while (at + n < length && line[at + n] != '\r' &&
               !(line[at + n] == ' ' && (at + n + 1 == length || line[at + n + 1] == ' ')))
            n++;
        if (!n) break;
        if (table->columns == TABLE_COLUMNS_MAX || n >= sizeof table->names[0])
            return error_set(error, STATUS_BAD_INPUT, "%.200s: too many names, or too long ones",
                             table->source->path);
        char *name = table->names[table->columns++];
        memcpy(name, line + at, n); /* the rest is 0 */
        at += n;
    }
    return STATUS_OK;
}

static enum status read(const struct snapshot_source *source,
                        const struct snapshot_options *options, struct snapshot_file *file,
                        struct error *error)
{
    struct text_table table = {.source = source, .separator = ' '};
    const char *text = (const char *)source->bytes;
    const char *last = text; /* comment */
    size_t at = 0, line = 1;
    bool time_follows = false;
    while (text[at] == '#') {
        const size_t length = strcspn(text + at, "\n");
        if (time_follows) {
            double number;
            char word[40];
            snprintf(word, sizeof word, "%.39s", text + at + 1 + strspn(text + at + 1, " "));
            word[strcspn(word, " \r\n")] = '\0';
            if (text_real(word, &number)) file->time = (struct snapshot_value){true, number};
        }
        time_follows = strncmp(text + at, "# time:", 7) == 0;
        last = text + at;
        at += length + (text[at + length] == '\n');
        line++;
    }
    if (take_names(&table, last, strcspn(last, "\n"), error) ||
        text_table_name(&table, options->map, error) ||
        text_table_read(&table, at, line, file, error))
        return error->status;
    snprintf(file->code, sizeof file->code, "unknown, through SPLASH");
    return STATUS_OK;
}

const struct snapshot_reader reader_splash = {
    {"splash", "ASCII of SPLASH", "Price 2007"}, recognises, read};
