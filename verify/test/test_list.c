/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "test.h"

#include <stdlib.h>

static struct CMUnitTest tests[64];
static size_t count;

void test_add(const char *name, CMUnitTestFunction function)
{
    if (count == sizeof tests / sizeof *tests) abort();
    tests[count++] = (struct CMUnitTest){name, function, NULL, NULL, NULL};
}

int test_run(CMFixtureFunction before, CMFixtureFunction after)
{
    return _cmocka_run_group_tests("tests", tests, count, before, after);
}
