/* SPDX-License-Identifier: GPL-3.0-or-later
 * Text tables: a line with the names of the columns (any names with --map), then a line a particle;
 * separated by commas or, where the first line has none, by blanks. Where numbers come first, the
 * names are the last comment before them, as numpy.savetxt writes it. Lines before the particles
 * say what columns do not: "# time = 0.2", "# gamma = 1.4", "# box = 2", "# box = 2 1 1" or
 * "# box = -1:1 0:0.5"; our own snapshots also have "case", "boundary" and "keys". */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "text.h"
#include "text_table.h"

static void take_remark(const char *line, size_t length, struct snapshot_file *file)
{
    char text[1200], key[16];
    if (length >= sizeof text) return;
    memcpy(text, line, length);
    text[length] = '\0';
    const size_t begin = strspn(text, "# \t"), size = strcspn(text + begin, " \t=:");
    const size_t value = begin + size + strspn(text + begin + size, " \t=:");
    char *end = text + strlen(text);
    while (end > text && strchr(" \t\r", end[-1])) *--end = '\0';
    if (size == 0 || size >= sizeof key || value >= (size_t)(end - text)) return;
    memcpy(key, text + begin, size);
    key[size] = '\0';
    double number;
    if (strcmp(key, "box") == 0) file->boxed = snapshot_take_box(text + value, file);
    if (strcmp(key, "case") == 0)
        snprintf(file->case_name, sizeof file->case_name, "%s", text + value);
    if (strcmp(key, "boundary") == 0)
        snprintf(file->boundary, sizeof file->boundary, "%s", text + value);
    if (strcmp(key, "keys") == 0) snprintf(file->keys, sizeof file->keys, "%s", text + value);
    if (!text_real(text + value, &number)) return;
    if (strcmp(key, "time") == 0) file->time = (struct snapshot_value){true, number};
    if (strcmp(key, "gamma") == 0) {
        file->gamma = (struct snapshot_value){true, number};
        snapshot_note(&file->notes, "gamma", "in the file", "its line '%.100s'", text);
    }
}

/* Commas, else semicolons, else blanks. */
static char separator_of(const char *line, size_t length)
{
    return memchr(line, ',', length) ? ',' : memchr(line, ';', length) ? ';' : ' ';
}

static enum status take_names(struct text_table *table, const char *line, size_t length,
                              struct error *error)
{
    const char separator = separator_of(line, length);
    const bool blanks = separator == ' ';
    const char stops[] = {separator, blanks ? '\t' : separator, '\0'};
    for (size_t at = 0; at < length;) {
        size_t n = 0;
        while (at < length && (line[at] == ' ' || line[at] == '\t')) at++;
        while (at + n < length && !strchr(stops, line[at + n])) n++;
        const size_t next = at + n + (at + n < length);
        size_t size = n;
        while (size && strchr(" \t\r", line[at + size - 1])) size--;
        double number;
        if (blanks && !size) break;
        const bool last_empty = !blanks && at + n + 1 == length;
        if (table->columns == TABLE_COLUMNS_MAX || size >= sizeof table->names[0] || !size ||
            last_empty)
            return error_set(error, STATUS_BAD_INPUT,
                             "%.200s: names of columns: allowed: at most %d, of 1 to %zu letters",
                             table->source->path, TABLE_COLUMNS_MAX, sizeof table->names[0] - 1);
        char *name = table->names[table->columns++];
        memcpy(name, line + at, size);
        name[size] = '\0';
        status_clean(name);
        if (text_real(name, &number))
            return error_set(error, STATUS_BAD_INPUT,
                             "%.200s: '%.40s' is a number; the first line, or the last comment "
                             "before the numbers, must hold the names of the columns",
                             table->source->path, name);
        at = next;
    }
    return STATUS_OK;
}

static bool begins_with_number(const char *line)
{
    char word[48];
    double number;
    snprintf(word, sizeof word, "%.*s", (int)strcspn(line, " \t\r\n,;"), line);
    return text_table_number(word, &number);
}

static enum status read(const struct snapshot_source *source,
                        const struct snapshot_options *options, struct snapshot_file *file,
                        struct error *error)
{
    struct text_table table = {.source = source};
    const char *text = (const char *)source->bytes;
    size_t at = 0, line = 1, remark = 0, remark_length = 0;
    if (source->size >= 3 && memcmp(text, "\xef\xbb\xbf", 3) == 0) at = 3;
    for (; at < source->size && (!table.columns || text[at] == '#'); line++) {
        const size_t length = strcspn(text + at, "\n");
        const size_t begin = strspn(text + at, " \t\r");
        if (text[at + begin] == '#') {
            take_remark(text + at, length, file);
            remark = at + begin + 1, remark_length = length - begin - 1;
        } else if (begin < length) {
            const bool named = !(remark_length && begins_with_number(text + at + begin));
            table.separator = separator_of(text + at, length);
            if (take_names(&table, named ? text + at : text + remark,
                           named ? length : remark_length, error))
                return error->status;
            if (!named) break; /* rows begin here */
        }
        at += length + (text[at + length] == '\n');
        if (text[at] == '\0') break;
    }
    if (!table.columns)
        return error_set(error, STATUS_BAD_INPUT,
                         "%.200s: no line with the names of columns; allowed: x,vx,m,rho,u,h and a "
                         "line a particle",
                         source->path);
    if (text_table_name(&table, options->map, error) ||
        text_table_read(&table, at, line, file, error))
        return error->status;
    for (int d = 0; d < 3; d++)
        if (file->boxed && d < file->columns && !(file->box[d] > 0 && isfinite(file->box[d])))
            return error_set(error, STATUS_BAD_INPUT, "%.200s: box = %g; allowed: above 0",
                             source->path, file->box[d]);
    snprintf(file->code, sizeof file->code, "unknown");
    return STATUS_OK;
}

const struct snapshot_reader reader_csv = {
    {"csv", "text with names of columns, commas, semicolons or blanks", ""},
    text_table_is_text,
    read};
