/* SPDX-License-Identifier: GPL-3.0-or-later
 * What is said of matrices: in words and in a document, where there are some and where none. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "description_output.h"

static void words_and_documents(void **state)
{
    static const struct {
        struct description_sums sums;
        const char *text, *json; /* "": null */
    } rows[] = {
        {{(double)NAN, (double)NAN, (double)NAN, (double)NAN, 0}, "", ""},
        {{2.5, 1.25, 12, 3.5, 0},
         "condition number 2.5 (mean 1.25); angle between C x and x 12 deg (mean 3.5)",
         "{\"condition\": {\"max\": 2.5, \"mean\": 1.25}, \"angle\": {\"max\": 12.0, \"mean\": "
         "3.5}, "
         "\"fallen_back\": 0}"},
        {{2.5, 1.25, 12, 3.5, 1},
         "condition number 2.5 (mean 1.25); angle between C x and x 12 deg (mean 3.5); 1 of 9 "
         "particles with the standard gradient instead",
         "{\"condition\": {\"max\": 2.5, \"mean\": 1.25}, \"angle\": {\"max\": 12.0, \"mean\": "
         "3.5}, "
         "\"fallen_back\": 1}"},
        {{(double)NAN, (double)NAN, (double)NAN, (double)NAN, 9},
         "9 of 9 particles with the standard gradient instead",
         "{\"condition\": {\"max\": null, \"mean\": null}, \"angle\": {\"max\": null, \"mean\": "
         "null}, \"fallen_back\": 9}"},
    };
    (void)state;
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        char text[DESCRIPTION_TEXT] = "before";
        json_t *json = description_json(&rows[k].sums), *want = json_loads(rows[k].json, 0, NULL);
        description_text(&rows[k].sums, 9, text);
        assert_string_equal(text, rows[k].text);
        assert_true(want ? json_equal(json, want) : json_is_null(json));
        json_decref(json);
        json_decref(want);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(words_and_documents),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
