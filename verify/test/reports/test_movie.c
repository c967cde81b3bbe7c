/* SPDX-License-Identifier: GPL-3.0-or-later
 * Tests that pictures of a movie share a range: that of all pictures so far, unless a range is
 * given or all values are equal. (movie.py makes movies.) */
#include "test.h"

/* the source itself, because its static functions are tested */
#include "movie.c"

TEST(ranges_of_curves)
{
    static const double x[3] = {1, 2, 3};
    static const struct {
        double y[3], low, high; /* the range of the curve; both 0: none */
    } rows[] = {{{2, 2, 2}, 0, 0},
                {{NAN, 2, 2 * (1 + 1e-5)}, 0, 0},
                {{2, 2 * (1 + 3e-5), NAN}, 2 - 3e-6, 2 * (1 + 3e-5) + 3e-6},
                {{4, 3, NAN}, 1.9, 4.1},
                {{3, INFINITY, 3}, 1.9, 4.1},
                {{-6, 3, 3}, -6.5, 4.5}};
    struct movie_range range = {INFINITY, -INFINITY};
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        const struct plot_series series[] = {{.n = 3, .x = x, .y = rows[k].y}, {.n = 3, .x = x}};
        struct plot_panel panel = {.series = series, .series_count = 2}, given = panel;
        struct plot_heat heat;
        struct movie_range same = range;
        keep_range(&range, &panel, &heat);
        near_absolute(panel.y_min, rows[k].low, 1e-9);
        near_absolute(panel.y_max, rows[k].high, 1e-9);
        given.y_min = 1, given.y_max = 2;
        keep_range(&same, &given, &heat);
        assert_true(given.y_min == 1 && given.y_max == 2);
    }
}

TEST(ranges_of_maps)
{
    static const struct {
        double z[4];
        bool diverging;
        double low, high;
    } rows[] = {{{-2, -2, -2, NAN}, false, 0, 0},
                {{-2, -2 * (1 + 0.9e-6), NAN, NAN}, false, 0, 0},
                {{-2, -2 * (1 + 1.1e-6), -2, -2}, false, -2 * (1 + 1.1e-6), -2},
                {{1, NAN, 0.5, 0.25}, false, -2 * (1 + 1.1e-6), 1},
                {{1, 1, 1, 1}, true, -2 * (1 + 1.1e-6), 2 * (1 + 1.1e-6)},
                {{1, 3, 1, 1}, true, -3, 3}};
    struct movie_range range = {INFINITY, -INFINITY};
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        const struct plot_heat of = {
            .nx = 2, .ny = 2, .z = rows[k].z, .diverging = rows[k].diverging};
        struct plot_panel panel = {.heat = &of};
        struct plot_heat heat;
        keep_range(&range, &panel, &heat);
        assert_ptr_equal(panel.heat, &heat);
        assert_ptr_equal(heat.z, rows[k].z);
        near_absolute(heat.low, rows[k].low, 1e-12);
        near_absolute(heat.high, rows[k].high, 1e-12);
        assert_true(panel.y_min == 0 && panel.y_max == 0);
    }
}

TEST(endings)
{
    assert_true(movie_wanted("a.gif") && movie_wanted("a.b/c.mp4"));
    assert_false(movie_wanted("gif") || movie_wanted("a.gif.png") || movie_wanted("a.svg"));
}
