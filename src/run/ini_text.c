/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "ini_text.h"

#include <errno.h>
#include <fcntl.h>
#include <ini.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "text.h"

enum { SIZE_MAX_FILE = 65536 };

enum status ini_text_fail(struct ini_text *text, const char *what, const char *allowed)
{
    text->failed = true;
    return error_set(text->error, STATUS_BAD_INPUT, "%.200s:%d: %.120s%s%.160s", text->path,
                     text->line, what, *allowed ? "; allowed: " : "", allowed);
}

enum status ini_text_fail_value(struct ini_text *text, const char *key, const char *value,
                                const char *allowed)
{
    char what[120];
    snprintf(what, sizeof what, "%.40s = %.60s", key, value);
    return ini_text_fail(text, what, allowed);
}

bool ini_text_first(struct ini_text *text, int *line, const char *key)
{
    char what[120];
    if (!*line) {
        *line = text->line;
        return true;
    }
    snprintf(what, sizeof what, "key %.40s is given twice, first in line %d", key, *line);
    ini_text_fail(text, what, "");
    return false;
}

static enum status cannot_read(const char *path, const char *kind, const char *why,
                               struct error *error)
{
    return error_set(error, STATUS_BAD_INPUT, "%s '%.200s': %s", kind, path, why);
}

enum status ini_text_load(const char *path, const char *kind, char **bytes, size_t *length,
                          struct error *error)
{
    char too_large[80];
    enum status status = STATUS_OK;
    struct stat info;
    *bytes = NULL;
    *length = 0;
    snprintf(too_large, sizeof too_large, "larger than 64 KiB: not a %s", kind);
    /* non-blocking: opening a pipe would wait for a writer */
    const int descriptor = open(path, O_RDONLY | O_NONBLOCK | O_CLOEXEC);
    if (descriptor < 0) return cannot_read(path, kind, strerror(errno), error);
    if (fstat(descriptor, &info) || S_ISDIR(info.st_mode))
        status = cannot_read(path, kind, strerror(EISDIR), error);
    else if (!S_ISREG(info.st_mode))
        status = cannot_read(path, kind, "not a regular file", error);
    else if (info.st_size > SIZE_MAX_FILE)
        status = cannot_read(path, kind, too_large, error);
    else if (!(*bytes = malloc(SIZE_MAX_FILE + 1)))
        status = error_set(error, STATUS_ENVIRONMENT, "no memory to read '%.200s'", path);
    ssize_t got;
    while (!status && *length <= SIZE_MAX_FILE &&
           (got = read(descriptor, *bytes + *length, SIZE_MAX_FILE + 1 - *length)) > 0)
        *length += (size_t)got;
    if (*length > SIZE_MAX_FILE) status = cannot_read(path, kind, too_large, error);
    close(descriptor);
    if (!status) return STATUS_OK;
    free(*bytes);
    *bytes = NULL;
    return status;
}

/* Passes one line to inih, without leading blanks, which inih would read as a continuation. */
static char *take_line(char *line, int size, void *context)
{
    struct ini_text *text = context;
    if (text->rest == text->end || text->failed) return NULL;
    const char *newline = memchr(text->rest, '\n', (size_t)(text->end - text->rest));
    const char *next = newline ? newline + 1 : text->end;
    const char *start = text->rest;
    while (start < next && (*start == ' ' || *start == '\t')) start++;
    snprintf(line, (size_t)size, "%.*s", (int)(next - start), start);
    text->rest = next;
    text->line++;
    return line;
}

/* Rejects what inih would truncate or misread: long lines, NUL and other bytes that are not
 * printable UTF-8. */
static bool check_text(struct ini_text *text)
{
    char what[64];
    int length = 0;
    text->line = 1;
    for (const char *c = text->rest; c < text->end; c++) {
        if (*c == '\n') {
            text->line++;
            length = 0;
            continue;
        }
        const bool line_end = *c == '\r' && c + 1 < text->end && c[1] == '\n';
        char next[5] = ""; /* a character has four bytes at most, and the text has no end mark */
        memcpy(next, c, text->end - c < 4 ? (size_t)(text->end - c) : 4);
        const size_t bytes = *c == '\t' || line_end ? 1 : status_printable(next);
        if (!bytes) {
            snprintf(what, sizeof what, "byte 0x%02x is not text", (unsigned)(*c & 0xff));
            ini_text_fail(text, what, "printable UTF-8");
            return false;
        }
        c += bytes - 1;
        length += (int)bytes;
        if (length > INI_TEXT_LINE) {
            snprintf(what, sizeof what, "a line of more than %d bytes", INI_TEXT_LINE);
            ini_text_fail(text, what, "");
            return false;
        }
    }
    text->line = 0;
    return true;
}

/* The callback and its context. Pairs are passed only until the file fails. */
struct receiver {
    struct ini_text *text;
    ini_text_pair *pair;
    void *context;
};

static int hand_over(void *context, const char *section, const char *name, const char *value)
{
    const struct receiver *receiver = context;
    if (!receiver->text->failed) receiver->pair(receiver->context, section, name, value);
    return 1;
}

/* inih has one context for lines and pairs, and does not report sections without pairs. */
static char *next_line(char *line, int size, void *context)
{
    const struct receiver *receiver = context;
    char section[INI_TEXT_LINE + 1];
    char *taken = take_line(line, size, receiver->text);
    if (!taken || *taken != '[' || !receiver->text->sections) return taken;
    snprintf(section, sizeof section, "%.*s", (int)strcspn(taken + 1, "]"), taken + 1);
    hand_over(context, section, NULL, NULL);
    return taken;
}

enum status ini_text_read(struct ini_text *text, ini_text_pair *pair, void *context)
{
    struct receiver receiver = {text, pair, context};
    char what[64];
    if (text->rest == text->end)
        return error_set(text->error, STATUS_BAD_INPUT, "%.200s: the %s is empty", text->path,
                         text->kind);
    const size_t mark = strlen(TEXT_BYTE_ORDER_MARK);
    if ((size_t)(text->end - text->rest) > mark && !memcmp(text->rest, TEXT_BYTE_ORDER_MARK, mark))
        text->rest += mark;
    if (!check_text(text)) return text->error->status;
    const int line = ini_parse_stream(next_line, &receiver, hand_over, &receiver);
    if (text->failed) return text->error->status;
    if (!line) return STATUS_OK;
    text->line = line;
    snprintf(what, sizeof what, "not a line of a %s", text->kind);
    return ini_text_fail(text, what, "[section], key = value, ; comment");
}
