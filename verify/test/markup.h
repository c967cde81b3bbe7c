/* SPDX-License-Identifier: GPL-3.0-or-later
 * Tests whether XML, or HTML written as XML, is well-formed: elements nest and close, attributes
 * are quoted and unique, '&' starts an entity, ids are unique. */
#pragma once

#include <ctype.h>
#include <stdbool.h>
#ifdef HAVE_ZLIB
#include <zlib.h>
#endif

enum { MARKUP_DEPTH = 64, MARKUP_IDS = 20000 };

static bool markup_same(const char *a, const char *b, size_t n)
{
    return !strncmp(a, b, n) && !isalnum((unsigned char)a[n]) && !isalnum((unsigned char)b[n]);
}

static int markup_order(const void *a, const void *b)
{
    return strcmp(*(char *const *)a, *(char *const *)b);
}

/* Parses attributes from c to the end of the tag; returns NULL and the reason in `fault` if they
 * are wrong. */
static const char *markup_attributes(const char *c, char **ids, size_t *id_count, char *fault,
                                     size_t size)
{
    const char *names[32];
    size_t lengths[32], count = 0;
    for (;;) {
        while (isspace((unsigned char)*c)) c++;
        if (*c == '>' || (*c == '/' && c[1] == '>')) return c;
        const char *name = c, *end;
        while (*c && *c != '=' && *c != '>' && !isspace((unsigned char)*c)) c++;
        size_t n = (size_t)(c - name);
        bool quoted = *c == '=' && (c[1] == '"' || c[1] == '\'');
        if (!n || !quoted || count == 32) {
            snprintf(fault, size, "attribute without a quoted value: %.40s", name);
            return NULL;
        }
        for (size_t k = 0; k < count; k++) {
            if (lengths[k] != n || strncmp(names[k], name, n)) continue;
            snprintf(fault, size, "attribute twice: %.40s", name);
            return NULL;
        }
        names[count] = name;
        lengths[count++] = n;
        end = strchr(c + 2, c[1]);
        if (!end || memchr(c + 2, '<', (size_t)(end - c - 2))) {
            snprintf(fault, size, "attribute's value does not end: %.40s", name);
            return NULL;
        }
        if (n == 2 && !strncmp(name, "id", 2) && *id_count < MARKUP_IDS)
            ids[(*id_count)++] = strndup(c + 2, (size_t)(end - c - 2));
        c = end + 1;
    }
}

static bool markup_walk(const char *c, char **ids, size_t *id_count, char *fault, size_t size)
{
    const char *open[MARKUP_DEPTH];
    size_t depth = 0;
    for (; *c; c++) {
        if (*c == '&' && !(isalpha((unsigned char)c[1]) || c[1] == '#')) {
            snprintf(fault, size, "bare ampersand: %.40s", c);
            return false;
        }
        if (*c != '<') continue;
        if (c[1] == '?' || c[1] == '!') {
            c = strchr(c, '>');
            if (!c) return false;
            continue;
        }
        bool end = c[1] == '/';
        const char *name = c + 1 + end;
        size_t n = strcspn(name, " \n\t/>");
        if (!isalpha((unsigned char)*name) || (!end && depth == MARKUP_DEPTH)) {
            snprintf(fault, size, "not a tag: %.40s", c);
            return false;
        }
        c = markup_attributes(name + n, ids, id_count, fault, size);
        if (!c) return false;
        if (end && (!depth || !markup_same(open[--depth], name, n))) {
            snprintf(fault, size, "closes what is not open: %.40s", name);
            return false;
        }
        if (!end && *c != '/') open[depth++] = name;
        c += *c == '/';
        if (!end && n == 5 && !strncmp(name, "style", n)) c = strstr(c, "</style") - 1;
    }
    if (depth) snprintf(fault, size, "not closed: %.40s", open[depth - 1]);
    return !depth;
}

/* True if well-formed; else `fault` says what is wrong and where. */
static bool markup_well_formed(const char *document, char *fault, size_t size)
{
    char **ids = malloc(MARKUP_IDS * sizeof *ids);
    size_t id_count = 0;
    bool well = ids && markup_walk(document, ids, &id_count, fault, size);
    if (well && id_count) {
        qsort(ids, id_count, sizeof *ids, markup_order);
        for (size_t k = 1; k < id_count && well; k++) {
            if (strcmp(ids[k - 1], ids[k])) continue;
            snprintf(fault, size, "id twice: %.60s", ids[k]);
            well = false;
        }
    }
    for (size_t k = 0; k < id_count; k++) free(ids[k]);
    free(ids);
    return well;
}

#ifdef HAVE_ZLIB
static inline size_t markup_base64(const char *text, size_t n, unsigned char *bytes)
{
    static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    size_t count = 0;
    for (size_t i = 0; i + 3 < n; i += 4) {
        unsigned word = 0;
        int left = 0;
        for (size_t k = 0; k < 4; k++) {
            const char *at = text[i + k] == '=' ? NULL : strchr(digits, text[i + k]);
            word = word << 6 | (at ? (unsigned)(at - digits) : 0);
            left += text[i + k] == '=';
        }
        for (int k = 0; k < 3 - left; k++) bytes[count++] = (unsigned char)(word >> (16 - 8 * k));
    }
    return count;
}
#endif

/* The page with all its compressed parts, as its script would inflate them; the caller frees it.
 * *sealed: number of parts. NULL: one of them cannot be inflated. */
static inline char *markup_unsealed(const char *document, size_t *sealed)
{
    static const char head[] = "<div class=\"sealed\" data-z=\"";
    char *whole = strdup(document);
    *sealed = 0;
#ifdef HAVE_ZLIB
    enum { MOST = 1 << 24 };
    unsigned char *text = malloc(MOST), *bytes = malloc(strlen(document) + 1);
    for (char *at; whole && text && bytes && (at = strstr(whole, head)); ++*sealed) {
        const char *data = at + sizeof head - 1, *end = strchr(data, '"');
        uLongf size = MOST - 1;
        const size_t n = markup_base64(data, (size_t)(end - data), bytes);
        const size_t before = (size_t)(at - whole), after = strlen(end + 2);
        char *opened = NULL;
        if (uncompress(text, &size, bytes, (uLong)n) == Z_OK &&
            (opened = malloc(before + size + after + 64))) {
            memcpy(opened, whole, before);
            memcpy(opened + before, "<div class=\"opened\">", 20);
            memcpy(opened + before + 20, text, size);
            memcpy(opened + before + 20 + size, end + 2, after + 1);
        }
        free(whole);
        whole = opened;
    }
    free(text);
    free(bytes);
#endif
    return whole;
}

/* The first text that would make a browser access the network, or NULL. Names of XML namespaces are
 * not addresses. */
static inline const char *markup_network(const char *document)
{
    static const char *const asks[] = {"src=\"http", "href=\"http", "url(http", "@import",
                                       "src=\"//",   "href=\"//",   "url(//",   "<script ",
                                       "<iframe",    "<link",       "fetch(",   "XMLHttpRequest",
                                       "import(",    "WebSocket"};
    for (size_t k = 0; k < sizeof asks / sizeof *asks; k++) {
        const char *at = strstr(document, asks[k]);
        if (at) return at;
    }
    return NULL;
}
