/* SPDX-License-Identifier: GPL-3.0-or-later
 * Tests the report's list of failing figures. (test_page_drawn.c tests the rest.) */
#include "test.h"

#include "markup.h"
#include "page.h"
#include "verdict.h"

/* For a failed check the page shows the worst figure and 20 more, then the number of figures. */
TEST(failing_figures)
{
    for (int failing = 1; failing < 24; failing++) {
        json_t *results = json_object(), *checks = json_array();
        struct page made;
        size_t sealed, shown = 0;
        char more[64], fault[256];
        for (int i = 0; i <= failing; i++)
            json_array_append_new(checks,
                                  json_pack("{s:s, s:s, s:s, s:s, s:f, s:f, s:f, s:s}", "group",
                                            "kernels", "name", "support", "property", "ends",
                                            "subject", "a", "value", i ? 2. : 0.5, "bound", 1.,
                                            "floor", 0., "status", i ? "fail" : "pass"));
        json_object_set_new(results, "verify", json_pack("{s:o}", "checks", checks));
        json_object_set_new(results, "verdict", verdict_make(results));
        assert_true(page_make(&made, results));
        char *whole = markup_unsealed(made.html, &sealed);
        if (!markup_well_formed(whole, fault, sizeof fault)) fail_msg("%s", fault);
        for (const char *at = whole; (at = strstr(at, "… and</td>")); at++) shown++;
        snprintf(more, sizeof more, "… and %d more failing figures", failing - 21);
        assert_int_equal(shown, failing < 21 ? failing - 1 : 20);
        assert_int_equal(strstr(whole, more) != NULL, failing > 21);
        assert_int_equal(strstr(whole, "more failing figures") != NULL, failing > 21);
        assert_non_null(strstr(whole, ">1 of "));
        free(whole);
        page_free(&made);
        json_decref(results);
    }
}
