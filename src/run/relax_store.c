/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "relax.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>

#include "cache.h"

enum { KEY_MAX = 80 };

/* Opens the folder; false: there is none. */
static bool open_store(struct cache *cache, size_t n)
{
    const char *cached = getenv("XDG_CACHE_HOME"), *home = getenv("HOME");
    char folder[CACHE_PATH_MAX];
    struct error ignored;
    if (n < RELAX_STORE_LEAST || n > RELAX_STORE_MOST) return false;
    if (cached && cached[0] == '/')
        snprintf(folder, sizeof folder, "%.3900s/sphproof/glass", cached);
    else if (home && home[0] == '/')
        snprintf(folder, sizeof folder, "%.3900s/.cache/sphproof/glass", home);
    else
        return false;
    return !cache_open(cache, folder, false, &ignored);
}

static void make_key(char key[KEY_MAX], uint64_t content, int dim, size_t n)
{
    snprintf(key, KEY_MAX, "glass %dD %zu %016" PRIx64, dim, n, content);
}

bool relax_store_find(uint64_t content, int dim, size_t n, double *const x[3])
{
    struct cache cache;
    char key[KEY_MAX];
    if (!open_store(&cache, n)) return false;
    make_key(key, content, dim, n);
    json_t *document = cache_load(&cache, key, NULL);
    const json_t *positions = json_object_get(document, "x");
    const bool found = json_array_size(positions) == (size_t)dim * n;
    for (size_t i = 0; found && i < n; i++)
        for (size_t d = 0; d < (size_t)dim; d++)
            x[d][i] = json_number_value(json_array_get(positions, d * n + i));
    json_decref(document);
    return found;
}

void relax_store_keep(uint64_t content, int dim, size_t n, double *const x[3])
{
    struct cache cache;
    char key[KEY_MAX];
    struct error ignored;
    struct cache_census census;
    if (!open_store(&cache, n)) return;
    make_key(key, content, dim, n);
    json_t *positions = json_array(), *document = json_object();
    for (int d = 0; d < dim; d++)
        for (size_t i = 0; i < n; i++) json_array_append_new(positions, json_real(x[d][i]));
    if (!json_object_set_new(document, "x", positions)) {
        cache_prune(cache.folder, CACHE_MONTH, &census, &ignored);
        cache_store(&cache, key, document, &ignored);
    }
    json_decref(document);
}
