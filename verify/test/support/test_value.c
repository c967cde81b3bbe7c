/* SPDX-License-Identifier: GPL-3.0-or-later
 * Tests the reading of JSON with missing or wrong members, and its writing. */
#include "test.h"

#include <float.h>

#include "result.h"
#include "value.h"

static json_t *document(void)
{
    json_t *made =
        json_pack("{s:f, s:i, s:s, s:s, s:s, s:b, s:n, s:s, s:[f, s, b], s:{s:i}}", "real", 2.385,
                  "whole", -7, "high", "inf", "low", "-inf", "none", "nan", "truth", 1, "null",
                  "word", "pass", "list", 1.5, "inf", 0, "inner", "x", 3);
    assert_non_null(made);
    return made;
}

TEST(numbers)
{
    json_t *d = document();
    double values[3] = {0};
    near_absolute(value_member(d, "real"), 2.385, 0);
    near_absolute(value_member(d, "whole"), -7, 0);
    near_absolute(value_inner(d, "inner", "x"), 3, 0);
    assert_true(isinf(value_member(d, "high")) && value_member(d, "high") > 0);
    assert_true(isinf(value_member(d, "low")) && value_member(d, "low") < 0);
    static const char *const no_numbers[] = {"none", "truth", "null", "word", "list", "absent"};
    for (size_t k = 0; k < sizeof no_numbers / sizeof *no_numbers; k++)
        assert_true(isnan(value_member(d, no_numbers[k])));
    static const char *const are[] = {"real", "whole", "high", "low", "none"};
    for (size_t k = 0; k < sizeof are / sizeof *are; k++)
        assert_true(value_is_real(json_object_get(d, are[k])));
    for (size_t k = 1; k < sizeof no_numbers / sizeof *no_numbers; k++)
        assert_false(value_is_real(json_object_get(d, no_numbers[k])));
    assert_int_equal(value_reals(json_object_get(d, "list"), values, 2), 2);
    near_absolute(values[0], 1.5, 0);
    assert_true(isinf(values[1]));
    assert_true(values[2] == 0);
    assert_int_equal(value_reals(json_object_get(d, "word"), values, 3), 0);
    json_decref(d);
}

/* Members of every kind; with an invalid value there is no object. */
TEST(objects)
{
    json_t *made = result_object("a=%s b=%d c=%zu d=%g e=%g f=%g? g=%g?", "sod", -2, (size_t)7, 0.5,
                                 (double)NAN, (double)NAN, 2.5);
    result_add(made, "h=%d? i=%d? j=%p", 2, 0, (void *)json_array());
    char *text = result_text(made);
    assert_string_equal(text, "{\"a\":\"sod\",\"b\":-2,\"c\":7,\"d\":0.5,\"e\":\"nan\",\"f\":null,"
                              "\"g\":2.5,\"h\":true,\"i\":false,\"j\":[]}");
    free(text);
    json_decref(made);
    assert_null(result_object("a=%d b=%p", 1, NULL));
}

TEST(words)
{
    static const char *const allowed[] = {"fail", "pass", NULL};
    static const struct {
        const char *name, *message;
    } wrong[] = {{"high", "'high' is 'inf'; allowed: fail pass"},
                 {"real", "'real' is a number; allowed: fail pass"},
                 {"inner", "'inner' is an object; allowed: fail pass"},
                 {"truth", "'truth' is true; allowed: fail pass"},
                 {"absent", "'absent' is nothing; allowed: fail pass"}};
    json_t *d = document();
    char message[VALUE_MESSAGE] = "";
    assert_string_equal(value_text(d, "word"), "pass");
    assert_string_equal(value_text(d, "real"), "");
    assert_string_equal(value_text_or(d, "absent", "?"), "?");
    assert_int_equal(value_need_word(d, "word", allowed, message), 1);
    assert_string_equal(message, "");
    for (size_t k = 0; k < sizeof wrong / sizeof *wrong; k++) {
        assert_int_equal(value_need_word(d, wrong[k].name, allowed, message), -1);
        assert_string_equal(message, wrong[k].message);
    }
    assert_ptr_equal(value_need_list(d, "list", message), json_object_get(d, "list"));
    assert_null(value_need_list(d, "word", message));
    assert_string_equal(message, "'word' must be a list, it is 'pass'");
    json_decref(d);
}

/* The output of result_number is read again to the last bit, with the signs of zeros and
 * infinities. */
TEST(what_is_written_is_read)
{
    static const double edges[] = {
        0, 1, 0.1, 1e15, 1e22, DBL_MIN, DBL_MIN / 3, DBL_MAX, (double)INFINITY};
    for (size_t k = 0; k < sizeof edges / sizeof *edges; k++)
        for (int sign = -1; sign <= 1; sign += 2) {
            const double value = sign * edges[k];
            json_t *list = json_pack("[o]", result_number(value));
            char *text = result_text(list);
            json_t *again = json_loads(text, JSON_DECODE_INT_AS_REAL, NULL);
            const double read = value_real(json_array_get(again, 0));
            assert_true(read == value && !signbit(read) == !signbit(value));
            json_t *same = result_number_or_null(value);
            assert_true(json_equal(same, json_array_get(list, 0)));
            json_decref(same), json_decref(list), json_decref(again);
            free(text);
        }
    json_t *none = result_number((double)NAN), *null = result_number_or_null((double)NAN);
    assert_true(value_is_real(none) && isnan(value_real(none)));
    assert_true(json_is_null(null));
    json_decref(none), json_decref(null);
}
