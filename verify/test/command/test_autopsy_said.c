/* SPDX-License-Identifier: GPL-3.0-or-later
 * Tests what `sphproof autopsy` prints of given figures. (The transcripts test whole
 * calls.) */
#include "test.h"

#include "printed.h"
/* the command itself, because its static functions are tested */
#include "../../command/autopsy.c"

static const struct table_style none = {"", "", "", "", ""};

/* At most six columns of times: five as far apart as possible, and the last. */
TEST(times_that_are_shown)
{
    static const struct {
        size_t looks;
        const char *shown;
    } rows[] = {{0, ""},
                {1, "0"},
                {2, "0 1"},
                {5, "0 1 2 3 4"},
                {6, "0 1 2 3 4 5"},
                {7, "0 2 4 6"},
                {8, "0 2 4 6 7"},
                {11, "0 2 4 6 8 10"},
                {12, "0 3 6 9 11"},
                {16, "0 3 6 9 12 15"},
                {17, "0 4 8 12 16"}};
    static struct trace trace;
    for (size_t i = 0; i < TRACE_LOOKS + 2; i++) {
        trace.looked[i] = (double)i;
        trace.seen[i].spread = 1 + (double)i, trace.seen[i].gradient = 0.01 * (double)i;
    }
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        char text[2048], expected[3][512] = {"", "", ""}, all[2048];
        const char *at = rows[k].shown;
        for (char *end; *at; at = end) {
            const double look = strtod(at, &end);
            sprintf(expected[0] + strlen(expected[0]), " %8.3g", look);
            sprintf(expected[1] + strlen(expected[1]), " %8.2e", 1 + look);
            sprintf(expected[2] + strlen(expected[2]), " %8.2e", 0.01 * look);
        }
        snprintf(all, sizeof all, "\n  how regular particles stand: time%s\n  %-33s%s\n  %-33s%s\n",
                 expected[0], "distances to nearest neighbours:", expected[1],
                 "E0, h |sum V grad W|:", expected[2]);
        trace.looks = rows[k].looks;
        const struct printed printed = printed_begin();
        print_trace(&trace, &none);
        printed_end(&printed, text, sizeof text);
        assert_string_equal(text, all);
    }
}

/* A part has those letters of the bar of which it covers more than the first half. */
TEST(bars_of_parts)
{
    static const struct {
        double first, last; /* letters of the parts 0 and 2 */
        int shown[2];
    } rows[] = {{2.5, BAR - 2.5, {2, BAR}},
                {3.45, BAR - 3.45, {3, BAR}},
                {3.55, BAR - 3.55, {4, BAR}},
                {3.45, 0, {3, 3}},
                {BAR + 2, 3, {BAR, BAR}}};
    static struct autopsy_level level;
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        char text[128], expected[128] = "  ";
        level.share[0] = rows[k].first / BAR, level.share[2] = rows[k].last / BAR;
        memset(expected + 2, letters[2], (size_t)rows[k].shown[1]);
        memset(expected + 2, letters[0], (size_t)rows[k].shown[0]);
        const struct printed printed = printed_begin();
        print_bar(&level);
        printed_end(&printed, text, sizeof text);
        assert_string_equal(text, expected);
    }
}

/* What the time step costs is said to cancel part of the rest if the error at a quarter of the step
 * is larger by more than a hundredth, not of snapshots, whose steps are unknown. */
TEST(errors_that_grow_with_shorter_steps)
{
    static const struct {
        double half, quarter;
        bool theirs;
        const char *said; /* NULL: nothing */
    } rows[] = {{1, 2, false, "is 2.00 times as large"},
                {9, 1.5, false, "is 1.50 times as large"},
                {0.1, 1.02, false, "is 1.02 times as large"},
                {9, 1.005, false, NULL},
                {2, 1, false, NULL},
                {1, 2, true, NULL}};
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        char text[4096];
        static struct autopsy autopsy;
        autopsy.count = 2, autopsy.theirs = rows[k].theirs;
        memcpy(autopsy.levels[0].error, (double[]){1, 3, 9}, sizeof autopsy.levels[0].error);
        memcpy(autopsy.levels[1].error, (double[]){4, 4 * rows[k].half, 4 * rows[k].quarter},
               sizeof autopsy.levels[1].error);
        const struct printed printed = printed_begin();
        print_parts(&autopsy, &none);
        printed_end(&printed, text, sizeof text);
        assert_int_equal(strstr(text, "With a quarter") != NULL, rows[k].said != NULL);
        if (rows[k].said) assert_non_null(strstr(text, rows[k].said));
    }
}

TEST(powers_of_terms)
{
    static struct autopsy_level level;
    char text[2048], line[256];
    for (int small = 0; small < 2; small++) { /* the unit of powers */
        const double unit = small ? 1e-30 : 1;
        for (size_t k = 0; k < AUTOPSY_TERMS; k++)
            level.power[k] = (struct autopsy_power){(double)k * unit, -0.5 * unit,
                                                    k == 1 ? 0 : 2. * (double)(k + 1) * unit};
        const struct printed printed = printed_begin();
        print_power(&level, &none);
        printed_end(&printed, text, sizeof text);
        for (size_t k = 0; k < AUTOPSY_TERMS; k++) {
            snprintf(line, sizeof line, "\n  %-44s %10.2e %10.2e %10.1e\n",
                     autopsy_term_family.members[k]->label, (double)k * unit, -0.5 * unit,
                     ((double)k - 0.5) / (2. * AUTOPSY_TERMS));
            assert_int_equal(strstr(text, line) != NULL, k != 1);
        }
    }
}
