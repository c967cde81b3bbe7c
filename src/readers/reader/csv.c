/* SPDX-License-Identifier: GPL-3.0-or-later
 * Text tables: a line with the names of the columns (any names with --map), then a line per
 * particle; separated by commas or, if the first line has none, by blanks. If the file starts with
 * numbers, the names are in the last comment before them, as numpy.savetxt writes it. Lines before
 * the particles give what is not in columns: "# time = 0.2", "# gamma = 1.4", "# box = 2", "# box =
 * 2 1 1" or "# box = -1:1 0:0.5"; our own snapshots also have "case", "boundary" and "keys". Time
 * (or t) and gamma are also found within a comment: "# Sod at t = 0.2, gamma: 5/3". Lines that
 * contradict each other and decimal commas are refused. */
#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>

#include "text.h"
#include "text_table.h"

static bool in_word(char c)
{
    return isalnum((unsigned char)c) || c == '_';
}

/* True for a word followed by '=' or ':'. */
static bool assigns(const char *at)
{
    const char *behind = at;
    while (in_word(*behind)) behind++;
    const size_t blanks = strspn(behind, " \t");
    return behind > at && (behind[blanks] == '=' || behind[blanks] == ':');
}

/* Reads a number, or a fraction such as 5/3. */
static bool take_ratio(const char *text, size_t length, double *value)
{
    char word[48];
    double below = 1;
    if (!length || length >= sizeof word) return false;
    memcpy(word, text, length);
    word[length] = '\0';
    char *slash = strchr(word, '/');
    if (slash) *slash = '\0';
    if (!text_real(word, value) || (slash && !text_real(slash + 1, &below))) return false;
    *value /= below;
    return isfinite(*value);
}

static bool is_word(const char *text, size_t length, const char *word)
{
    return strlen(word) == length && strncasecmp(text, word, length) == 0;
}

/* Values from comments, with the number of the line that first gave each. */
struct remarks {
    struct snapshot_file *file;
    const char *path;
    size_t line;  /* number of the current line */
    bool untaken; /* noted */
    size_t time, gamma, box, case_name, boundary, keys;
};

static enum status refuse(const struct remarks *remarks, const char *text, const char *allowed,
                          struct error *error)
{
    return error_set(error, STATUS_BAD_INPUT, "%.200s:%zu: '%.99s'; allowed: %s", remarks->path,
                     remarks->line, text, allowed);
}

/* Refuses a line that contradicts an earlier one. */
static enum status agree(const struct remarks *remarks, size_t *first, bool same, const char *text,
                         struct error *error)
{
    char allowed[80];
    snprintf(allowed, sizeof allowed, "one value, but line %zu says another", *first);
    if (*first && !same) return refuse(remarks, text, allowed, error);
    if (!*first) *first = remarks->line;
    return STATUS_OK;
}

static bool is_time(const char *key, size_t length)
{
    return is_word(key, length, "time") || is_word(key, length, "t");
}

static enum status take_number(struct remarks *remarks, const char *key, size_t length,
                               double number, const char *line, struct error *error)
{
    struct snapshot_file *file = remarks->file;
    const bool time = is_time(key, length);
    if (!time && !is_word(key, length, "gamma")) return STATUS_OK;
    struct snapshot_value *value = time ? &file->time : &file->gamma;
    const bool same = fabs(value->value - number) <= 1e-3 * fabs(number); /* one may be rounded */
    if (!time && !remarks->gamma)
        snapshot_note(&file->notes, "gamma", "in the file", "its line '%.100s'", line);
    *value = (struct snapshot_value){true, number};
    return agree(remarks, time ? &remarks->time : &remarks->gamma, same, line, error);
}

/* True for a comma between two digits, the decimal point of many languages. */
static bool decimal_comma(const char *text, size_t at)
{
    return at && text[at] == ',' && isdigit((unsigned char)text[at - 1]) &&
           isdigit((unsigned char)text[at + 1]);
}

static bool begins_number(const char *text)
{
    text += strspn(text, "+-.");
    return isdigit((unsigned char)*text);
}

/* Reads every "KEY = NUMBER" and "KEY: NUMBER" of a comment. A number followed by anything but a
 * comma, a semicolon or the next key may have a unit and is ignored; the first such line is noted.
 * A key ends at the # that begins the comment. */
static enum status take_numbers(struct remarks *remarks, const char *line, struct error *error)
{
    double number;
    for (const char *at = line; (at = strpbrk(at, "=:")); at++) {
        const char *end = at, *value = at + 1 + strspn(at + 1, " \t");
        while (strchr(" \t", end[-1])) end--;
        const char *begin = end;
        while (in_word(begin[-1])) begin--;
        const size_t size = strcspn(value, " \t,;"), length = (size_t)(end - begin);
        const char *rest = value + size + strspn(value + size, " \t");
        if (!is_time(begin, length) && !is_word(begin, length, "gamma")) continue;
        if (decimal_comma(value, size))
            return refuse(remarks, line, "a decimal point, such as 0.2", error);
        if ((!*rest || strchr(",;#", *rest) || assigns(rest)) && take_ratio(value, size, &number)) {
            if (take_number(remarks, begin, length, number, line, error)) return error->status;
        } else if (begins_number(value) && !remarks->untaken) {
            char place[32];
            remarks->untaken = true;
            snprintf(place, sizeof place, "line %zu", remarks->line);
            snapshot_note(&remarks->file->notes, "not taken", place,
                          "'%.100s'; allowed: a number, and no unit behind it", line);
        }
    }
    return STATUS_OK;
}

static enum status take_box(struct remarks *remarks, const char *value, const char *line,
                            struct error *error)
{
    struct snapshot_file *file = remarks->file, said = {0};
    bool same = true, comma = false;
    for (size_t at = 0; value[at] && !strchr(value, ':'); at++)
        comma = comma || decimal_comma(value, at);
    if (!begins_number(value)) return STATUS_OK;
    if (comma || !snapshot_take_box(value, &said))
        return refuse(remarks, line,
                      "lengths such as 2 or 2 1 1, or ends such as -1:1 0:0.5, with blanks between "
                      "them and decimal points",
                      error);
    for (int d = 0; d < 3; d++) {
        same = same && fabs(said.box[d] - file->box[d]) <= 1e-9 * fabs(said.box[d]) &&
               fabs(said.corner[d] - file->corner[d]) <= 1e-9 * fabs(said.box[d]);
        file->box[d] = said.box[d], file->corner[d] = said.corner[d];
    }
    same = same && file->placed == said.placed;
    file->boxed = true, file->placed = said.placed;
    return agree(remarks, &remarks->box, same, line, error);
}

/* Reads a line with a #. */
static enum status take_remark(struct remarks *remarks, const char *line, size_t length,
                               struct error *error)
{
    struct snapshot_file *file = remarks->file;
    const struct {
        const char *key;
        size_t *first;
        char *said;
        size_t size;
    } texts[] = {
        {"case", &remarks->case_name, file->case_name, sizeof file->case_name},
        {"boundary", &remarks->boundary, file->boundary, sizeof file->boundary},
        {"keys", &remarks->keys, file->keys, sizeof file->keys},
    };
    char text[1200], key[16];
    if (length >= sizeof text) return STATUS_OK;
    memcpy(text, line, length);
    text[length] = '\0';
    const size_t begin = strspn(text, "# \t"), size = strcspn(text + begin, " \t=:");
    const size_t value = begin + size + strspn(text + begin + size, " \t=:");
    char *end = text + strlen(text);
    while (strchr(" \t\r", end[-1])) *--end = '\0';
    if (size == 0 || value >= (size_t)(end - text)) return STATUS_OK;
    snprintf(key, sizeof key, "%.*s", (int)size, text + begin);
    double number;
    if (strcmp(key, "box") == 0) return take_box(remarks, text + value, text, error);
    for (size_t k = 0; k < sizeof texts / sizeof *texts; k++) {
        if (strcmp(key, texts[k].key) != 0) continue;
        const bool same = strncmp(texts[k].said, text + value, texts[k].size - 1) == 0;
        snprintf(texts[k].said, texts[k].size, "%s", text + value);
        return agree(remarks, texts[k].first, same, text, error);
    }
    if (text_real(text + value, &number)) /* also "time 0.2" */
        return take_number(remarks, text + begin, size, number, text, error);
    return take_numbers(remarks, text, error);
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
        at += strspn(line + at, " \t");
        if (blanks && table->columns && (line[at] == '[' || line[at] == '(')) { /* unit */
            const size_t unit = strcspn(line + at, line[at] == '[' ? "]\n" : ")\n") + 1;
            snprintf(table->unit, sizeof table->unit, "%.*s", (int)unit, line + at);
            at += unit;
            continue;
        }
        while (at + n < length && !strchr(stops, line[at + n])) n++;
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
        memcpy(name, line + at, size); /* the rest is 0 */
        if (text_real(name, &number))
            return error_set(error, STATUS_BAD_INPUT,
                             "%.200s: '%.40s' is a number; the first line, or the last comment "
                             "before the numbers, must hold the names of the columns",
                             table->source->path, name);
        at += n + 1;
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

enum status csv_comments(const char *path, struct snapshot_file *said, struct error *error)
{
    struct snapshot_source source;
    *said = (struct snapshot_file){0};
    enum status status = source_open(&source, path, error);
    struct remarks remarks = {.file = said, .path = path, .line = 1};
    const char *line = status ? "" : (const char *)source.bytes;
    for (; !status && *line && !begins_with_number(line); remarks.line++) {
        const size_t length = strcspn(line, "\n");
        if (line[strspn(line, " \t\r")] == '#') status = take_remark(&remarks, line, length, error);
        line += length + (line[length] == '\n');
    }
    source_free(&source);
    return status;
}

static enum status read(const struct snapshot_source *source,
                        const struct snapshot_options *options, struct snapshot_file *file,
                        struct error *error)
{
    struct text_table table = {.source = source};
    struct remarks remarks = {.file = file, .path = source->path};
    const char *text = (const char *)source->bytes;
    const size_t mark = strlen(TEXT_BYTE_ORDER_MARK);
    const char *remark = NULL; /* behind the # of the last comment */
    size_t at = 0, line = 1;
    if (strncmp(text, TEXT_BYTE_ORDER_MARK, mark) == 0) at = mark;
    for (; text[at] && (!table.columns || text[at] == '#'); line++) {
        const size_t length = strcspn(text + at, "\n");
        const size_t begin = strspn(text + at, " \t\r");
        if (text[at + begin] == '#') {
            remarks.line = line;
            if (take_remark(&remarks, text + at, length, error)) return error->status;
            remark = text + at + begin + 1;
        } else {
            const bool named = !(remark && begins_with_number(text + at + begin));
            const char *names = named ? text + at : remark;
            table.separator = separator_of(text + at, length);
            if (take_names(&table, names, strcspn(names, "\n"), error)) return error->status;
            if (!named) break; /* first row */
        }
        at += length + (text[at + length] == '\n');
    }
    if (!table.columns)
        return error_set(error, STATUS_BAD_INPUT,
                         "%.200s: no line with the names of columns; allowed: x,vx,m,rho,u,h and a "
                         "line a particle",
                         source->path);
    if (text_table_name(&table, options->map, error) ||
        text_table_read(&table, at, line, file, error))
        return error->status;
    for (int d = 0; d < 3 && file->column[d]; d++)
        if (file->boxed && !(file->box[d] > 0 && isfinite(file->box[d])))
            return error_set(error, STATUS_BAD_INPUT, "%.200s: box = %g; allowed: finite, above 0",
                             source->path, file->box[d]);
    snprintf(file->code, sizeof file->code, "unknown");
    return STATUS_OK;
}

const struct snapshot_reader reader_csv = {
    {"csv", "text with names of columns, commas, semicolons or blanks", ""},
    text_table_is_text,
    read};
