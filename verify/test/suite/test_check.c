/* SPDX-License-Identifier: GPL-3.0-or-later
 * Tests what one run of a check collects: figures with their times, and whether a mutant is already
 * detected. */
#include "test.h"

#include "check_run.h"
#include "clock.h"

static const struct check check = {.group = "a", .name = "check", .property = "p"};

TEST(figures_of_a_check)
{
    struct check_run run = {.check = &check, .began = clock_wall() - 1000};
    check_measure(&run, 1, 1, 1, "of %d", 3); /* value, bound and floor are equal */
    check_measure(&run, 1.5, 1, 0, "above");
    check_measure(&run, 0, 1, 1.5, "floor above");
    check_measure(&run, (double)NAN, 1, 0, "no number");
    check_skip(&run, "not %s", "here");
    assert_int_equal(run.figure_count, 5);
    static const struct {
        const char *subject;
        double value, bound, floor;
        enum finding_status status;
    } rows[] = {{"of 3", 1, 1, 1, FINDING_PASS},
                {"above", 1.5, 1, 0, FINDING_FAIL},
                {"floor above", 0, 1, 1.5, FINDING_FAIL},
                {"no number", (double)NAN, 1, 0, FINDING_FAIL},
                {"not here", (double)NAN, (double)NAN, (double)NAN, FINDING_SKIP}};
    for (int k = 0; k < 5; k++) {
        const struct figure *f = &run.figures[k];
        assert_true(f->check == &check && f->status == rows[k].status);
        assert_string_equal(f->subject, rows[k].subject);
        assert_true(f->value == rows[k].value || (isnan(f->value) && isnan(rows[k].value)));
        assert_true(f->bound == rows[k].bound || (isnan(f->bound) && isnan(rows[k].bound)));
        assert_true(f->floor == rows[k].floor || (isnan(f->floor) && isnan(rows[k].floor)));
        /* the time of a figure begins at the end of the previous figure */
        near_inside(f->seconds, k ? 0 : 1000, k ? 100 : 1100);
    }
    suite_run_free(&run);
}

/* A mutant that has failed once is decided; the correct subject never is. */
TEST(mutants_that_are_decided)
{
    for (int mutant = 0; mutant < 2; mutant++) {
        struct check_run run = {.check = &check, .mutant = mutant};
        check_measure(&run, 0, 1, 0, "well");
        assert_false(check_decided(&run));
        check_measure(&run, 2, 1, 0, "not well");
        assert_int_equal(check_decided(&run), mutant);
        check_measure(&run, 0, 1, 0, "well again");
        check_skip(&run, "skipped");
        assert_int_equal(check_decided(&run), mutant);
        suite_run_free(&run);
    }
}
