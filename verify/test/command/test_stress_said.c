/* SPDX-License-Identifier: GPL-3.0-or-later
 * Tests the tables that `sphproof stress` prints of given cells. (stress.py tests whole calls.) */
#include "test.h"

#include <jansson.h>

#include "buffer.h"
#include "printed.h"
/* the command itself, because its static functions are tested */
#include "../../command/stress.c"

static const char cells[] =
    "{'group': 'g', 'row': 'first', 'column': 'c', 'outcome': 'ok', 'measured': 0.25, "
    "'predicted': 0.5},"
    "{'group': 'g', 'row': 'first', 'column': 'd', 'outcome': 'ok', 'measured': 0.03125, "
    "'predicted': null},"
    "{'group': 'other', 'row': 'first', 'column': 'c', 'outcome': 'broke_down'},"
    "{'group': 'g', 'row': 'second row of a long name that is cut', 'column': 'c', "
    "'outcome': 'inaccurate', 'measured': 0.5, 'predicted': 'nan', 'reason': 'too far', "
    "'command': 'sphproof run a'},"
    "{'group': 'g', 'row': 'second row of a long name that is cut', 'column': 'd', "
    "'outcome': 'broke_down', 'measured': null, 'reason': 'NaN', 'command': 'sphproof run b'},"
    "{'group': 'g', 'row': 'third', 'column': 'c', 'outcome': 'inaccurate', 'measured': 'inf', "
    "'predicted': 2, 'reason': 'why', 'command': 'sphproof run c'},"
    "{'group': 'g', 'row': 'third', 'column': 'd', 'outcome': 'refused', 'reason': 'no', "
    "'command': 'sphproof run d'}";

static const char table[] =
    "\n[*g]: a group\n"
    "of                                             c a column of a long name\n"
    "first                    [+            0.250/0.500] [+                 0.0312]\n"
    "second row of a long nam %s                   ~0.5%s [-                  broke]\n"
    "third                    %s                     ~2%s %s                refused%s\n"
    "  [.second row of a long name that is cut, c: too far]\n    sphproof run a\n"
    "  [.second row of a long name that is cut, d: NaN]\n    sphproof run b\n"
    "  [.third, c: why]\n    sphproof run c\n"
    "  [.third, d: no]\n    sphproof run d\n";

static const char end[] =
    "\n[*default scheme against the seed program's method:] better 3; worse 0;\n"
    "%s: numbers are errors (density, relative), or measured/predicted limits; ~ is inaccurate\n";

/* A document with `more` further cells that are not ok; quotes in the texts above are single. */
static json_t *document_of(size_t more)
{
    struct buffer text = {0};
    buffer_format(&text,
                  "{'groups': [{'name': 'g', 'title': 'a group', 'column_title': 'of', 'rows': "
                  "['first', 'second row of a long name that is cut', 'third'], 'columns': ['c', "
                  "'a column of a long name']}], 'comparison': {'better': 3, 'note': 'no', "
                  "'worse': 0}, 'cells': [%s",
                  cells);
    for (size_t k = 0; k < more; k++)
        buffer_format(&text,
                      ",{'group': 'g', 'row': 'none', 'column': '%zu', 'outcome': 'broke_down', "
                      "'reason': 'so', 'command': 'sphproof'}",
                      k);
    buffer_add(&text, "]}");
    char *json = buffer_take(&text);
    for (char *c = json; *c; c++)
        if (*c == '\'') *c = '"';
    json_t *document = json_loads(json, 0, NULL);
    assert_non_null(document);
    free(json);
    return document;
}

/* The first twelve cells of a group that are not ok have their reason and command. */
TEST(printed_tables)
{
    static const size_t mores[] = {0, 8, 9};
    for (size_t m = 0; m < 3; m++)
        for (size_t wrong = 0; wrong < 2; wrong++)
            for (int color = 0; color < 2; color++) {
                const struct options options = {.color = color};
                char text[8192], expected[8192], whole[8192];
                const char *const plain = table_style(color).end;
                json_t *document = document_of(mores[m]);
                const struct printed printed = printed_begin();
                print_all(document, wrong, &options);
                printed_end(&printed, text, sizeof text);
                int used = snprintf(whole, sizeof whole, table, "", plain, "", plain, "", plain);
                for (size_t k = 0; k < mores[m] && k < 8; k++)
                    used += snprintf(whole + used, sizeof whole - (size_t)used,
                                     "  [.none, %zu: so]\n    sphproof\n", k);
                if (mores[m] > 8)
                    used += snprintf(whole + used, sizeof whole - (size_t)used,
                                     "  ... all of them with --json\n");
                snprintf(whole + used, sizeof whole - (size_t)used, end,
                         wrong ? "[-NOT WELL]" : "[+all as it should be]");
                printed_dress(whole, color, expected);
                assert_string_equal(text, expected);
                json_decref(document);
            }
}
