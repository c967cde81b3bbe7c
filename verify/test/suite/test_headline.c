/* SPDX-License-Identifier: GPL-3.0-or-later
 * Tests the headlines of failing figures: order, words, and member. */
#include "test.h"

#include "suite_output.h"
#include "value.h"

enum { MOST = 9 };

static const struct check slope = {"kernels", "slope", 7, .says = "is too steep", .property = "p"},
                          width = {"kernels", "width", 8, .property = "p"},
                          one = {"hydro", "one", 9, .property = "p"},
                          two = {"hydro", "two", 9, .property = "p"};

struct row {
    const struct check *check;
    const char *subject;
    double value, bound;
};

/* A new reference to the headlines of these figures, all of which fail. */
static json_t *headlines_of(size_t n, const struct row *rows)
{
    struct figure figures[MOST];
    const struct suite suite = {.figures = figures, .figure_count = n, .failed = n};
    for (size_t i = 0; i < n; i++)
        figures[i] = (struct figure){rows[i].check, (char *)(uintptr_t)rows[i].subject,
                                     rows[i].value, rows[i].bound,
                                     1e-3,          0,
                                     FINDING_FAIL};
    json_t *list = headline_list(&suite);
    assert_non_null(list);
    return list;
}

static const char *text_of(const json_t *list, size_t i, const char *name)
{
    return value_text(json_array_get(list, i), name);
}

/* The member is the part before a comma or a colon, truncated if it does not fit; the rest is the
 * location. */
TEST(members_and_places)
{
    for (int length = 62; length <= 66; length++) {
        char subject[128], member[64], headline[128];
        memset(subject, 'm', sizeof subject);
        snprintf(subject + length, sizeof subject - (size_t)length, ", there");
        snprintf(member, sizeof member, "%.63s", subject);
        member[length < 63 ? length : 63] = '\0';
        snprintf(headline, sizeof headline, "%s: one off by 2", member);
        json_t *list = headlines_of(1, &(struct row){&one, subject, 2, 1});
        assert_string_equal(text_of(list, 0, "member"), member);
        assert_string_equal(text_of(list, 0, "headline"), headline);
        assert_string_equal(text_of(list, 0, "place"), "there");
        json_decref(list);
    }
    static const struct {
        const char *subject, *member, *place;
    } rows[] = {{"all", "all", ""},           {"a:1D, far off", "a", "1D, far off"},
                {"a:   q > 1", "a", "q > 1"}, {"a, b: c", "a", "b: c"},
                {": nobody", "", "nobody"},   {"a,", "a", ""}};
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        json_t *list = headlines_of(1, &(struct row){&one, rows[k].subject, 2, 1});
        assert_int_equal(json_array_size(list), 1);
        assert_string_equal(text_of(list, 0, "member"), rows[k].member);
        assert_string_equal(text_of(list, 0, "place"), rows[k].place);
        json_decref(list);
    }
}

/* Of figures with equal ratios to their bounds the first is named, also if these are below 1. */
TEST(the_worst_figure)
{
    json_t *list = headlines_of(4, (const struct row[]){{&one, "a: near", 2, 1},
                                                        {&one, "a: first", 6, 2},
                                                        {&one, "a: second", 9, 3},
                                                        {&one, "a: last", 2.5, 1}});
    assert_string_equal(text_of(list, 0, "place"), "first");
    assert_true(value_member(json_array_get(list, 0), "ratio") == 3 &&
                value_member(json_array_get(list, 0), "figures") == 4);
    assert_int_equal(json_array_size(json_object_get(json_array_get(list, 0), "also")), 0);
    json_decref(list);
    list = headlines_of(1, &(struct row){&one, "a: below its floor", 0, 1e-4});
    assert_string_equal(text_of(list, 0, "place"), "below its floor");
    assert_true(value_member(json_array_get(list, 0), "ratio") == 0);
    json_decref(list);
}

/* The most elementary check comes first, then the figure farthest off, then the first in order. */
TEST(order_of_headlines)
{
    json_t *list = headlines_of(6, (const struct row[]){{&two, "early", 4, 2},
                                                        {&one, "near", 3, 2},
                                                        {&one, "far", 9, 2},
                                                        {&one, "late", 2, 1},
                                                        {&width, "kernel", 2, 1},
                                                        {&slope, "kernel", 2, 1}});
    static const char *const members[] = {"kernel", "far", "early", "late", "near"};
    assert_int_equal(json_array_size(list), 5);
    for (size_t i = 0; i < 5; i++) assert_string_equal(text_of(list, i, "member"), members[i]);
    assert_int_equal(json_array_size(json_object_get(json_array_get(list, 0), "also")), 1);
    assert_string_equal(text_of(list, 0, "headline"), "kernel: is too steep; width off by 2");
    json_decref(list);
    /* each member once, also if it is not the first */
    list = headlines_of(
        4, (const struct row[]){
               {&slope, "a", 2, 1}, {&one, "b", 3, 1}, {&two, "b", 2, 1}, {&width, "b", 2, 1}});
    assert_int_equal(json_array_size(list), 2);
    assert_string_equal(text_of(list, 0, "member"), "a");
    assert_string_equal(text_of(list, 1, "check"), "width");
    json_decref(list);
    list = headlines_of(0, NULL); /* no failure */
    assert_int_equal(json_array_size(list), 0);
    json_decref(list);
}

/* Missed mutants come after all figures, one by one. */
TEST(missed_mutants)
{
    static const struct check_mutant sign = {"sign", "a sign", NULL}, power = {"power", "", NULL};
    struct mutant_outcome outcomes[] = {
        {&one, &sign, 0.5, 1, false}, {&one, &power, 2, 1, true}, {&two, &power, 0.25, 1, false}};
    struct figure figure = {&two, (char *)(uintptr_t) "a", 2, 1, 0, 0, FINDING_FAIL};
    const struct suite suite = {.figures = &figure,
                                .figure_count = 1,
                                .failed = 1,
                                .outcomes = outcomes,
                                .outcome_count = 3};
    json_t *list = headline_list(&suite);
    static const char *const texts[] = {"a: two off by 2",
                                        "the check one does not notice the fault sign (a sign)",
                                        "the check two does not notice the fault power ()"};
    assert_int_equal(json_array_size(list), 3);
    for (size_t i = 0; i < 3; i++) assert_string_equal(text_of(list, i, "headline"), texts[i]);
    json_decref(list);
}

/* The exact printed text: with and without colour; with and without figures; with the number of
 * further checks. */
TEST(printed_headlines)
{
    static struct check others[9] = {{0}};
    static char names[9][8];
    struct row rows[9];
    for (size_t i = 0; i < 9; i++) {
        snprintf(names[i], sizeof names[i], "c%zu", i);
        others[i] = (struct check){.group = "hydro", .name = names[i], .property = "p"};
        rows[i] = (struct row){&others[i], i ? "a" : "a: here", 10 - (double)i, 1};
    }
    others[0].slow = true;
    static const struct {
        size_t n;
        bool color;
        const char *text;
    } list[] = {
        {1, false,
         "a: c0 off by 10\n    c0: got 10, bound 1, 10 times over, at here\n    property: p\n"
         "    1 failing figures\n    all of it: sphproof verify hydro --details --slow\n"},
        {2, true,
         "\033[1;31ma: c0 off by 10; c1 off by 9\033[0m\n    c0: got 10, bound 1, 10 times over, "
         "at here\n    property: p\n    2 failing figures; also: c1\n"
         "    all of it: sphproof verify hydro --details --slow\n"},
        {7, false,
         "a: c0 off by 10; c1 off by 9\n    c0: got 10, bound 1, 10 times over, at here\n"
         "    property: p\n    7 failing figures; also: c1, c2, c3, c4, c5, c6\n"
         "    all of it: sphproof verify hydro --details --slow\n"},
        {9, false,
         "a: c0 off by 10; c1 off by 9\n    c0: got 10, bound 1, 10 times over, at here\n"
         "    property: p\n    9 failing figures; also: c1, c2, c3, c4, c5, c6 and 2 more checks\n"
         "    all of it: sphproof verify hydro --details --slow\n"},
    };
    for (size_t k = 0; k < sizeof list / sizeof *list; k++) {
        char text[2048] = "";
        FILE *stream = fmemopen(text, sizeof text, "w");
        json_t *headlines = headlines_of(list[k].n, rows);
        assert_non_null(stream);
        headline_print(headlines, stream, list[k].color);
        fclose(stream);
        assert_string_equal(text, list[k].text);
        json_decref(headlines);
    }
}
