/* SPDX-License-Identifier: GPL-3.0-or-later
 * Tests glasses stored on disk: the folder, which sizes are stored, and that they are read to the
 * last bit. */
#include "test.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <time.h>

#include "own_folder.h"
#include "relax.h"

enum { N = RELAX_STORE_LEAST };

static double points[3][N + 1];

static bool is_there(const char *name)
{
    return access(path_of(name), F_OK) == 0;
}

/* Sets an environment variable; NULL: removes it. */
static void set(const char *name, const char *value)
{
    if (value)
        setenv(name, value, 1);
    else
        unsetenv(name);
}

static double *const all[] = {points[0], points[1], points[2]};

TEST(stored_points_are_found)
{
    double kept[3][N + 1];
    set("XDG_CACHE_HOME", whole_path_of("xdg"));
    set("HOME", whole_path_of("home"));
    for (int dim = 2; dim <= 3; dim++) {
        for (int d = 0; d < 3; d++)
            for (int i = 0; i <= N; i++) points[d][i] = (i + 1) / (3. + d) + 1e-13 * dim;
        memcpy(kept, points, sizeof kept);
        assert_false(relax_store_find(7, dim, N, all));
        relax_store_keep(7, dim, N, all);
        memset(points, 0, sizeof points);
        /* another hash, number of points or dimension */
        assert_false(relax_store_find(8, dim, N, all));
        assert_false(relax_store_find(7, dim, N + 1, all));
        assert_int_equal(relax_store_find(7, 5 - dim, N, all), dim == 3);
        for (int i = 0; i <= N; i++) points[dim % 3][i] = -5; /* not a direction in 2D */
        for (int d = 0; d < 3; d++) points[d][N] = -7;        /* and not a point */
        assert_true(relax_store_find(7, dim, N, all));
        for (int d = 0; d < dim; d++) {
            assert_memory_equal(points[d], kept[d], N * sizeof(double));
            assert_true(points[d][N] == -7);
        }
        if (dim == 2)
            for (int i = 0; i < N; i++) assert_true(points[2][i] == -5);
    }
    assert_true(is_there("xdg/sphproof/glass") && !is_there("home"));
}

/* The folder for caches, if its path is absolute, else that in the user's home, else none. */
TEST(folder_of_the_store)
{
    char home[4500];
    snprintf(home, sizeof home, "%s", whole_path_of("own"));
    static const struct {
        const char *cached;
        bool home, kept;
    } rows[] = {{NULL, true, true},
                {"", true, true},
                {"xdg2", true, true},
                {NULL, false, false},
                {"xdg2", false, false}};
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        set("XDG_CACHE_HOME", rows[k].cached);
        set("HOME", rows[k].home ? home : k == 3 ? NULL : "own2");
        relax_store_keep(k, 2, N, all);
        assert_int_equal(relax_store_find(k, 2, N, all), rows[k].kept);
    }
    assert_true(is_there("own/.cache/sphproof/glass"));
    assert_false(access("xdg2", F_OK) == 0 || access("own2", F_OK) == 0);
}

/* Glasses of few points are not kept because they are cheap, and those of too many because they are
 * large. */
TEST(number_of_points_that_is_kept)
{
    static const struct {
        size_t n;
        bool kept;
    } rows[] = {{999, false}, {1000, true}, {300000, true}, {300001, false}};
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        char name[32], folder[64];
        snprintf(name, sizeof name, "number%zu", k);
        snprintf(folder, sizeof folder, "%s/sphproof/glass", name);
        set("XDG_CACHE_HOME", whole_path_of(name));
        assert_false(relax_store_find(1, 2, rows[k].n, all));
        assert_int_equal(is_there(folder), rows[k].kept);
    }
}

/* Keeping a glass removes those that were not used for a month. */
TEST(old_entries_are_removed)
{
    static const char old[] = "old/sphproof/glass/00/1.entry";
    const time_t now = time(NULL);
    const struct timespec times[2] = {{.tv_sec = now - 31 * 24 * 3600},
                                      {.tv_sec = now - 31 * 24 * 3600}};
    set("XDG_CACHE_HOME", whole_path_of("old"));
    relax_store_keep(1, 2, N, all);
    mkdir(path_of("old/sphproof/glass/00"), 0777);
    fclose(fopen(path_of(old), "w"));
    assert_int_equal(utimensat(AT_FDCWD, path_of(old), times, 0), 0);
    assert_true(relax_store_find(1, 2, N, all) && is_there(old));
    relax_store_keep(2, 2, N, all);
    assert_true(relax_store_find(1, 2, N, all) && !is_there(old));
}
