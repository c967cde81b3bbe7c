/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "text.h"

#include <ctype.h>
#include <limits.h>
#include <locale.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { WORD_MAX = 64, NUMBER_MAX = 1024 };

/* The C library reads numbers according to the locale, and a program that uses our library may have
 * set a decimal comma. Our numbers have a point. */
static bool read_number(const char *text, double *number)
{
    const char *point = localeconv()->decimal_point, *dot = strchr(text, '.');
    char word[NUMBER_MAX], *end;
    if (dot && strcmp(point, ".") != 0) {
        const int length =
            snprintf(word, sizeof word, "%.*s%s%s", (int)(dot - text), text, point, dot + 1);
        if (length < 0 || (size_t)length >= sizeof word) return false;
        text = word;
    }
    *number = strtod(text, &end);
    return !*end && end != text;
}

bool text_real(const char *text, double *value)
{
    /* strtod also accepts blanks, hex, inf and nan: check the alphabet first. */
    if (!*text || text[strspn(text, "0123456789.eE+-")]) return false;
    double number;
    if (!read_number(text, &number) || !isfinite(number)) return false;
    *value = number;
    return true;
}

bool text_integer(const char *text, double *value)
{
    double number;
    if (!text_real(text, &number) || number != nearbyint(number) || strchr(text, '.')) return false;
    *value = number;
    return true;
}

bool text_count(const char *text, double *value, int *exponent)
{
    char word[WORD_MAX];
    double base, power_of;
    const char *power = strchr(text, '^');
    *exponent = 0;
    if (!power) return text_integer(text, value);
    const size_t length = (size_t)(power - text);
    if (length >= sizeof word) return false;
    memcpy(word, text, length);
    word[length] = '\0';
    if (!text_integer(word, &base) || !text_integer(power + 1, &power_of) ||
        !(power_of >= 1 && power_of <= INT_MAX))
        return false;
    *exponent = (int)power_of;
    *value = pow(base, power_of);
    return isfinite(*value);
}

bool text_reals(const char *text, const char *separators, size_t n, double *values)
{
    for (size_t i = 0;; i++) {
        char word[WORD_MAX];
        text += strspn(text, " \t");
        const size_t length = strcspn(text, separators);
        if (i == n) return *text == '\0';
        if (length == 0 || length >= sizeof word) return false;
        memcpy(word, text, length);
        word[length] = '\0';
        if (!text_real(word, &values[i])) return false;
        text += length;
        text += strspn(text, " \t");
        if (*text && strchr(separators, *text)) {
            text++;
            if (i + 1 == n) return false;
        }
    }
}

static size_t least(size_t a, size_t b)
{
    return a < b ? a : b;
}

bool text_ends(const char *text, const char *ending)
{
    const char *dot = strrchr(text, '.');
    return dot && strcmp(dot, ending) == 0;
}

size_t text_distance(const char *a, const char *b)
{
    const size_t na = strlen(a), nb = strlen(b);
    if (na > WORD_MAX || nb > WORD_MAX) return na > nb ? na : nb;
    size_t cost[3][WORD_MAX + 1];
    size_t *before = cost[0], *last = cost[1], *row = cost[2];
    for (size_t j = 0; j <= nb; j++) last[j] = j;
    for (size_t i = 1; i <= na; i++) {
        const int c = tolower((unsigned char)a[i - 1]);
        row[0] = i;
        for (size_t j = 1; j <= nb; j++) {
            const int d = tolower((unsigned char)b[j - 1]);
            row[j] = least(least(last[j] + 1, row[j - 1] + 1), last[j - 1] + (c != d));
            if (i > 1 && j > 1 && c == tolower((unsigned char)b[j - 2]) &&
                d == tolower((unsigned char)a[i - 2]))
                row[j] = least(row[j], before[j - 2] + 1);
        }
        size_t *const spare = before;
        before = last, last = row, row = spare;
    }
    return last[nb];
}

const char *text_nearest(const char *word, const char *const *names, size_t n)
{
    const size_t length = strlen(word);
    const char *nearest = NULL;
    size_t best = 1 + (length < 3 ? 0 : length < 6 ? 1 : length / 3);
    for (size_t i = 0; i < n; i++) {
        const size_t distance = text_distance(word, names[i]);
        if (distance < best) best = distance, nearest = names[i];
    }
    /* The beginning of a name counts more than a small edit distance: cubic -> cubic_spline. */
    for (size_t i = 0; !nearest && length >= 2 && i < n; i++)
        if (strncmp(names[i], word, length) == 0) nearest = names[i];
    for (size_t i = 0; !nearest && length >= 3 && i < n; i++)
        if (strstr(names[i], word)) nearest = names[i];
    return nearest;
}

void text_printable(const char *word, char *copy, size_t size)
{
    size_t i = 0;
    for (; word[i] && i + 1 < size; i++) copy[i] = word[i] < ' ' || word[i] > '~' ? '?' : word[i];
    copy[i] = '\0';
}

void text_add(char *text, size_t size, const char *format, ...)
{
    const size_t used = strlen(text);
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text + used, size - used, format, arguments);
    va_end(arguments);
}

enum status text_unknown(struct error *error, const char *where, const char *kind, const char *word,
                         const char *const *names, size_t n)
{
    char list[360] = "", near[WORD_MAX + 24] = "", shown[WORD_MAX];
    const char *nearest = text_nearest(word, names, n);
    if (nearest) snprintf(near, sizeof near, "; did you mean '%s'?", nearest);
    for (size_t i = 0, used = 0; i < n; i++) {
        const int wrote = snprintf(list + used, sizeof list - used, " %s", names[i]);
        if (wrote < 0 || used + (size_t)wrote + 5 > sizeof list) {
            snprintf(list + used, sizeof list - used, " ...");
            break;
        }
        used += (size_t)wrote;
    }
    text_printable(word, shown, sizeof shown);
    return error_set(error, STATUS_BAD_INPUT, "%s%sno %s '%s'%s allowed:%s", where ? where : "",
                     where ? ": " : "", kind, shown, nearest ? near : ";", list);
}

enum status text_unknown_member(struct error *error, const char *where, const char *kind,
                                const char *word, const struct family *family)
{
    const char **names = malloc((family->n + 1) * sizeof *names);
    if (!names) return error_set(error, STATUS_ENVIRONMENT, "no memory");
    for (size_t i = 0; i < family->n; i++) names[i] = family->members[i]->name;
    const enum status status = text_unknown(error, where, kind, word, names, family->n);
    free(names);
    return status;
}
